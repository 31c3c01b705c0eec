// Tests of slots: every candidate has its places, and the memory outlives the candidates.
#include "sim/contacts/slots.hpp"

#include "core/parallel.hpp"
#include "core/rng.hpp"
#include "core/space_tiles.hpp"
#include "sim/contacts/contact_colors.hpp"
#include "tests/core/spaces.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <numeric>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

namespace scree::solver {
namespace {

template <class Space>
class SlotsTest : public test::InSpace<Space> {};
TYPED_TEST_SUITE(SlotsTest, test::Spaces, test::SpaceName);

/// Returns balls; number 0 is a plane, and if `drum` is set, number 1 is a drum (a tube) that turns.
BodyTable balls(std::size_t n, bool drum) {
  BodyTable bodies;
  bodies.position.assign(n, Vec3::Zero());
  bodies.orientation.assign(n, Quat::Identity());
  bodies.velocity.assign(n, Vec3::Zero());
  bodies.spin.assign(n, Vec3::Zero());
  bodies.size.assign(n, Vec3(1, 0, 0));
  bodies.inverse_mass.assign(n, 1.0);
  bodies.inverse_inertia.assign(n, Vec3(1, 1, 1));
  bodies.shape.assign(n, Shape::sphere);
  bodies.mobility.assign(n, Mobility::free);
  bodies.material.assign(n, 0);
  for (std::size_t k = 0; k < n; ++k) bodies.id.push_back(BodyNumber{static_cast<std::int32_t>(k)});
  bodies.shape[0] = Shape::plane;
  bodies.mobility[0] = Mobility::fixed;
  if (drum) {
    bodies.shape[1] = Shape::tube;
    bodies.mobility[1] = Mobility::prescribed;
    bodies.spin[1] = Vec3(0, 0, 1);
  }
  return bodies;
}

std::vector<Pair> random_pairs(std::int32_t bodies, int count, std::uint64_t seed) {
  Random random(seed, 0);
  std::set<std::pair<std::int32_t, std::int32_t>> pairs;
  while (static_cast<int>(pairs.size()) < count) {
    const auto i = static_cast<std::int32_t>(random.uniform() * bodies);
    const auto j = static_cast<std::int32_t>(random.uniform() * bodies);
    if (i < j) pairs.insert({i, j});
  }
  std::vector<Pair> list;
  for (const auto& [i, j] : pairs) list.push_back({i, j});
  return list;
}

template <class Space>
struct Built {
  Bodies<Space> bodies;
  Array<Pair, Space> pairs;
  Array<std::int32_t, Space> found;
  Slots<Space, double> slots;

