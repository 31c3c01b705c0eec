#!/usr/bin/env bash
# scripts/package.sh [OUT [PRESET]]: makes the Debian packages in OUT (build/package) of what PRESET builds (host-release, the
# one that was tried): scree, the program; libscree0.1, its library; libscree-dev, to build other programs with it. Lintian
# looks at them. What it needs besides ./run's packages it installs. tests/packaging/install_test.sh tries them on a clean
# system.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"
out=$(realpath -m "${1:-$root/build/package}")
preset=${2:-host-release}

ensure_packages
ensure_packages "$root/cmake/packages-packaging.txt"
stage "build ($preset)" build "$preset" scree manual
mkdir -p "$out"
stage "package" cpack --config "$root/build/$preset/CPackConfig.cmake" -B "$out" >"$out/cpack.log" ||
  { cat "$out/cpack.log" >&2; exit 1; }
rm -r "$out/_CPack_Packages"
mapfile -t made < <(sed -n 's/^CPack: - package: \(.*\) generated\.$/\1/p' "$out/cpack.log")
# CPack has scripts call ldconfig for a library, where Debian wants the trigger alone.
without_scripts() {
  local files
  files=$(mktemp -d)
  dpkg-deb --raw-extract "$1" "$files"
  rm -f "$files"/DEBIAN/post{inst,rm}
  dpkg-deb --root-owner-group --build "$files" "$1" >/dev/null
  rm -r "$files"
}
for package in "${made[@]}"; do without_scripts "$package"; done
# A bug to be closed is asked of packages that go into Debian's own archive.
stage "lintian" lintian --allow-root --fail-on error,warning --info --suppress-tags initial-upload-closes-no-bugs "${made[@]}"
printf '%s\n' "${made[@]}"
