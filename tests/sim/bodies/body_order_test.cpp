// Tests of the places of bodies, in each space, against sorting along a curve that is computed bit by bit.
#include "sim/bodies/body_order.hpp"

#include "tests/core/spaces.hpp"
#include "tests/sim/bodies/random_bodies.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace scree {
namespace {

template <class Space>
class BodyOrderTest : public test::InSpace<Space> {};
TYPED_TEST_SUITE(BodyOrderTest, test::Spaces, test::SpaceName);

/// Returns the place on the Z-order curve: the bits of the cell's coordinates in turn, that of x first.
std::uint64_t on_curve(const Vec3& x, double cell) {
  std::uint64_t code = 0;
  for (int bit = 20; bit >= 0; --bit)
    for (int a = 0; a < 3; ++a) {
      const auto number = static_cast<std::uint64_t>(std::floor(x[a] / cell) + 1048576);
      code = code << 1 | (number >> bit & 1);
    }
  return code;
}

TYPED_TEST(BodyOrderTest, BodiesLieAlongTheCurveWhereverTheyLayBefore) {
  const BodyTable table = random_bodies();
  const Vec3 origin(0.1, -0.2, 0.3);
  double logarithms = 0, free = 0;
  for (std::size_t k = 0; k < table.id.size(); ++k) {
    if (table.mobility[k] != Mobility::free) continue;
    logarithms += std::log(bounding_radius(table.shape[k], table.size[k]));
    ++free;
  }
  const double cell = 2 * std::exp(logarithms / free);
  std::vector<std::int32_t> expected(table.id.size());
  std::iota(expected.begin(), expected.end(), 0);
  std::ranges::stable_sort(expected, {}, [&](std::int32_t k) {
    const auto b = static_cast<std::size_t>(k);
    const bool absent = table.mobility[b] == Mobility::absent;
    return std::pair(absent, absent ? 0 : on_curve(table.position[b] - origin, cell));
  });

  const BodyTable elsewhere = shuffled(table);
  for (const BodyTable& start : {table, elsewhere}) {
    Bodies<TypeParam> bodies = in_space<TypeParam>(start);
    find_places<TypeParam>(bodies);
    BodyOrder<TypeParam> order(table, origin);
    order.sort(bodies);
    EXPECT_EQ(to_vector(bodies.id), numbers(expected));
    const std::vector<std::int32_t> places = to_vector(bodies.place_of);
    std::vector<std::int32_t> before(places.size());
    copy_bytes<Host, TypeParam>(before.data(), order.place_before().data(),
                                before.size() * sizeof(std::int32_t));
    for (std::size_t k = 0; k < places.size(); ++k) {
      EXPECT_EQ(places[static_cast<std::size_t>(expected[k])], static_cast<std::int32_t>(k));
      EXPECT_EQ(start.id[static_cast<std::size_t>(before[k])], BodyNumber{expected[k]});
    }
    BodyTable now;
    copy_by_number<TypeParam>(now, bodies);
    EXPECT_EQ(hash_of(now), hash_of(table)) << "the bodies are the same";
  }
}

TYPED_TEST(BodyOrderTest, AllImagesOfABodyHaveOnePlace) {
  BodyTable table = random_bodies();
  table.period = period_of(Vec3(-5, 0, 0), Vec3(10, 0, 0));
  BodyTable shifted = table;
  for (std::size_t k = 0; k < shifted.position.size(); k += 3)
    shifted.position[k].x() += 20 * (static_cast<double>(k % 5) - 2);
  Bodies<TypeParam> here = in_space<TypeParam>(table), there = in_space<TypeParam>(shifted);
  for (Bodies<TypeParam>* bodies : {&here, &there}) {
    find_places<TypeParam>(*bodies);
    BodyOrder<TypeParam>(table, Vec3::Zero()).sort(*bodies);
  }
  EXPECT_EQ(to_vector(here.id), to_vector(there.id));
}

TYPED_TEST(BodyOrderTest, WhatIsFarAwayOrNowhereHasAPlaceToo) {
  BodyTable table = random_bodies();
  table.position[10] = Vec3(1e30, -1e30, HUGE_VAL);
  table.position[20] = Vec3::Constant(std::nan(""));
  table.position[35] = Vec3(-1e30, -1e30, -1e30);
  Bodies<TypeParam> bodies = in_space<TypeParam>(shuffled(table));
  find_places<TypeParam>(bodies);
  BodyOrder<TypeParam>(table, Vec3::Zero()).sort(bodies);
  std::vector<BodyNumber> order = to_vector(bodies.id);
  EXPECT_EQ(order.front(), BodyNumber{20});
  EXPECT_EQ(order[1], BodyNumber{35});
  std::ranges::sort(order);
  for (std::size_t k = 0; k < order.size(); ++k) EXPECT_EQ(index_of(order[k]), k);
}

}  // namespace
}  // namespace scree
