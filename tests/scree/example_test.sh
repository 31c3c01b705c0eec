#!/usr/bin/env bash
# example_test.sh BUILD: installs the library, builds the example against that as a user would, by CMake and by pkg-config,
# and compares what it says with the closed form.
set -euo pipefail
source=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
work=$(mktemp -d)
trap 'rm -r "$work"' EXIT
failed() {
  echo "example: $*" >&2
  exit 1
}
for component in library development; do
  cmake --install "$1" --component $component --prefix "$work/installed" >/dev/null
done
cmake -S "$source/examples/drop_height" -B "$work/build" -DCMAKE_PREFIX_PATH="$work/installed" >/dev/null
cmake --build "$work/build" >/dev/null
said=$("$work/build/drop_height" "$source/configs/01_bouncing_ball.yaml" ball 'bodies[1].at[2]=3' time.end=10)
echo "$said"
# It bounces for (1 + e) / (1 - e) sqrt(2 h / g) = 9 sqrt(2 * 2.8 / 9.81) = 6.800 s, and weighs 1100 * 4/3 pi 0.2^3 g = 361.61 N.
[[ $said =~ 't  6.8'.*'height  0.20000 m'.*'at rest' ]] || failed "no rest at 6.8 s"
[[ $said == *'held by body 0 with 361.6'* ]] || failed "not held by its weight"
if "$work/build/drop_height" "$source/configs/01_bouncing_ball.yaml" ball time.stop=10 2>"$work/refusal"; then failed "took time.stop"; fi
grep -qF 'time has no stop; write `end`, in seconds' "$work/refusal" || failed "$(cat "$work/refusal")"

pc=$(dirname "$(find "$work/installed" -name scree.pc)")
read -ra flags < <(PKG_CONFIG_PATH=$pc pkg-config --cflags --libs scree)
"${CXX:-c++}" -std=c++20 "$source/examples/drop_height/main.cpp" -o "$work/by_pkg_config" "${flags[@]}"
LD_LIBRARY_PATH=$(PKG_CONFIG_PATH=$pc pkg-config --variable=libdir scree) "$work/by_pkg_config" \
  "$source/configs/01_bouncing_ball.yaml" ball 'bodies[1].at[2]=3' time.end=10 >"$work/said"
diff <(echo "$said") "$work/said" || failed "by pkg-config it says something else"

# The example of the page, which names a scene of this folder.
sed -n '/^```cpp$/,/^```$/p' "$source/docs/library.md" | sed '/^```/d' >"$work/page.cpp"
"${CXX:-c++}" -std=c++20 "$work/page.cpp" -o "$work/page" "${flags[@]}"
cd "$source"
said=$(LD_LIBRARY_PATH=$(PKG_CONFIG_PATH=$pc pkg-config --variable=libdir scree) "$work/page")
echo "$said"
[[ $said == 'at rest after 6.8'*' s, at 0.2 m, energy off by '* ]] || failed "the page's example says something else"
