#!/usr/bin/env bash
# ./run and ./test install what the machine lacks: scripts/setup.sh must name it, under the options they run with.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../../scripts/setup.sh"
if ! command -v dpkg-query >/dev/null; then
  echo "skipped: no dpkg-query here, so that nothing is installed either"
  exit 77
fi

packages=$(mktemp)
trap 'rm "$packages"' EXIT
printf '%s\n' bash no-such-package dpkg another-missing-one >"$packages"
mapfile -t missing < <(missing_packages)
if [[ "${missing[*]}" != "another-missing-one no-such-package" ]]; then
  echo "missing packages: '${missing[*]}', not 'another-missing-one no-such-package'" >&2
  exit 1
fi
