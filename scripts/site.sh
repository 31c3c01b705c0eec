#!/usr/bin/env bash
# scripts/site.sh OUT: makes a static site of README.md and docs/ in OUT, with mkdocs, which it installs. A link or picture
# that leads nowhere is an error. To look at it: python3 -m http.server -d OUT
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"
if (($# != 1)); then
  echo "usage: scripts/site.sh OUT" >&2
  exit 2
fi
out=$(realpath -m "$1")

ensure_packages "$root/cmake/packages-packaging.txt"
# The whole tree, because the pages link to scenes, tables, scripts and sources.
source_folder="$root/build/site-source"
rm -rf "$source_folder"
mkdir -p "$source_folder"
(cd "$root" && git ls-files -z | xargs -0 cp --parents --target-directory="$source_folder")
# Only what is wrong is worth reading; mkdocs says it among the names of all pages.
make_site() {
  mkdocs build --strict --clean --config-file "$root/mkdocs.yml" --site-dir "$out" >"$root/build/site.log" 2>&1 ||
    { grep -E 'WARN|ERROR|rror:|Aborted' "$root/build/site.log" >&2; return 1; }
}
stage "site" make_site
echo "$out/index.html"
