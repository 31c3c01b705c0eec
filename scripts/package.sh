#!/usr/bin/env bash
# scripts/package.sh [OUT [PRESET]]: makes the Debian package, OUT/scree_VERSION-1_ARCHITECTURE.deb (OUT: build/package), of
# the program that PRESET builds (host-release, the one that was tried), and has lintian look at it. What it
# needs besides ./run's packages it installs. tests/packaging/install_test.sh tries the package on a clean system.
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
package=$(sed -n 's/^CPack: - package: \(.*\) generated\.$/\1/p' "$out/cpack.log")
# A bug to be closed is asked of packages that go into Debian's own archive.
stage "lintian" lintian --allow-root --fail-on error,warning --info --suppress-tags initial-upload-closes-no-bugs "$package"
echo "$package"
