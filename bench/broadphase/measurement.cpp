#include "bench/broadphase/measurement.hpp"

#include "core/error.hpp"
#include "core/parallel.hpp"

#include <algorithm>
#include <chrono>
#include <map>
#include <memory>
#include <new>
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

/// Mixes each pair into 64 bits (splitmix64; Steele, Lea, Flood 2014). The sum of the mixes does not depend
/// on the order of the pairs.
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

/// The objects, and the order in which each call gets them.
template <class Space>
class Deck {
 public:
  Deck(const Objects<Space>& objects, Order order) : objects_(objects), order_(order) {
    if (order == Order::rows) sort_into_rows(objects, ordered_);
    shuffle();
  }
  /// Makes another permutation, if the order is random.
  void shuffle() {
    if (order_ != Order::random) return;
    permute(objects_, Permutation(objects_.bounds.size(), ++permutations_), ordered_);
  }
  const Objects<Space>& objects() const { return order_ == Order::given ? objects_ : ordered_; }

 private:
  const Objects<Space>& objects_;
  Objects<Space> ordered_;
  Order order_;
  std::uint64_t permutations_ = 0;
};

template <class Space>
ConstView<Pair> find(BroadPhase<Space>& broad_phase, const Objects<Space>& objects) {
  return broad_phase.find(objects.bounds.view(), objects.mobility.view());
}

/// Returns the time of one call (s).
template <class Space>
double time(BroadPhase<Space>& broad_phase, const Objects<Space>& objects) {
  Space::synchronize();
  const Clock::time_point start = Clock::now();
  find(broad_phase, objects);
  Space::synchronize();
  return std::chrono::duration<double>(Clock::now() - start).count();
}

template <class Space>
class Contestant {
 public:
  explicit Contestant(const BroadPhaseSettings& settings) : broad_phase_(make_broad_phase<Space>(settings)) {}

  void warm_up(Deck<Space>& deck, const Objects<Space>& given, int calls) {
    Space::synchronize();
    Space::forget_peak();
    const std::size_t before = Space::memory_use().now;
    for (int k = 0; k < calls; ++k, deck.shuffle()) time(*broad_phase_, deck.objects());
    const std::size_t peak = Space::memory_use().peak;
    result_.checksum = checksum<Space>(find(*broad_phase_, given));
    result_.stats = broad_phase_->stats();
    result_.memory = static_cast<double>(peak) - static_cast<double>(before) -
                     static_cast<double>(result_.stats.pairs) * sizeof(Pair);
  }
  void repeat(const Objects<Space>& objects) { result_.times.push_back(time(*broad_phase_, objects)); }
  /// Finds the pairs once more with each parallel call timed. On Device each call then waits for its end.
  void profile(const Objects<Space>& objects) {
    timing::reset();
    timing::time_calls(true);
    find(*broad_phase_, objects);
    timing::time_calls(false);
    result_.calls = timing::calls();
    for (const timing::Entry& call : result_.calls) call_times_[call.label].push_back(call.seconds);
  }
  Measurement result() {
    std::ranges::sort(result_.times);
    for (timing::Entry& call : result_.calls) call.seconds = median(call_times_[call.label]);
    return result_;
  }

  /// Does the work, unless earlier work of this method failed. Stores the reason if it fails.
  template <class Work>
  void attempt(const Work& work) {
    if (!result_.problem.empty()) return;
    try {
      work(*this);
    } catch (const RunError& error) {
      result_.problem = error.what();
    } catch (const std::bad_alloc&) {
      result_.problem = "out of memory";
    }
    if (!result_.problem.empty()) broad_phase_.reset();
  }

 private:
  std::unique_ptr<BroadPhase<Space>> broad_phase_;
  Measurement result_;
  std::map<std::string, std::vector<double>> call_times_;
};

}  // namespace

template <class Space>
std::vector<Measurement> measure(const Objects<Space>& objects,
                                 const std::vector<BroadPhaseSettings>& methods, const Protocol& protocol) {
  using One = Contestant<Space>;
  Deck<Space> deck(objects, protocol.order);
  std::vector<One> contestants;
  for (const BroadPhaseSettings& method : methods) {
    contestants.emplace_back(method);
    contestants.back().attempt([&](One& one) { one.warm_up(deck, objects, protocol.warm_ups); });
  }
  // A different method begins each round, because the first method finds the objects in the caches, and each
  // other one finds what the method before has left there.
  for (int k = 0; k < std::max(protocol.repeats, protocol.profiles); ++k, deck.shuffle()) {
    const auto all_in_turn = [&](const auto& work) {
      for (std::size_t c = 0; c < contestants.size(); ++c)
        contestants[(c + static_cast<std::size_t>(k)) % contestants.size()].attempt(work);
    };
    if (k < protocol.repeats) all_in_turn([&](One& one) { one.repeat(deck.objects()); });
    if (k < protocol.profiles) all_in_turn([&](One& one) { one.profile(deck.objects()); });
  }
  std::vector<Measurement> results;
  for (One& contestant : contestants) results.push_back(contestant.result());
  return results;
}

template <class Space>
bool agree(const Objects<Space>& objects, const BroadPhaseSettings& a, const BroadPhaseSettings& b) {
  const auto found = [&objects](const BroadPhaseSettings& settings) {
    const auto broad_phase = make_broad_phase<Space>(settings);
    const ConstView<Pair> pairs = find(*broad_phase, objects);
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

/// Copies an array, with all threads on Host, by the driver on Device.
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

#define SCREE_INSTANTIATE(Space)                                                                             \
  template std::vector<Measurement> measure<Space>(const Objects<Space>&,                                    \
                                                   const std::vector<BroadPhaseSettings>&, const Protocol&); \
  template bool agree<Space>(const Objects<Space>&, const BroadPhaseSettings&, const BroadPhaseSettings&);   \
  template double copy_bandwidth<Space>(std::int64_t);
SCREE_FOR_EACH_SPACE(SCREE_INSTANTIATE)
#undef SCREE_INSTANTIATE

}  // namespace scree::bench
