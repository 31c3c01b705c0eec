// Tests of programs of phases, against the same loops on one thread.
#include "core/space_phases.hpp"
#include "tests/core/spaces.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <vector>

namespace scree {
namespace {

template <class Space>
class RoundsTest : public test::InSpace<Space> {};
TYPED_TEST_SUITE(RoundsTest, test::Spaces, test::SpaceName);

/// Each number becomes the sum of its neighbours on a ring, modulo a prime, in every phase: each phase reads
/// what other threads have written in the phase before.
struct Ring {
  using Sum = std::int64_t;
  struct State {
    std::int64_t sum = 0;
    int rounds = 0;
  };
  [[maybe_unused]] static constexpr int threads = 512;
  static constexpr std::int64_t prime = 1000003;

  View<std::int64_t> even, odd;
  std::int64_t enough;
  int most;

  SCREE_HD int phases(const State& state) const {
    return state.rounds == most || state.sum > enough ? 0 : 2 * (1 + state.rounds % 3);
  }
  SCREE_HD std::int64_t items(const State&, int) const { return even.size(); }
  std::int64_t most_items() const { return even.size(); }
  SCREE_HD Sum operator()(const State& state, int phase, std::int64_t i) const {
    const View<std::int64_t>& from = phase % 2 == 0 ? even : odd;
    const View<std::int64_t>& to = phase % 2 == 0 ? odd : even;
    const std::int64_t n = from.size();
    to[i] = (from[(i + 1) % n] + from[(i + n - 1) % n] + state.rounds) % prime;
    return to[i];
  }
  SCREE_HD State judge(const State& state, const Sum& sum) const { return {sum, state.rounds + 1}; }
};

/// The same ring; on a GPU few of its items also use few threads of each warp.
struct DivergingRing : Ring {
  static constexpr bool diverges = true;
};
static_assert(DivergingRing::diverges);

Ring::State run_on_one_thread(const Ring& ring) {
  Ring::State state;
  for (int phases = ring.phases(state); phases > 0; phases = ring.phases(state)) {
    std::int64_t sum = 0;
    for (int phase = 0; phase < phases; ++phase)
      for (std::int64_t i = 0; i < ring.even.size(); ++i) sum += ring(state, phase, i);
    state = ring.judge(state, sum);
  }
  return state;
}

template <class Program, class Space>
void expect_as_on_one_thread() {
  for (const std::int64_t n : {1, 5, 255, 257, 1100, 100000, 1000000}) {
    std::vector<std::int64_t> numbers(static_cast<std::size_t>(n));
    std::iota(numbers.begin(), numbers.end(), 1);
    Array<std::int64_t, Space> even, odd;
    copy(even, numbers);
    copy(odd, numbers);
    std::vector<std::int64_t> other = numbers;
    const std::int64_t never = std::numeric_limits<std::int64_t>::max();
    const Ring expected{{numbers.data(), n}, {other.data(), n}, never, 20};
    const Ring::State on_one_thread = run_on_one_thread(expected);
    Program program{};
    static_cast<Ring&>(program) = Ring{even.view(), odd.view(), never, 20};
    const Ring::State state = parallel::run_in_phases<Space>("test", program, Ring::State{});
    EXPECT_EQ(state.rounds, 20);
    EXPECT_EQ(state.sum, on_one_thread.sum) << n;
    EXPECT_EQ(to_vector(even), numbers) << n;
  }
}

TYPED_TEST(RoundsTest, PhasesWaitForOneAnother) { expect_as_on_one_thread<Ring, TypeParam>(); }

TYPED_TEST(RoundsTest, ItemsThatDivergeAreDealtOnce) { expect_as_on_one_thread<DivergingRing, TypeParam>(); }

TYPED_TEST(RoundsTest, EndWhereTheSumSaysSo) {
  Array<std::int64_t, TypeParam> even(1000), odd(1000);
  parallel::fill("test", even, std::int64_t{1});
  const Ring ring{even.view(), odd.view(), 10, 20};
  EXPECT_EQ(parallel::run_in_phases<TypeParam>("test", ring, Ring::State{}).rounds, 1);
  EXPECT_EQ(parallel::run_in_phases<TypeParam>("test", ring, Ring::State{.sum = 11, .rounds = 3}).rounds, 3);
}

}  // namespace
}  // namespace scree
