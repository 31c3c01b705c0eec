// Time of the broad phase over its data sets: bounds in the space to pairs in the space, everything between
// included.
//
//   scree_bench_broadphase [--set A,B,C] [--n 1000000,16000000] [--space host|cuda] [--levels L]
//                          [--method hierarchical_grid|uniform_grid|sweep_and_prune|lbvh|brute_force]
//                          [--check METHOD] [--stages yes]
//
// Two calls to warm up, then the median of nine, each with the boxes in another random order; the checksum of
// the pairs is that of the data set's own order. --check compares count and checksum of the pairs with those
// of another method; exit status 1 if they differ.
#include "bench/broadphase/data_sets.hpp"
#include "bench/options.hpp"
#include "broadphase/broad_phase.hpp"
#include "core/parallel.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <map>
#include <random>
#include <string>
#include <vector>

namespace scree::bench {

namespace {

constexpr int warm_ups = 2;
constexpr int repeats = 9;

const std::map<std::string, BroadPhaseMethod> methods = {
    {"hierarchical_grid", BroadPhaseMethod::hierarchical_grid},
    {"uniform_grid", BroadPhaseMethod::uniform_grid},
    {"sweep_and_prune", BroadPhaseMethod::sweep_and_prune},
    {"lbvh", BroadPhaseMethod::lbvh},
    {"brute_force", BroadPhaseMethod::brute_force}};

BroadPhaseMethod method_of(const std::string& name) {
  const auto found = methods.find(name);
  if (found == methods.end()) throw InputError("method " + name + ": unknown");
  return found->second;
}

/// A 64-bit mix of each pair (splitmix64; Steele, Lea, Flood 2014); their sum does not depend on the order.
struct MixPair {
  ConstView<Pair> pairs;
  SCREE_HD std::uint64_t operator()(std::int64_t k) const {
    std::uint64_t z = static_cast<std::uint64_t>(pairs[k].i) << 32 | static_cast<std::uint32_t>(pairs[k].j);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
    return z ^ (z >> 31);
  }
};

template <class Space>
std::uint64_t checksum(ConstView<Pair> pairs) {
  return parallel::reduce<std::uint64_t, Space>("bench.checksum", pairs.size(), MixPair{pairs},
                                                std::uint64_t{0}, thrust::plus<std::uint64_t>());
}

/// Sorted times of find() in ms, each of the same boxes in another random order.
template <class Space>
std::vector<double> measure(BroadPhase<Space>& broad_phase, std::vector<Aabb> boxes,
                            ConstView<Mobility> mobility) {
  using Clock = std::chrono::steady_clock;
  std::mt19937_64 random(1);
  Array<Aabb, Space> bounds;
  std::vector<double> times;
  for (int k = 0; k < warm_ups + repeats; ++k) {
    std::ranges::shuffle(boxes, random);
    copy(bounds, boxes);
    Space::synchronize();
    const Clock::time_point start = Clock::now();
    broad_phase.find(bounds.view(), mobility);
    Space::synchronize();
    if (k >= warm_ups)
      times.push_back(std::chrono::duration<double, std::milli>(Clock::now() - start).count());
  }
  std::sort(times.begin(), times.end());
  return times;
}

/// Of one more call, the time of each parallel call in it; on Device each then waits for its end.
template <class Space>
void print_stages(BroadPhase<Space>& broad_phase, ConstView<Aabb> bounds, ConstView<Mobility> mobility) {
  timing::reset();
  timing::time_calls(true);
  broad_phase.find(bounds, mobility);
  timing::time_calls(false);
  for (const timing::Entry& call : timing::calls())
    std::printf("       %-40s %10.3f ms\n", call.label.c_str(), 1e3 * call.seconds);
}

/// Prints a row of the table; false if the check failed.
template <class Space>
bool run(const std::string& set, std::int64_t n, const Options& options) {
  const BroadPhaseSettings settings = {.method = method_of(options.at("--method")),
                                       .levels = std::stoi(options.at("--levels"))};
  Array<Aabb, Space> bounds;
  Array<Mobility, Space> mobility;
  const std::vector<Aabb> boxes = make_data_set(set, n);
  copy(mobility, std::vector<Mobility>(static_cast<std::size_t>(n), Mobility::free));
  const auto broad_phase = make_broad_phase<Space>(settings);
  const std::vector<double> times = measure<Space>(*broad_phase, boxes, mobility.view());
  copy(bounds, boxes);
  const std::uint64_t sum = checksum<Space>(broad_phase->find(bounds.view(), mobility.view()));
  const BroadPhaseStats stats = broad_phase->stats();
  std::printf("%-4s %10lld %-18s %-5s %6d %12lld %7.2f %10.3f %10.3f %10.3f %10.2f  %016llx", set.c_str(),
              static_cast<long long>(n), options.at("--method").c_str(), Space::name, stats.levels,
              static_cast<long long>(stats.pairs),
              static_cast<double>(stats.candidates) / static_cast<double>(n), times[repeats / 2],
              times.front(), times.back(), 1e6 * times[repeats / 2] / static_cast<double>(n),
              static_cast<unsigned long long>(sum));
  bool agrees = true;
  if (!options.at("--check").empty()) {
    const auto other = make_broad_phase<Space>({.method = method_of(options.at("--check"))});
    const ConstView<Pair> expected = other->find(bounds.view(), mobility.view());
    const ConstView<Pair> actual = broad_phase->find(bounds.view(), mobility.view());
    agrees = expected.size() == actual.size() && checksum<Space>(expected) == checksum<Space>(actual);
    std::printf("  %s %s", agrees ? "agrees with" : "DIFFERS from", options.at("--check").c_str());
  }
  std::printf("\n");
  if (options.at("--stages") == "yes") print_stages<Space>(*broad_phase, bounds.view(), mobility.view());
  return agrees;
}

bool run_in_space(const std::string& set, std::int64_t n, const Options& options) {
  bool known = false;
  bool agrees = true;
#define SCREE_TRY(Space)                      \
  if (options.at("--space") == Space::name) { \
    known = true;                             \
    agrees = run<Space>(set, n, options);     \
  }
  SCREE_FOR_EACH_SPACE(SCREE_TRY)
#undef SCREE_TRY
  if (!known) throw InputError("space " + options.at("--space") + ": not in this build");
  return agrees;
}

int run_all(int argc, char** argv) {
  const Options options = parse(argc, argv,
                                {{"--set", "A,B,C"},
                                 {"--n", "1000000"},
                                 {"--method", "hierarchical_grid"},
                                 {"--space", Host::name},
                                 {"--levels", "0"},
                                 {"--check", ""},
                                 {"--stages", "no"}});
  std::printf(
      "set           n method             space levels        pairs tests/n  median ms     min ms     max ms "
      " ns/object  checksum\n");
  bool agrees = true;
  for (const std::string& set : split(options.at("--set"))) {
    for (const std::string& n : split(options.at("--n"))) {
      agrees = run_in_space(set, std::stoll(n), options) && agrees;
    }
  }
  return agrees ? 0 : 1;
}

}  // namespace

}  // namespace scree::bench

int main(int argc, char** argv) {
  return scree::bench::status_of("scree_bench_broadphase", [&] { return scree::bench::run_all(argc, argv); });
}
