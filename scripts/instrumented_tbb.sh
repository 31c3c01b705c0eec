#!/usr/bin/env bash
# scripts/instrumented_tbb.sh: builds Debian's TBB with ThreadSanitizer, into build/tbb-tsan, unless it is there. How the
# threads of the installed one wait for each other is unseen, so that all that they do would look like races (93
# reports in test_core_parallel, none of them a race). Takes a minute, and 12 MB from where the system's packages are.
set -euo pipefail
# shellcheck source=scripts/setup.sh
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

out="$root/build/tbb-tsan"
if [[ -e $out/libtbb.so.12 ]]; then exit; fi
version=$(dpkg-query -W -f '${source:Version}' libtbb12)
work="$out/work"
mkdir -p "$work"/{lists,cache}/partial "$work"/{source,build}
sed 's/^Types:.*/Types: deb-src/' /etc/apt/sources.list.d/debian.sources >"$work/debian.sources"
# The lists of the system stay as they are.
apt=(apt-get -q -o "Dir::Etc::sourcelist=$work/debian.sources" -o Dir::Etc::sourceparts=/nonexistent
  -o "Dir::State::lists=$work/lists" -o "Dir::Cache=$work/cache" -o APT::Sandbox::User=root)
cd "$work"
"${apt[@]}" update >log
"${apt[@]}" source --download-only "onetbb=$version" >>log
tar xf onetbb_*.orig.tar.xz -C source --strip-components=1
cmake -S source -B build -G Ninja -DCMAKE_BUILD_TYPE=RelWithDebInfo -DTBB_TEST=OFF -DTBB_STRICT=OFF \
  -DTBB_SANITIZE=thread >>log
ninja -C build -j "$(build_jobs)" tbb >>log
cp build/*/libtbb.so.12 "$out"
rm -r "$work"
