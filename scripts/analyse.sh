#!/usr/bin/env bash
# scripts/analyse.sh [REGEX]: clang-tidy and cppcheck over the sources of the Host build, or over those whose path
# matches. Exit status 1 if there is a finding. Takes a processor an hour for all of them: say '/sim/record/' for a
# folder, or "$(git diff --name-only main | paste -sd'|')" for what was changed.
#
# What is not asked, and why: .clang-tidy, scripts/cppcheck.supp.
set -euo pipefail
# shellcheck source=scripts/setup.sh
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

which=${1:-.}
sources="$root/build/host-release"
log="$root/build/analysis"

# Sources of scree, not those that the build has made.
chosen() {
  python3 - "$sources/compile_commands.json" "$root" "$which" <<'END'
import json, re, sys
commands, root, which = sys.argv[1:]
files = {entry["file"] for entry in json.load(open(commands))}
print(*sorted(f for f in files if not f.startswith(root + "/build") and re.search(which, f)), sep="\n")
END
}

# A configuration that does not parse would leave the checks of clang-tidy itself.
tidy() {
  ! clang-tidy-14 --dump-config "$root/core/parallel.hpp" 2>&1 | grep -F .clang-tidy || return 1
  chosen | xargs -P "$(nproc)" -n 1 clang-tidy-14 --quiet -p "$sources" 2>/dev/null >"$log/tidy.log" || true
  # A finding in a header comes once for each source that reads it.
  grep -E '(warning|error): ' "$log/tidy.log" | sort -u | tee "$log/tidy.txt"
  [[ ! -s $log/tidy.txt ]]
}

check() {
  chosen >"$log/files.txt"
  cppcheck -j "$(nproc)" --file-list="$log/files.txt" -I "$root" --std=c++20 --enable=warning,performance,portability \
    --library=googletest --inline-suppr --suppressions-list="$root/scripts/cppcheck.supp" --quiet \
    --template='{file}:{line}: {id}: {message}' --error-exitcode=1
}

ensure_packages "$root/cmake/packages-analysis.txt"
mkdir -p "$log"
build host-release scree_commit
failed=0
(stage "clang-tidy" tidy) || failed=1
(stage "cppcheck" check) || failed=1
exit "$failed"
