// Impulses remembered from substep to substep: each finds its own point again.
#include "sim/dynamics/contact_set.hpp"

#include "narrowphase/narrow_phase.hpp"

#include <gtest/gtest.h>

#include <utility>

namespace scree {
namespace {

Manifold manifold(std::int32_t i, std::int32_t j, std::int32_t part,
                  std::initializer_list<std::uint32_t> features) {
  Manifold m;
  m.i = i;
  m.j = j;
  m.part = part;
  m.normal = Vec3::UnitZ();
  for (const std::uint32_t feature : features) m.points[m.count++] = {Vec3::Zero(), 0, feature};
  return m;
}

/// The impulse given to the point of a manifold below: told by all that names it.
Vec3 mark(const Manifold& m, int k) { return Vec3(m.i + 1, 100 * m.j + 10 * m.part, m.points[k].feature); }

class Memory : public testing::Test {
 protected:
  // A hub (0) with many contacts; a pair (1, 3) with several manifolds on two parts.
  std::vector<Manifold> manifolds{
      manifold(0, 1, 0, {5, 6}), manifold(0, 2, 0, {5}),    manifold(0, 3, 0, {7}), manifold(1, 3, 0, {1}),
      manifold(1, 3, 0, {2}),    manifold(1, 3, 1, {1, 2}), manifold(2, 3, 0, {4})};
  ImpulseMemory memory;
  const std::size_t unloaded = 5;  // the cap of (1, 3)

  void SetUp() override {
    detail::ManifoldChunk list;
    for (const Manifold& m : manifolds) list.append(m);
    ContactSet set;
    set.rows.resize(static_cast<std::int64_t>(list.points.size()));
    for (std::size_t n = 0; n < manifolds.size(); ++n) {
      for (int k = 0; k < manifolds[n].count; ++k) {
        set.rows.view()[list.headers[n].first_point + k].impulse =
            n != unloaded ? mark(manifolds[n], k) : Vec3(Vec3::Zero());
      }
    }
    memory.remember({.headers = {list.headers.data(), static_cast<std::int64_t>(list.headers.size())},
                     .points = {list.points.data(), static_cast<std::int64_t>(list.points.size())}},
                    set, 4);
  }
};

bool recall(const ImpulseMemory& memory, const Manifold& m, Vec3* impulses) {
  const ManifoldHeader header{
      .i = m.i, .j = m.j, .part = m.part, .count = m.count, .first_point = 0, .normal = m.normal};
  return memory.recall(header, m.points, impulses);
}

TEST_F(Memory, EveryPointFindsItsOwn) {
  for (std::size_t n = 0; n < manifolds.size(); ++n) {
    Vec3 impulses[Manifold::max_points];
    const Manifold& m = manifolds[n];
    EXPECT_EQ(recall(memory, m, impulses), n != unloaded) << n;
    for (int k = 0; k < m.count && n != unloaded; ++k) EXPECT_EQ(impulses[k], mark(m, k)) << n;
  }
}

TEST_F(Memory, ANewPointOfALoadedPartHasNoneAndDoesNotBounce) {
  Vec3 impulses[Manifold::max_points];
  EXPECT_TRUE(recall(memory, manifold(1, 3, 0, {9, 2}), impulses));
  EXPECT_EQ(impulses[0], Vec3(0, 0, 0));
  EXPECT_EQ(impulses[1], mark(manifolds[4], 0));
}

TEST_F(Memory, PairsAndPartsThatWereNotInContactHaveNone) {
  Vec3 impulses[Manifold::max_points];
  for (const Manifold& m :
       {manifold(0, 1, 1, {5}), manifold(1, 2, 0, {1}), manifold(1, 3, 2, {1}), manifold(3, 3, 0, {1})}) {
    EXPECT_FALSE(recall(memory, m, impulses));
    EXPECT_EQ(impulses[0], Vec3(0, 0, 0));
  }
}

TEST(FreshMemory, KnowsNothing) {
  Vec3 impulses[Manifold::max_points];
  EXPECT_FALSE(recall(ImpulseMemory(), manifold(0, 1, 0, {0}), impulses));
}

}  // namespace
}  // namespace scree
