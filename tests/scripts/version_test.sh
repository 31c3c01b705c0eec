#!/usr/bin/env bash
# The three files that tell the version agree, and the check that says so sees it when one does not.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
python3 "$root/scripts/check_version.py"

copy=$(mktemp -d)
trap 'rm -r "$copy"' EXIT
# refused FILE SED: the check names the file after this change, and no other.
refused() {
  cp "$root"/{CMakeLists.txt,CITATION.cff,CHANGELOG.md} "$copy"
  sed -i "$2" "$copy/$1"
  if said=$(python3 "$root/scripts/check_version.py" "$copy") || [[ $said != "$1: "* || $said == *$'\n'* ]]; then
    echo "check_version.py, after '$2' in $1: '$said'" >&2
    exit 1
  fi
}
refused CITATION.cff 's/^version: .*/version: 99.0.0/'
refused CITATION.cff '/^version:/d'
refused CHANGELOG.md 's/^## [0-9][^ ]* -/## 99.0.0 -/'
refused CHANGELOG.md '/^## Unreleased/d'
