#include "bench/broadphase/measurement.hpp"

#include "core/parallel.hpp"

#include <algorithm>
#include <chrono>
#include <map>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>

namespace scree::bench {

namespace {

using Clock = std::chrono::steady_clock;

double median(std::vector<double> values) {
  const auto middle = values.begin() + std::ssize(values) / 2;
  std::ranges::nth_element(values, middle);
  return *middle;
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

/// A broad phase at work on objects, the order of which changes from call to call.
template <class Space>
class Trial {
 public:
  Trial(const Objects<Space>& objects, const BroadPhaseSettings& settings, Order order)
      : objects_(objects), order_(order), broad_phase_(make_broad_phase<Space>(settings)) {
    if (order == Order::rows) sort_into_rows(objects, ordered_);
    prepare();
  }

  /// The order of the next call.
  void prepare() {
    if (order_ == Order::random)
      permute(objects_, Permutation(objects_.bounds.size(), ++permutations_), ordered_);
    Space::synchronize();
  }
  void find() { find_in(order_ == Order::given ? objects_ : ordered_); }
  ConstView<Pair> find_in(const Objects<Space>& objects) {
    return broad_phase_->find(objects.bounds.view(), objects.mobility.view());
  }

  /// Time of a call (s).
  double time() {
    prepare();
    const Clock::time_point start = Clock::now();
    find();
    Space::synchronize();
    return std::chrono::duration<double>(Clock::now() - start).count();
  }

  const BroadPhaseStats& stats() const { return broad_phase_->stats(); }

 private:
  const Objects<Space>& objects_;
  Objects<Space> ordered_;
  Order order_;
  std::uint64_t permutations_ = 0;
  std::unique_ptr<BroadPhase<Space>> broad_phase_;
};

/// On Device each parallel call then waits for its end.
template <class Space>
std::vector<timing::Entry> profile(Trial<Space>& trial, int profiles) {
  std::vector<timing::Entry> calls;
  std::map<std::string, std::vector<double>> times;
  for (int k = 0; k < profiles; ++k) {
    trial.prepare();
    timing::reset();
    timing::time_calls(true);
    trial.find();
    timing::time_calls(false);
    calls = timing::calls();
    for (const timing::Entry& call : calls) times[call.label].push_back(call.seconds);
  }
  for (timing::Entry& call : calls) call.seconds = median(times[call.label]);
  return calls;
}

}  // namespace

template <class Space>
Measurement measure(const Objects<Space>& objects, const BroadPhaseSettings& settings,
                    const Protocol& protocol) {
  Measurement result;
  Trial<Space> trial(objects, settings, protocol.order);
  Space::forget_peak();
  const std::size_t before = Space::memory_use().now;
  for (int k = 0; k < protocol.warm_ups; ++k) trial.time();
  for (int k = 0; k < protocol.repeats; ++k) result.times.push_back(trial.time());
  std::ranges::sort(result.times);
  const std::size_t peak = Space::memory_use().peak;
  result.calls = profile(trial, protocol.profiles);
  result.checksum = checksum<Space>(trial.find_in(objects));
  result.stats = trial.stats();
  result.memory = static_cast<double>(peak) - static_cast<double>(before) -
                  static_cast<double>(result.stats.pairs) * sizeof(Pair);
  return result;
}

template <class Space>
bool agree(const Objects<Space>& objects, const BroadPhaseSettings& a, const BroadPhaseSettings& b) {
  const auto found = [&objects](const BroadPhaseSettings& settings) {
    Trial<Space> trial(objects, settings, Order::given);
    const ConstView<Pair> pairs = trial.find_in(objects);
    return std::pair(pairs.size(), checksum<Space>(pairs));
  };
  return found(a) == found(b);
}

namespace {

struct CopyBlock {
  static constexpr std::int64_t words = 1 << 17;
  std::uint64_t* to;
  const std::uint64_t* from;
  void operator()(std::int64_t block) const { std::copy_n(from + block * words, words, to + block * words); }
};

/// By all threads on Host, by the driver on Device.
template <class Space>
void copy_words(Array<std::uint64_t, Space>& to, const Array<std::uint64_t, Space>& from) {
  if constexpr (std::is_same_v<Space, Host>) {
    parallel::for_each<Host>("bench.copy", from.size() / CopyBlock::words, CopyBlock{to.data(), from.data()});
  } else {
    copy(to, from);
  }
}

}  // namespace

template <class Space>
double copy_bandwidth(std::int64_t bytes) {
  Array<std::uint64_t, Space> from(bytes / static_cast<std::int64_t>(sizeof(std::uint64_t)) /
                                   CopyBlock::words * CopyBlock::words);
  Array<std::uint64_t, Space> to(from.size());
  parallel::fill("bench.fill", from, std::uint64_t{1});
  parallel::fill("bench.fill", to, std::uint64_t{0});
  std::vector<double> times;
  for (int k = 0; k < 9; ++k) {
    Space::synchronize();
    const Clock::time_point start = Clock::now();
    copy_words(to, from);
    Space::synchronize();
    times.push_back(std::chrono::duration<double>(Clock::now() - start).count());
  }
  return 2 * static_cast<double>(sizeof(std::uint64_t)) * static_cast<double>(from.size()) / median(times);
}

#define SCREE_INSTANTIATE(Space)                                                                           \
  template Measurement measure<Space>(const Objects<Space>&, const BroadPhaseSettings&, const Protocol&);  \
  template bool agree<Space>(const Objects<Space>&, const BroadPhaseSettings&, const BroadPhaseSettings&); \
  template double copy_bandwidth<Space>(std::int64_t);
SCREE_FOR_EACH_SPACE(SCREE_INSTANTIATE)
#undef SCREE_INSTANTIATE

}  // namespace scree::bench
