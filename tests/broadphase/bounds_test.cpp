// Tests of bounds_of() against long double: bounds are never inside the exact box, and never outside of it by
// more than rounding.
#include "broadphase/bounds.hpp"

#include "core/rng.hpp"
#include "tests/core/spaces.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace scree {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

TEST(Rounding, NeighbouringFloatsAreThoseOfTheStandardLibrary) {
  for (const float x :
       {0.0f, -0.0f, 1.0f, -1.0f, 1e-45f, -1e-45f, FLT_MIN, -FLT_MIN, 0.1f, -3e38f, FLT_MAX}) {
    EXPECT_EQ(next_below(x), std::nextafter(x, -infinity)) << x;
    EXPECT_EQ(next_above(-x), std::nextafter(-x, infinity)) << -x;
  }
}

TEST(Rounding, IsOutwardAndTight) {
  for (int k = 0; k < 100000; ++k) {
    Random random(5, static_cast<std::uint64_t>(k));
    const double x = std::ldexp(random.uniform(-1, 1), static_cast<int>(random.uniform(-140, 120)));
    const float below = round_down(x);
    const float above = round_up(x);
    ASSERT_LE(below, x);
    ASSERT_GE(above, x);
    ASSERT_LE(above, std::nextafter(below, infinity));
  }
  EXPECT_EQ(round_down(0.5), 0.5f);
  EXPECT_EQ(round_up(0.5), 0.5f);
  EXPECT_EQ(round_down(1e-60), 0);
  EXPECT_EQ(round_down(-1e-60), -1e-45f);
  EXPECT_EQ(round_up(-1e-60), 0);
  EXPECT_EQ(round_down(0.0), 0);
  EXPECT_EQ(round_down(-0.0), 0);
  EXPECT_EQ(round_down(-1e39), -infinity);
  EXPECT_EQ(round_down(-HUGE_VAL), -infinity);
  EXPECT_EQ(round_down(1e39), FLT_MAX);
  EXPECT_EQ(round_up(1e39), infinity);
  EXPECT_TRUE(std::isnan(round_down(NAN)));
}

using Real = long double;

// Computes |R| h in long double from the normalised quaternion, with the entries of the rotation matrix by
// their definition.
void exact_half_extents(const BodyGeometry& body, Real extent[3]) {
  Real w = body.orientation.w(), x = body.orientation.x(), y = body.orientation.y(), z = body.orientation.z();
  const Real norm = std::sqrt(w * w + x * x + y * y + z * z);
  w /= norm, x /= norm, y /= norm, z /= norm;
  const Real rotation[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
                               {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
                               {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}};
  for (int a = 0; a < 3; ++a) {
    extent[a] = body.shape == Shape::sphere ? Real{body.size.x()} : Real{0};
    for (int b = 0; b < 3 && body.shape == Shape::box; ++b)
      extent[a] += std::abs(rotation[a][b]) * body.size[b];
    // The support of a tube's end along an axis, cos(t) x + sin(t) y, is largest where its derivative
    // vanishes.
    if (body.shape == Shape::tube) {
      const Real t = std::atan2(rotation[a][1], rotation[a][0]);
      extent[a] = (std::cos(t) * rotation[a][0] + std::sin(t) * rotation[a][1]) * body.size[0] +
                  std::abs(rotation[a][2]) * body.size[2];
    }
  }
}

BodyGeometry random_body(Random& random) {
  BodyGeometry body;
  const double shape = random.uniform();
  body.shape = shape < 0.4 ? Shape::sphere : shape < 0.8 ? Shape::box : Shape::tube;
  const double far = std::pow(10.0, random.uniform(-3, 9));
  body.orientation =
      Quat(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
  body.orientation.normalize();
  for (int a = 0; a < 3; ++a) {
    body.position[a] = far * random.uniform(-1, 1);
    body.size[a] = std::pow(10.0, random.uniform(-3, 1));
  }
  if (body.shape == Shape::tube) {
    body.size.y() = body.size.x();
    // Half of the tubes are aligned, as most are, or nearly so.
    if (random.uniform() < 0.5)
      body.orientation = Quat(1, random.uniform() < 0.5 ? 0 : random.uniform(0, 1e-8), 0, 0).normalized();
  }
  return body;
}

TEST(Bounds, HoldTheExactBoxAndAreTight) {
  for (int k = 0; k < 100000; ++k) {
    Random random(6, static_cast<std::uint64_t>(k));
    const BodyGeometry body = random_body(random);
    const double margin = random.uniform() < 0.5 ? 0.0 : random.uniform(0, 0.1);
    const Vec3 origin = random.uniform() < 0.5 ? Vec3::Zero() : Vec3(body.position * random.uniform());
    const Aabb bounds = bounds_of(body, margin, origin);
    Real extent[3];
    exact_half_extents(body, extent);
    for (int a = 0; a < 3; ++a) {
      const Real lo = Real{body.position[a]} - origin[a] - extent[a] - margin;
      const Real hi = Real{body.position[a]} - origin[a] + extent[a] + margin;
      ASSERT_LE(bounds.lo[a], lo);
      ASSERT_GE(bounds.hi[a], hi);
      const Real slack = 1e-14L * (std::abs(lo) + std::abs(hi) + body.size.norm());
      ASSERT_GE(std::nextafter(std::nextafter(bounds.lo[a], infinity), infinity), lo - slack);
      ASSERT_LE(std::nextafter(std::nextafter(bounds.hi[a], -infinity), -infinity), hi + slack);
    }
  }
}

template <class Space>
class BoundsInSpace : public test::InSpace<Space> {};
TYPED_TEST_SUITE(BoundsInSpace, test::Spaces, test::SpaceName);

TYPED_TEST(BoundsInSpace, OfManyBodiesAreThoseOfEach) {
  BodyTable table;
  std::vector<double> margin;
  for (int k = 0; k < 1000; ++k) {
    Random random(7, static_cast<std::uint64_t>(k));
    const BodyGeometry body = random_body(random);
    table.shape.push_back(k % 10 == 0 ? Shape::plane : body.shape);
    table.mobility.push_back(k % 7 == 0 ? Mobility::absent : Mobility::free);
    table.position.push_back(body.position);
    table.orientation.push_back(body.orientation);
    table.size.push_back(body.size);
    margin.push_back(random.uniform());
  }
  const Vec3 origin(1, -2, 3);
  Bodies<TypeParam> bodies;
  copy(bodies.shape, table.shape);
  copy(bodies.mobility, table.mobility);
  copy(bodies.position, table.position);
  copy(bodies.orientation, table.orientation);
  copy(bodies.size, table.size);
  Array<double, TypeParam> margins;
  copy(margins, margin);
  Array<Aabb, TypeParam> bounds(1000);
  compute_bounds<TypeParam>(view_of(std::as_const(bodies)), std::as_const(margins).view(), {}, origin,
                            bounds.view());
  const std::vector<Aabb> all = to_vector(bounds);
  for (std::size_t k = 0; k < all.size(); ++k) {
    const bool absent = table.mobility[k] == Mobility::absent;
    const Aabb one = absent
                         ? absent_bounds()
                         : bounds_of({table.shape[k], table.position[k], table.orientation[k], table.size[k]},
                                     margin[k], origin);
    ASSERT_EQ(is_absent(all[k]), absent || table.shape[k] == Shape::plane);
    for (int a = 0; a < 3; ++a) {
      ASSERT_EQ(all[k].lo[a], one.lo[a]);
      ASSERT_EQ(all[k].hi[a], one.hi[a]);
    }
  }
}

}  // namespace
}  // namespace scree
