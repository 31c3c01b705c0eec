#!/usr/bin/env bash
# linked_test.sh PROGRAM LIBRARY: the program takes the steps of the library, and has no code of its own for what the
# library holds. The library shows names of scree alone.
set -euo pipefail
failed() {
  echo "linked: $*" >&2
  exit 1
}
taken=$(nm --dynamic --undefined-only "$1" | awk '{print $NF}')
[[ $taken == *_ZN5scree10Simulation4stepEv* ]] || failed "the program takes no step of the library"
# T, D, B, R; not W and V, of templates and inline functions, which every user has.
defined() { nm "$@" | awk '$2 ~ /^[TDBR]$/ && $3 ~ /5scree/ {print $3}' | sort -u; }
twice=$(comm -12 <(defined --defined-only "$1") <(defined --dynamic --defined-only "$2"))
[[ -z $twice ]] || failed "in the program and in the library: $(head -n 5 <<<"$twice")"
others=$(nm --dynamic --defined-only "$2" | awk '$3 !~ /^_Z(N|NK|T.N|GVN|ZN|GVZN)5scree/ {print $3}')
[[ -z $others ]] || failed "the library shows names that are not scree's: $(head -n 5 <<<"$others")"
