#!/usr/bin/env bash
# scripts/bundle.sh OUT PROGRAM...: copies built programs to OUT/bin and every shared library that they load to
# OUT/lib, so that OUT runs on another Linux machine with glibc 2.36 or newer. Only glibc stays behind (it belongs to
# the machine's kernel and loader), and the NVIDIA driver, which is opened at run time. The programs find OUT/lib by
# the RPATH that cmake/ScreeCompiler.cmake gives them.
set -euo pipefail
if (($# < 2)); then
  echo "usage: scripts/bundle.sh OUT PROGRAM..." >&2
  exit 2
fi
out=$1
shift
mkdir -p "$out/bin" "$out/lib"

glibc='/(ld-linux[^/]*|lib(c|m|dl|rt|pthread|util|mvec|resolv|anl))\.so'
loaded=$(ldd "$@")
if grep 'not found' <<<"$loaded" >&2; then exit 1; fi
sed -nE 's/.*=> (\/[^ ]+) .*/\1/p' <<<"$loaded" | sort -u | grep -vE "$glibc" |
  xargs -r cp --dereference --update --target-directory="$out/lib"
cp --target-directory="$out/bin" "$@"
