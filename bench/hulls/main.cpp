// The test of make_hull() on adversarial points (families.hpp). Each hull is compared with the points and
// their exact hull (judge.hpp).
//
//   scree_bench_hulls [--sets 1000000] [--first 0] [--family all]
//
// It prints a row for each family. The exit status is 1 if a hull was wrong, or if the program crashed on a
// set: then the row says so, and the first such sets follow with their faults. A set depends on its family
// and number alone, so `--family NAME --first NUMBER --sets 1` makes it again.
//   crash    sets at which the process died by a signal, or took more than ten seconds
//   wrong    other faults
//   refused  sets rightly refused: flat, or with too many vertices
//   support, plane, polygon, volume   the largest errors, relative to their tolerances
//   us       process time per set (us), with all comparisons
#include "bench/clock.hpp"
#include "bench/hulls/judge.hpp"
#include "bench/options.hpp"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <string>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

namespace scree::bench {
namespace {

using namespace oracle;

/// The data that the processes share, because the process that makes the hulls may die.
struct Row {
  std::int64_t next = 0, end = 0;
  std::int64_t crashes = 0, wrong = 0, refused = 0;
  double support = 0, plane = 0, polygon = 0, volume = 0, seconds = 0;
  int told = 0;
};

constexpr int most_told = 5;
constexpr unsigned most_seconds = 10;

void tell(Row& row, HullFamily family, std::int64_t n, const std::string& what) {
  if (row.told++ >= most_told) return;
  std::printf("  --family %s --first %lld: %s\n", name_of(family), static_cast<long long>(n), what.c_str());
  std::fflush(stdout);  // the process may die at the next set
}

void judge_sets(HullFamily family, Row& row) {
  const double start = now(CLOCK_PROCESS_CPUTIME_ID), before = row.seconds;
  for (; row.next < row.end; ++row.next) {
    alarm(most_seconds);
    const HullError error = judge_hull(make_points(family, static_cast<std::uint64_t>(row.next)));
    row.seconds = before + now(CLOCK_PROCESS_CPUTIME_ID) - start;
    row.refused += error.refused && error.fault.empty();
    if (!error.fault.empty()) {
      ++row.wrong;
      tell(row, family, row.next, error.fault);
      continue;
    }
    row.support = std::max(row.support, error.support);
    row.plane = std::max(row.plane, error.plane);
    row.polygon = std::max(row.polygon, error.polygon);
    row.volume = std::max(row.volume, error.volume);
  }
}

/// Judges a family in child processes, each of which continues where the one before died.
void judge_family(HullFamily family, Row& row) {
  while (row.next < row.end) {
    std::fflush(stdout);
    const pid_t child = fork();
    if (child < 0) throw RunError("cannot start a process");
    if (child == 0) {
      judge_sets(family, row);
      std::fflush(stdout);
      _exit(0);
    }
    int status = 0;
    waitpid(child, &status, 0);
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) continue;
    ++row.crashes;
    tell(row, family, row.next,
         WIFSIGNALED(status) ? strsignal(WTERMSIG(status))
                             : "exit status " + std::to_string(WEXITSTATUS(status)));
    ++row.next;
  }
}

bool run(HullFamily family, std::int64_t first, std::int64_t sets) {
  void* shared = mmap(nullptr, sizeof(Row), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (shared == MAP_FAILED) throw RunError("cannot share memory");
  Row& row = *new (shared) Row{.next = first, .end = first + sets};
  judge_family(family, row);
  std::printf("%-11s %8lld %7lld %7lld %8lld %9.2g %9.2g %9.2g %9.2g %7.0f\n", name_of(family),
              static_cast<long long>(sets), static_cast<long long>(row.crashes),
              static_cast<long long>(row.wrong), static_cast<long long>(row.refused), row.support, row.plane,
              row.polygon, row.volume,
              1e6 * row.seconds / static_cast<double>(std::max<std::int64_t>(1, sets)));
  const bool good = row.crashes == 0 && row.wrong == 0;
  munmap(shared, sizeof(Row));
  return good;
}

int run_all(int argc, char** argv) {
  const Options options = parse(argc, argv, {{"--sets", "1000000"}, {"--first", "0"}, {"--family", "all"}});
  std::vector<HullFamily> families;
  for (int f = 0; f < static_cast<int>(HullFamily::count); ++f) {
    const auto family = static_cast<HullFamily>(f);
    if (options.at("--family") == "all" || options.at("--family") == name_of(family))
      families.push_back(family);
  }
  if (families.empty()) throw InputError("--family: must be all or a family's name");
  const std::int64_t sets =
      (std::stoll(options.at("--sets")) + std::ssize(families) - 1) / std::ssize(families);
  std::printf("%-11s %8s %7s %7s %8s %9s %9s %9s %9s %7s\n", "family", "sets", "crash", "wrong", "refused",
              "support", "plane", "polygon", "volume", "us");
  bool good = true;
  for (const HullFamily family : families)
    good = run(family, std::stoll(options.at("--first")), sets) && good;
  return good ? 0 : 1;
}

}  // namespace
}  // namespace scree::bench

int main(int argc, char** argv) {
  return scree::bench::status_of("scree_bench_hulls", [&] { return scree::bench::run_all(argc, argv); });
}
