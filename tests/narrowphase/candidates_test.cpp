// Tests of the candidates against a double loop, in each space.
#include "narrowphase/candidates.hpp"

#include "core/parallel_loops.hpp"
#include "core/rng.hpp"
#include "tests/core/spaces.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

namespace scree {
namespace {

template <class Space>
class CandidatesTest : public test::InSpace<Space> {};
TYPED_TEST_SUITE(CandidatesTest, test::Spaces, test::SpaceName);

constexpr std::int32_t count = 120;

/// Returns balls of all mobilities, with planes at the first, a middle and the last number.
Bodies<Host> random_bodies() {
  BodyTable table;
  for (std::int32_t k = 0; k < count; ++k) {
    Random random(3, static_cast<std::uint64_t>(k));
    const bool plane = k == 0 || k == count / 2 || k == count - 1;
    const double x = random.uniform(-1, 1);
    const double y = random.uniform(-1, 1);
    table.position.push_back(plane ? Vec3(Vec3::Zero()) : Vec3(x, y, random.uniform(-1, 1)));
    table.orientation.push_back(rotation_of(Vec3(0.3 * k, 0.2, 0)));
    table.velocity.push_back(Vec3::Zero());
    table.spin.push_back(Vec3::Zero());
    table.size.push_back(Vec3::Constant(random.uniform(0.05, 0.3)));
    table.inverse_mass.push_back(plane ? 0 : 1);
    table.inverse_inertia.push_back(Vec3::Zero());
    table.shape.push_back(plane ? Shape::plane : Shape::sphere);
    table.mobility.push_back(plane || k % 7 == 1 ? Mobility::fixed
                             : k % 11 == 2       ? Mobility::absent
                             : k % 5 == 3        ? Mobility::prescribed
                                                 : Mobility::free);
    table.material.push_back(0);
    table.id.push_back(BodyNumber{k});
  }
  Bodies<Host> bodies;
  copy_bodies(bodies, table);
  return bodies;
}

/// Expects the candidates twice, since what is kept from the first time must not show in the second.
template <class Space>
void expect_listed(const Bodies<Host>& bodies, const std::vector<Pair>& pcs,
                   const Array<double, Host>& margin,
                   const std::vector<std::pair<std::int32_t, std::int32_t>>& expected) {
  Bodies<Space> bodies_there;
  Array<Pair, Space> pcs_there;
  Array<double, Space> margin_there;
  copy_bodies(bodies_there, bodies);
  copy(pcs_there, pcs);
  copy(margin_there, margin);
  Candidates<Space> candidates;
  for (int again = 0; again < 2; ++again) {
    const ConstView<Pair> found =
        candidates.list({view_of(std::as_const(bodies_there)), std::as_const(margin_there).view()},
                        std::as_const(pcs_there).view());
    ASSERT_EQ(found.size(), static_cast<std::int64_t>(expected.size()));
    std::vector<Pair> pairs(expected.size());
    copy_bytes<Host, Space>(pairs.data(), found.data(), pairs.size() * sizeof(Pair));
    for (std::size_t k = 0; k < pairs.size(); ++k) ASSERT_EQ(std::pair(pairs[k].i, pairs[k].j), expected[k]);
  }
}

TYPED_TEST(CandidatesTest, AreThePcsAndThePlanesInOrder) {
  const Bodies<Host> bodies = random_bodies();
  const ConstBodyView b = view_of(bodies);
  Array<double, Host> margin(count);
  parallel::fill("margin", margin, 0.02);
  // The PCS here contains planes too, in an order of its own, and pairs of fixed bodies.
  std::vector<Pair> pcs;
  for (std::int32_t d = count - 1; d > 0; --d) {
    for (std::int32_t i = 0; i + d < count; ++i) {
      const std::int32_t j = i + d;
      if (b.mobility[i] == Mobility::absent || b.mobility[j] == Mobility::absent) continue;
      if ((i * j) % 3 != 0) pcs.push_back({i, j});
    }
  }
  std::vector<std::pair<std::int32_t, std::int32_t>> expected;
  int near = 0, close = 0, far = 0;
  for (std::int32_t i = 0; i < count; ++i) {
    for (std::int32_t j = i + 1; j < count; ++j) {
      if (b.mobility[i] != Mobility::free && b.mobility[j] != Mobility::free) continue;
      const bool plane_i = b.shape[i] == Shape::plane;
      if (!plane_i && b.shape[j] != Shape::plane) {
        const bool absent = b.mobility[i] == Mobility::absent || b.mobility[j] == Mobility::absent;
        if (absent || (i * j) % 3 == 0) continue;
        const double gap = (b.position[j] - b.position[i]).norm() - b.size[i].x() - b.size[j].x();
        (gap > 0.04 ? far : close) += 1;
        if (gap <= 0.04) expected.emplace_back(i, j);
        continue;
      }
      const std::int32_t plane = plane_i ? i : j;
      const std::int32_t body = plane_i ? j : i;
      const Vec3 up = b.orientation[plane] * Vec3::UnitZ();
      if (up.dot(b.position[body]) - b.size[body].x() > 0.04) continue;
      expected.emplace_back(i, j);
      ++near;
    }
  }
  ASSERT_GT(near, 20);
  ASSERT_GT(close, 50);
  ASSERT_GT(far, 50);
  expect_listed<TypeParam>(bodies, pcs, margin, expected);
}

/// Some balls are inside a tilted tube and some outside: those near its wall or its caps are candidates.
TYPED_TEST(CandidatesTest, OfATubeAreThoseNearItsSurface) {
  BodyTable table = {};
  Bodies<Host> bodies = random_bodies();
  copy_bodies(table, bodies);
  std::vector<Pair> pcs;
  table.shape.assign(count, Shape::sphere);
  table.mobility.assign(count, Mobility::free);
  for (std::size_t k = 0; k < count; ++k) table.size[k] = Vec3::Constant(0.05);
  table.shape[7] = Shape::tube;
  table.mobility[7] = Mobility::prescribed;
  table.size[7] = Vec3(0.8, 0, 0.9);
  table.position[7] = Vec3(0.1, 0, -0.1);
  Array<double, Host> margin(count);
  parallel::fill("margin", margin, 0.02);
  margin.data()[7] = 0.1;
  std::vector<std::pair<std::int32_t, std::int32_t>> expected;
  int far = 0, outside = 0;
  for (std::int32_t k = 0; k < count; ++k) {
    if (k == 7) continue;
    const Pair pair{std::min(k, 7), std::max(k, 7)};
    pcs.push_back(pair);
    const Vec3 at =
        table.orientation[7].conjugate() * (table.position[static_cast<std::size_t>(k)] - table.position[7]);
    const double gap = std::min(0.8 - std::hypot(at.x(), at.y()), 0.9 - std::abs(at.z())) - 0.05;
    far += gap > 0.12;
    outside += gap < -0.1;
    if (gap <= 0.12) expected.emplace_back(pair.i, pair.j);
  }
  ASSERT_GT(far, 20);
  ASSERT_GT(outside, 20);
  std::ranges::sort(expected);
  copy_bodies(bodies, table);
  expect_listed<TypeParam>(bodies, pcs, margin, expected);
}

TYPED_TEST(CandidatesTest, OfNothingAreNone) {
  Bodies<TypeParam> bodies;
  Array<double, TypeParam> margin;
  EXPECT_EQ(
      Candidates<TypeParam>().list({view_of(std::as_const(bodies)), std::as_const(margin).view()}, {}).size(),
      0);
}

}  // namespace
}  // namespace scree
