// Tests of the sums of impulses on bodies that are not free, against sums in long double.
#include "sim/response/wall_sums.hpp"

#include "core/parallel.hpp"
#include "core/rng.hpp"
#include "tests/core/spaces.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace scree::solver {
namespace {

template <class Space>
class WallSumsTest : public test::InSpace<Space> {};
TYPED_TEST_SUITE(WallSumsTest, test::Spaces, test::SpaceName);

constexpr std::int32_t count = 1000;

/// Bodies of which every `one_in`-th is not free, and a slot of each free one with each of `touched` others.
template <class Space>
struct Walls {
  std::vector<Mobility> mobility;
  std::vector<Slot> slots;
  Array<Mobility, Space> mobility_there;
  Array<Slot, Space> slots_there;

  Walls(std::int32_t one_in, int touched) {
    std::vector<std::int32_t> walls;
    for (std::int32_t k = 0; k < count; ++k) {
      mobility.push_back(k % one_in == 1 ? Mobility::prescribed : Mobility::free);
      if (k % one_in == 1) walls.push_back(k);
    }
    for (std::int32_t k = 0; k < count; ++k) {
      if (k % one_in == 1) continue;
      for (int t = 0; t < touched; ++t) {
        const std::int32_t wall = walls[static_cast<std::size_t>(k * 7 + t) % walls.size()];
        slots.push_back({.i = std::min(k, wall), .j = std::max(k, wall), .end_i = k, .end_j = wall});
      }
      slots.push_back({.i = k, .j = (k + 1) % count, .end_i = k, .end_j = k});
      if (mobility[static_cast<std::size_t>((k + 1) % count)] != Mobility::free) slots.pop_back();
    }
    slots.resize(slots.size() + 5);  // empty ones
    copy(mobility_there, mobility);
    copy(slots_there, slots);
  }
  ConstBodyView bodies() const {
    ConstBodyView view;
    view.mobility = mobility_there.view();
    view.position = {nullptr, count};  // of which only the number is used
    return view;
  }
};

struct Amount {
  ConstView<WallImpulse> impulses;
  SCREE_HD double operator()(std::int64_t e) const {
    return impulses[e].impulse.squaredNorm() + impulses[e].moment.squaredNorm();
  }
};

/// Gives each slot on a wall a random impulse, and adds it to `expected`.
template <class Space>
void add_impulses(WallSums<Space>& sums, const Walls<Space>& walls, Random& random,
                  std::map<std::int32_t, std::pair<long double, long double>>& expected) {
  std::vector<std::int32_t> entry(walls.slots.size());
  copy_bytes<Host, Space>(entry.data(), sums.entry_of_place().data(), entry.size() * sizeof(entry[0]));
  const View<WallImpulse> there = sums.clear_impulses();
  ASSERT_EQ((parallel::sum<double, Space>("test", there.size(), Amount{there})), 0.0);
  std::vector<WallImpulse> impulses(static_cast<std::size_t>(there.size()));
  for (std::size_t s = 0; s < entry.size(); ++s) {
    const Slot& slot = walls.slots[s];
    const auto is_wall = [&](std::int32_t k) {
      return k >= 0 && walls.mobility[static_cast<std::size_t>(k)] != Mobility::free;
    };
    ASSERT_EQ(entry[s] >= 0, is_wall(slot.i) || is_wall(slot.j)) << s;
    if (entry[s] < 0) continue;
    WallImpulse& on = impulses[static_cast<std::size_t>(entry[s])];
    on = {Vec3(random.uniform(-1, 1), 0, 1), Vec3(0, random.uniform(-1, 1), 0)};
    auto& [impulse, moment] = expected[is_wall(slot.i) ? slot.i : slot.j];
    impulse += on.impulse.x();
    moment += on.moment.y();
  }
  copy_bytes<Space, Host>(there.data(), impulses.data(), impulses.size() * sizeof(WallImpulse));
  sums.add_up();
}

TYPED_TEST(WallSumsTest, AreThoseOfAllSlotsOfAWallSinceTheStepBegan) {
  Random random(4, 0);
  WallSums<TypeParam> sums;
  EXPECT_EQ(sums.total_of(3).impulse, Vec3::Zero()) << "before any step";
  for (const auto& [one_in, touched] : {std::pair(333, 3), std::pair(7, 1), std::pair(999, 1)}) {
    const Walls<TypeParam> walls(one_in, touched);
    sums.list_walls(std::as_const(walls.mobility_there).view());
    for (int step = 0; step < 2; ++step) {
      if (step > 0) sums.start_step();
      std::map<std::int32_t, std::pair<long double, long double>> expected;
      sums.take(std::as_const(walls.slots_there).view(), walls.bodies());
      for (int substep = 0; substep < 3; ++substep) add_impulses(sums, walls, random, expected);
      const std::vector<WallImpulse> totals = sums.totals_by_place(count);
      ASSERT_EQ(std::ssize(totals), count);
      for (std::int32_t k = 0; k < count; ++k) {
        const WallImpulse total = sums.total_of(k);
        ASSERT_EQ(total.impulse, totals[static_cast<std::size_t>(k)].impulse) << k;
        ASSERT_NEAR(total.impulse.x(), static_cast<double>(expected[k].first), 1e-10) << k;
        ASSERT_NEAR(total.moment.y(), static_cast<double>(expected[k].second), 1e-10) << k;
      }
    }
  }
}

}  // namespace
}  // namespace scree::solver
