#!/usr/bin/env bash
# ./run and ./test install what the machine lacks: scripts/setup.sh must name it, under the options they run with. And
# ./run builds for a GPU where its driver answers, not where its tools are installed.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../../scripts/setup.sh"

tools=$(mktemp -d)
trap 'rm -r "$tools"' EXIT
says_gpu() { # says_gpu STATUS TEXT: whether there is a GPU where nvidia-smi ends and says so
  printf '#!/bin/sh\necho "%s"\nexit %d\n' "$2" "$1" >"$tools/nvidia-smi"
  chmod +x "$tools/nvidia-smi"
  PATH="$tools:$PATH" have_gpu
}
if ! says_gpu 0 "GPU 0: NVIDIA H100 (UUID: GPU-1)"; then
  echo "have_gpu: not where nvidia-smi lists one" >&2
  exit 1
fi
if ! compgen -G '/dev/nvidia[0-9]*' >/dev/null && says_gpu 9 "NVIDIA-SMI has failed: no driver"; then
  echo "have_gpu: where nvidia-smi finds no driver" >&2
  exit 1
fi

if ! command -v dpkg-query >/dev/null; then
  echo "skipped: no dpkg-query here, so that nothing is installed either"
  exit 77
fi

packages="$tools/packages.txt"
printf '%s\n' bash no-such-package dpkg another-missing-one >"$packages"
mapfile -t missing < <(missing_packages)
if [[ "${missing[*]}" != "another-missing-one no-such-package" ]]; then
  echo "missing packages: '${missing[*]}', not 'another-missing-one no-such-package'" >&2
  exit 1
fi