  explicit Built(const BodyTable& table) { copy_bodies(bodies, table); }
  void build(const std::vector<Pair>& list, const std::vector<std::int32_t>& place_before = {}) {
    Array<std::int32_t, Space> before;
    copy(pairs, list);
    copy(before, place_before);
    constexpr bool rolls = true;
    Array<std::int64_t, Space> index;
    slots.look_up(std::as_const(pairs).view(), std::as_const(before).view(), index);
    slots.build(std::as_const(pairs).view(), std::as_const(index).view(), view_of(std::as_const(bodies)),
                rolls);
  }
  /// Splits the hubs among the bodies that have contacts at these places, which are slots of balls.
  bool split_hubs(const std::vector<std::int32_t>& list) {
    copy(found, list);
    return slots.split_hubs(view_of(std::as_const(bodies)),
                            {std::as_const(found).view(), {}, slots.ball_places()});
  }
  std::vector<Slot> places() const {
    std::vector<Slot> all(static_cast<std::size_t>(slots.places().size()));
    copy_bytes<Host, Space>(all.data(), slots.places().data(), all.size() * sizeof(Slot));
    return all;
  }
};

TYPED_TEST(SlotsTest, EachCandidateHasOnePlaceInItsOrder) {
  const BodyTable bodies = balls(300, false);
  const std::vector<Pair> pairs = random_pairs(300, 1500, 1);
  Built<TypeParam> built(bodies);
  built.build(pairs);
  const std::vector<Slot> places = built.places();
  EXPECT_EQ(built.slots.other_tiles(), 0);
  ASSERT_EQ(std::ssize(places), built.slots.ball_places());
  for (std::size_t k = 0; k < places.size(); ++k) {
    const bool is_there = k < pairs.size();
    EXPECT_EQ(places[k].i, is_there ? pairs[k].i : Slot::empty);
    if (!is_there) continue;
    EXPECT_EQ(places[k].j, pairs[k].j);
    EXPECT_EQ(places[k].candidate, static_cast<std::int32_t>(k));
  }
}

TYPED_TEST(SlotsTest, ThoseOfBallsAreFirst) {
  BodyTable bodies = balls(300, false);
  for (std::size_t k = 3; k < 300; k += 3) bodies.shape[k] = Shape::box;
  const std::vector<Pair> pairs = random_pairs(300, 1500, 1);
  Built<TypeParam> built(bodies);
  built.build(pairs);
  const std::vector<Slot> places = built.places();
  std::vector<std::int32_t> expected[2], seen[2];
  const auto is_box = [&](std::int32_t k) { return bodies.shape[static_cast<std::size_t>(k)] == Shape::box; };
  for (std::size_t k = 0; k < pairs.size(); ++k)
    expected[is_box(pairs[k].i) || is_box(pairs[k].j)].push_back(static_cast<std::int32_t>(k));
  for (std::int64_t place = 0; place < std::ssize(places); ++place) {
    const Slot& slot = places[static_cast<std::size_t>(place)];
    if (slot.i != Slot::empty) seen[place >= built.slots.ball_places()].push_back(slot.candidate);
  }
  for (const bool other : {false, true}) {
    EXPECT_EQ(seen[other], expected[other]);
    EXPECT_GT(seen[other].size(), 300u);
  }
}

TYPED_TEST(SlotsTest, ATubeHasASlotForEachSurfaceAndOneThatTurnsAPointForEach) {
  Built<TypeParam> built(balls(10, true));
  built.build({{0, 2}, {1, 2}, {1, 3}, {2, 3}});
  EXPECT_EQ(built.slots.other_tiles(), 0);
  EXPECT_EQ(built.slots.solver_bodies().first_wall_point(), 11);
  EXPECT_EQ(built.slots.solver_bodies().count(), 17);
  std::multiset<std::pair<std::int32_t, std::int32_t>> on_tube;
  std::set<std::int32_t> points;
  for (const Slot& slot : built.places()) {
    if (slot.i == Slot::empty) continue;
    EXPECT_EQ(slot.end_j, slot.j);
    if (slot.i != 1) {
      EXPECT_EQ(slot.end_i, slot.i);
      continue;
    }
    on_tube.insert({slot.candidate, slot.surface});
    EXPECT_TRUE(points.insert(slot.end_i).second);
    EXPECT_GE(slot.end_i, 11);
    EXPECT_LT(slot.end_i, 17);
  }
  EXPECT_EQ(on_tube, (std::multiset<std::pair<std::int32_t, std::int32_t>>{
                         {1, 0}, {1, 1}, {1, 2}, {2, 0}, {2, 1}, {2, 2}}));
}

TYPED_TEST(SlotsTest, KnowWhetherTheirPlacesAreCandidatesAndWhetherAnyIsRare) {
  const std::vector<Pair> pairs{{0, 2}, {1, 2}, {1, 3}, {2, 3}};
  const auto built = [&](const BodyTable& of) {
    Built<TypeParam> all(of);
    all.build(pairs);
    return std::pair(all.slots.are_candidates(), all.slots.has_rare_balls());
  };
  EXPECT_EQ(built(balls(10, false)), std::pair(true, false)) << "balls and a plane";
  EXPECT_EQ(built(balls(10, true)), std::pair(false, true)) << "a tube that turns";
  BodyTable bodies = balls(10, false);
  bodies.spin[0] = Vec3(0, 1, 0);
  bodies.mobility[0] = Mobility::prescribed;
  EXPECT_EQ(built(bodies), std::pair(true, true)) << "a plane that turns";
  bodies = balls(10, false);
  bodies.shape[3] = Shape::box;
  EXPECT_EQ(built(bodies), std::pair(false, false)) << "a free box has no slot of balls";
  bodies.mobility[3] = Mobility::fixed;
  EXPECT_EQ(built(bodies), std::pair(true, true)) << "a fixed box";
}

/// Returns the numbers from 0 to n - 1.
std::vector<std::int32_t> first_numbers(std::int32_t n) {
  std::vector<std::int32_t> numbers(static_cast<std::size_t>(n));
  std::iota(numbers.begin(), numbers.end(), 0);
  return numbers;
}

/// A ball that touches a thousand others is split into many parts, each with few contacts.
TYPED_TEST(SlotsTest, AHubIsSplit) {
  const BodyTable bodies = balls(1002, false);
  std::vector<Pair> pairs;
  for (std::int32_t k = 2; k < 1002; ++k) pairs.push_back({1, k});
  Built<TypeParam> built(bodies);
  built.build(pairs);
  EXPECT_EQ(built.slots.solver_bodies().hubs().size(), 0) << "slots alone make no hub";
  EXPECT_TRUE(built.split_hubs(first_numbers(1000)));
  const std::vector<Slot> places = built.places();
  ASSERT_EQ(built.slots.solver_bodies().hubs().size(), 1);
  std::map<std::int32_t, int> of_part;
  for (const Slot& slot : places)
    if (slot.i != Slot::empty) ++of_part[slot.end_i];
  EXPECT_EQ(built.slots.solver_bodies().first_part(), 1003);
  EXPECT_EQ(built.slots.solver_bodies().count(), 1003 + static_cast<std::int64_t>(of_part.size()));
  for (const auto& [part, count] : of_part) {
    EXPECT_GE(part, 1002);
    EXPECT_LE(count, 32);
  }
}

/// A ball lies on a plane and two heavy balls, with a thousand light ones around it: the contacts that carry
/// it are on one part.
TYPED_TEST(SlotsTest, TheHeaviestNeighboursOfAHubShareAPart) {
  BodyTable bodies = balls(1005, false);
  std::vector<Pair> pairs = {{0, 1}};
  bodies.inverse_mass[0] = 0;
  bodies.inverse_mass[1] = 1e-3;
  for (std::int32_t k = 2; k < 1005; ++k) {
    bodies.inverse_mass[static_cast<std::size_t>(k)] = k == 500 || k == 900 ? 2e-3 : 1;
    pairs.push_back({1, k});
  }
  Built<TypeParam> built(bodies);
  built.build(pairs);
  ASSERT_TRUE(built.split_hubs(first_numbers(1004)));
  std::vector<double> share(static_cast<std::size_t>(built.slots.solver_bodies().share_of_parts().size()));
  copy_bytes<Host, TypeParam>(share.data(), built.slots.solver_bodies().share_of_parts().data(),
                              share.size() * sizeof(double));
  double sum = 0;
  for (const double part : share) sum += part;
  EXPECT_NEAR(sum, 1, 1e-12);
  for (const Slot& slot : built.places()) {
    if (slot.i == Slot::empty || (slot.i != 0 && slot.j != 500 && slot.j != 900)) continue;
    EXPECT_EQ(slot.i == 0 ? slot.end_j : slot.end_i, built.slots.solver_bodies().first_part());
  }
  // Half of the share goes by weight: 1,000 for the plane, 500 for each heavy ball, and 9 for light ones, of
  // 3,001 in all. The other half is divided equally.
  EXPECT_NEAR(share[0], 0.5 * (2009.0 / 3001 + 1.0 / static_cast<double>(share.size())), 1e-3);
  EXPECT_LT(share[1], 0.01);
}

template <class Space>
void color_all(Built<Space>& built, std::uint8_t color) {
  const View<std::uint8_t> colors = built.slots.ball_colors();
  parallel::fill<Space>("test", colors, color);
}
template <class Space>
std::vector<std::uint8_t> colors_of(Built<Space>& built) {
  const View<std::uint8_t> colors = built.slots.ball_colors();
  std::vector<std::uint8_t> all(static_cast<std::size_t>(colors.size()));
  copy_bytes<Host, Space>(all.data(), colors.data(), all.size());
  return all;
}

/// Only contacts make a hub, and it is whole again when it has lost them. Contacts that were or are on its
/// parts forget their colours; others keep them.
TYPED_TEST(SlotsTest, AHubComesAndGoesWithItsContacts) {
  std::vector<Pair> pairs{{300, 301}};
  for (std::int32_t k = 2; k < 102; ++k) pairs.push_back({1, k});
  Built<TypeParam> built(balls(400, false));
  built.build(pairs);
  ASSERT_TRUE(built.slots.solver_bodies().may_have_hubs());
  const auto hubs = [&] { return built.slots.solver_bodies().hubs().size(); };
  const auto is_whole = [&] {
    for (const Slot& slot : built.places())
      if (slot.i != Slot::empty && (slot.end_i != slot.i || slot.end_j != slot.j)) return false;
    return true;
  };

  color_all(built, 3);
  EXPECT_FALSE(built.split_hubs(first_numbers(33))) << "32 contacts of the ball";
  EXPECT_EQ(hubs(), 0);
  EXPECT_TRUE(is_whole());
  EXPECT_EQ(colors_of(built)[5], 3);

  EXPECT_TRUE(built.split_hubs(first_numbers(34))) << "33 contacts";
  EXPECT_EQ(hubs(), 1);
  EXPECT_EQ(built.slots.solver_bodies().hub_of_parts().size(), 3);
  EXPECT_FALSE(is_whole());
  EXPECT_EQ(colors_of(built)[0], 3) << "not on the hub";
  EXPECT_EQ(colors_of(built)[5], no_color);

  color_all(built, 3 | on_part);
  EXPECT_TRUE(built.split_hubs(first_numbers(33))) << "the hub goes";
  EXPECT_EQ(hubs(), 0);
  EXPECT_TRUE(is_whole());
  EXPECT_EQ(colors_of(built)[5], no_color);
  EXPECT_FALSE(built.split_hubs(first_numbers(33)));

  Built<TypeParam> few(balls(400, false));
  few.build({pairs.begin(), pairs.begin() + 33});
  EXPECT_FALSE(few.slots.solver_bodies().may_have_hubs());
  EXPECT_FALSE(few.split_hubs(first_numbers(33)));
}

template <class Real>
struct Remember {
  ConstView<Slot> places;
  View<BallMemory<Real>> memory;
  View<V3<Real>> couples;
  SCREE_HD void operator()(std::int64_t p) const {
    memory[p].impulse = {static_cast<Real>(places[p].i), static_cast<Real>(places[p].j), Real(1)};
    couples[p] = {Real(2), static_cast<Real>(places[p].j), static_cast<Real>(places[p].i)};
  }
};

TYPED_TEST(SlotsTest, MemoryOutlivesTheCandidates) {
  Built<TypeParam> built(balls(200, false));
  const std::vector<Pair> before = random_pairs(200, 700, 2);
  const std::vector<Pair> after = random_pairs(200, 900, 3);
  built.build(before);
  parallel::for_each<TypeParam>(
      "test", built.slots.places().size(),
      Remember<double>{built.slots.places(), built.slots.ball_memory(), built.slots.couples()});
  built.build(after);
  const std::vector<Slot> places = built.places();
  std::vector<BallMemory<double>> memory(places.size());
  copy_bytes<Host, TypeParam>(memory.data(), built.slots.ball_memory().data(),
                              memory.size() * sizeof(BallMemory<double>));
  std::vector<V3<double>> couples(places.size());
  copy_bytes<Host, TypeParam>(couples.data(), built.slots.couples().data(),
                              couples.size() * sizeof(V3<double>));
  int kept = 0;
  for (std::size_t p = 0; p < places.size(); ++p) {
    if (places[p].i == Slot::empty) continue;
    const bool known = std::ranges::any_of(
        before, [&](const Pair& pair) { return pair.i == places[p].i && pair.j == places[p].j; });
    EXPECT_EQ(memory[p].is_loaded(), known);
    EXPECT_EQ(couples[p].x, known ? 2 : 0);
    if (known) {
      EXPECT_EQ(memory[p].impulse.x, places[p].i);
      EXPECT_EQ(memory[p].impulse.y, places[p].j);
      EXPECT_EQ(couples[p].y, places[p].j);
      EXPECT_EQ(couples[p].z, places[p].i);
    }
    kept += known;
  }
  EXPECT_GT(kept, 10);
}

TYPED_TEST(SlotsTest, MemoryOutlivesMovesOfTheBodies) {
  constexpr std::int32_t count = 200;
  const BodyTable table = balls(count, false);
  const std::vector<Pair> before = random_pairs(count, 700, 2);
  Built<TypeParam> built(table);
  built.build(before);
  parallel::for_each<TypeParam>(
      "test", built.slots.places().size(),
      Remember<double>{built.slots.places(), built.slots.ball_memory(), built.slots.couples()});

  // The bodies move to any other places, and the pairs are in their order there.
  std::vector<std::int32_t> place_before(count), place_now(count);
  for (std::int32_t k = 0; k < count; ++k) {
    place_before[static_cast<std::size_t>(k)] = (37 * k + 5) % count;
    place_now[static_cast<std::size_t>((37 * k + 5) % count)] = k;
  }
  BodyTable moved = table;
  permute(moved, place_before);
  copy_bodies(built.bodies, moved);
  std::vector<Pair> after;
  for (const Pair& pair : before)
    after.push_back(
        {place_now[static_cast<std::size_t>(pair.i)], place_now[static_cast<std::size_t>(pair.j)]});
  std::ranges::sort(after, {}, [](const Pair& pair) {
    return std::pair(std::min(pair.i, pair.j), std::max(pair.i, pair.j));
  });
  built.build(after, place_before);

  const std::vector<Slot> places = built.places();
  std::vector<BallMemory<double>> memory(places.size());
  copy_bytes<Host, TypeParam>(memory.data(), built.slots.ball_memory().data(),
                              memory.size() * sizeof(BallMemory<double>));
  int turned = 0;
  for (std::size_t p = 0; p < places.size(); ++p) {
    if (places[p].i == Slot::empty) continue;
    EXPECT_EQ(memory[p].impulse.x, place_before[static_cast<std::size_t>(places[p].i)]);
    EXPECT_EQ(memory[p].impulse.y, place_before[static_cast<std::size_t>(places[p].j)]);
    if (places[p].i > places[p].j) ++turned;
  }
  EXPECT_GT(turned, 100);
}

}  // namespace
}  // namespace scree::solver
