#!/usr/bin/env bash
# scripts/fuzz.sh [SECONDS]: gives hostile input to the readers of scenes, body files, meshes (OBJ, STL, PLY), points (of hulls), checkpoints,
# trajectories, tables (of `scree compare`) and manifests, each for so long (60), and prints how many inputs it tried, how many edges of the
# program they took, and where those lie that broke it. Starts from tests/fuzz/corpus, and from the scenes of configs
# and tests/data; what it finds worth keeping stays in build/fuzz, and the next call goes on from there. Exit status 1
# if an input broke something.
#
# scripts/fuzz.sh --keep: copies from build/fuzz to tests/fuzz/corpus the few files that take most of the edges that the
# corpus does not; they are named by a hash, those that were made by hand after what is wrong with them.
# test_hostile_input reads the corpus in every build.
#
# Needs clang 14 and its libFuzzer, and installs them.
set -euo pipefail
# shellcheck source=scripts/setup.sh
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

inputs=(scene body_file obj stl ply points checkpoint trajectory tables manifest)
programs="$root/build/host-fuzz/tests/fuzz"
found="$root/build/fuzz"
corpus="$root/tests/fuzz/corpus"
# Seconds and megabytes that no input is worth: it has a few thousand bytes, and its bodies may take 260 MB.
limits=(-timeout=10 -malloc_limit_mb=256 -rss_limit_mb=2048)
export TMPDIR=/dev/shm # what is written and read again needs no disk
most=100 # files that one --keep adds for each input

fuzz() {
  local input=$1 seconds=$2 log="$found/$1.log" status=0 seeds=("$corpus/$1")
  if [[ $input == scene ]]; then seeds+=("$root"/configs{,/validation,/granular} "$root/tests/data/bad"); fi
  "$programs/fuzz_$input" -max_total_time="$seconds" -max_len=8192 -dict="$found/words.dict" "${limits[@]}" \
    -print_final_stats=1 -artifact_prefix="$found/broken/$input-" "$found/$input" "${seeds[@]}" \
    >"$log" 2>&1 || status=1
  printf '%-10s%10d inputs, %6d edges\n' "$input" \
    "$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")" \
    "$(sed -nE 's/^#.* cov: ([0-9]+) .*/\1/p' "$log" | tail -n 1)"
  if ((status != 0)); then
    grep -aE 'what\(\)|runtime error:|ERROR:|SUMMARY:|Test unit written to' "$log" | cut -c1-200
    echo "all that it said: $log"
  fi
  return "$status"
}

keep() {
  local input=$1 least="$found/least"
  rm -rf "$least"
  cp -r "$corpus/$input" "$least"
  "$programs/fuzz_$input" -set_cover_merge=1 -use_counters=0 "${limits[@]}" "$least" "$found/$input" >"$found/merge.log" 2>&1
  # The merge wrote what takes most edges first.
  find "$least" -type f -size -4k -printf '%T@ %f\n' | sort -n | cut -d' ' -f2 | while read -r file; do
    if [[ ! -e $corpus/$input/$file ]]; then echo "$least/$file"; fi
  done | sed "${most}q" | xargs -r cp -vt "$corpus/$input"
}

ensure_packages "$root/cmake/packages-analysis.txt"
mkdir -p "$found/broken" "${inputs[@]/#/$found/}"
stage "build (host-fuzz)" build host-fuzz fuzz_dictionary "${inputs[@]/#/fuzz_}"
"$programs/fuzz_dictionary" >"$found/words.dict"
failed=0
for input in "${inputs[@]}"; do
  if [[ ${1:-} == --keep ]]; then
    keep "$input"
  else
    fuzz "$input" "${1:-60}" || failed=1
  fi
done
exit "$failed"
