// Tests of spheres and boxes in tubes, against distances in long double by another formula, and against
// samples of the whole box.
#include "bench/narrowphase/families.hpp"
#include "bench/narrowphase/oracle.hpp"
#include "narrowphase/box_tube.hpp"
#include "narrowphase/sphere_tube.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace scree {
namespace {

using oracle::Real;
using oracle::Tube;
using oracle::Vec;

constexpr int draws = 20000;

struct Case {
  Solid tube, body;
  double scale;
};

/// Draws a tube of mm to km, anywhere and turned at random, and a body with its centre in or near it.
Case draw_case(std::uint64_t stream, int n) {
  Random random(stream, static_cast<std::uint64_t>(n));
  Case c;
  c.scale = std::pow(10.0, static_cast<double>(n % 7) - 3);
  const double radius = c.scale * random.uniform(0.3, 1);
  c.tube.position = 10 * c.scale * random.uniform() * oracle::random_unit(random);
  c.tube.orientation = oracle::random_turn(random);
  c.tube.size = Vec3(radius, radius, c.scale * random.uniform(0.3, 1));
  const double angle = random.uniform(0, 2 * pi);
  const double from_axis = 1.5 * radius * random.uniform();
  const double along = 1.5 * c.tube.size.z() * random.uniform(-1, 1);
  c.body.position = c.tube.position + c.tube.orientation * Vec3(from_axis * std::cos(angle),
                                                                from_axis * std::sin(angle), along);
  c.body.orientation = oracle::random_turn(random);
  for (int k = 0; k < 3; ++k) c.body.size[k] = c.scale * random.uniform(0.02, 0.5);
  return c;
}

void expect_contact(const Manifold& m, const ContactPoint& point, const Tube& tube, const Vec& on_body,
                    double scale) {
  ASSERT_NEAR(point.gap, static_cast<double>(tube.distance(m.part, on_body)), 1e-14 * scale);
  const Vec outward = tube.outward(m.part, on_body);
  ASSERT_LT((m.normal.cast<Real>() - outward).norm(), 1e-13L);
  const Vec middle = on_body + 0.5L * tube.distance(m.part, on_body) * outward;
  ASSERT_LT((point.position.cast<Real>() - middle).norm(), 1e-14L * scale);
}

TEST(SphereTube, WallAndCapsAreExactAndNoneIsMissed) {
  int outside = 0;
  int at_three = 0;
  for (int n = 0; n < 5 * draws; ++n) {
    const Case c = draw_case(1, n);
    const Tube tube(c.tube);
    const Vec centre = c.body.position.cast<Real>();
    const double margin = 0.1 * c.scale;
    Manifold m[max_pair_manifolds];
    const int count = sphere_tube(c.body, c.tube, margin, m);
    const Real depth = tube.depth(centre, margin);
    if (std::abs(depth) < 1e-12L * c.scale) continue;
    int expected = 0;
    bool certain = true;
    for (int part = 0; part < 3; ++part) {
      const Real gap = tube.distance(part, centre) - c.body.size.x();
      expected += depth > 0 && gap <= margin;
      certain = certain && std::abs(gap - margin) > 1e-12L * c.scale;
    }
    if (!certain) continue;
    ASSERT_EQ(count, expected) << n;
    outside += depth < 0;
    at_three += count == 3;
    for (int k = 0; k < count; ++k) {
      ASSERT_EQ(m[k].count, 1);
      if (k > 0) {
        ASSERT_GT(m[k].part, m[k - 1].part);
      }
      // Near the axis the direction is rounding noise, but the gap stays exact.
      if (m[k].part == tube_wall && tube.distance(tube_wall, centre) > tube.radius * (1 - 1e-2L)) continue;
      const Vec on_ball = centre + c.body.size.x() * tube.outward(m[k].part, centre);
      expect_contact(m[k], m[k].points[0], tube, on_ball, 10 * c.scale);
    }
  }
  EXPECT_GT(outside, draws / 2);
  EXPECT_GT(at_three, draws / 20);
}

TEST(SphereTube, OnTheAxisTheNormalIsAcrossItAndAlwaysTheSame) {
  for (const double scale : {1e-6, 1.0, 1e6}) {
    Random random(2, 0);
    const Solid tube{scale * Vec3(3, -2, 7), oracle::random_turn(random), scale * Vec3(1, 1, 4)};
    // One ball just fits, and the other is wider than the tube.
    for (const double radius : {0.999, 1.5}) {
      const Solid ball{tube.position, Quat::Identity(), Vec3::Constant(radius * scale)};
      Manifold m[max_pair_manifolds];
      ASSERT_EQ(sphere_tube(ball, tube, 0.01 * scale, m), 1);
      EXPECT_EQ(m[0].normal, Vec3(tube.orientation.toRotationMatrix().col(0)));
      EXPECT_NEAR(m[0].points[0].gap, (1 - radius) * scale, 1e-15 * scale);
      EXPECT_TRUE(m[0].points[0].position.allFinite());
    }
  }
}

/// Returns the smallest distance to a surface over the corners, edges, faces and inside of a box.
Real sampled_distance(const Tube& tube, int part, const Solid& box) {
  const oracle::Box exact(box);
  constexpr int steps = 8;
  Real least = INFINITY;
  for (int x = 0; x <= steps; ++x) {
    for (int y = 0; y <= steps; ++y) {
      for (int z = 0; z <= steps; ++z) {
        const Vec share = (Vec(x, y, z) * 2 / steps - Vec::Ones()).cwiseProduct(exact.half);
        least = std::min(least, tube.distance(part, exact.centre + exact.axes * share));
      }
    }
  }
  return least;
}

TEST(BoxTube, NoPointOfTheBoxIsNearerThanTheContacts) {
  int touching = 0;
  for (int n = 0; n < draws / 4; ++n) {
    const Case c = draw_case(3, n);
    const Tube tube(c.tube);
    const Real depth = tube.depth(c.body.position.cast<Real>(), 0.1 * c.scale);
    if (std::abs(depth) < 1e-12L * c.scale) continue;
    Manifold m[max_pair_manifolds];
    const int count = box_tube(c.body, c.tube, 0.1 * c.scale, m);
    if (depth < 0) {
      ASSERT_EQ(count, 0);
      continue;
    }
    for (int part = 0; part < 3; ++part) {
      double found = HUGE_VAL;
      for (int k = 0; k < count; ++k) {
        for (int p = 0; p < m[k].count && m[k].part == part; ++p) found = std::min(found, m[k].points[p].gap);
      }
      const auto least = static_cast<double>(sampled_distance(tube, part, c.body));
      if (std::abs(least - 0.1 * c.scale) < 1e-12 * c.scale) continue;
      if (least > 0.1 * c.scale) {
        ASSERT_EQ(found, HUGE_VAL) << n;
      } else {
        ASSERT_NEAR(found, least, 1e-13 * c.scale) << n;
      }
      touching += found < HUGE_VAL;
    }
  }
  EXPECT_GT(touching, draws / 8);
}

TEST(BoxTube, EveryCornerWithinTheMarginIsAContactOfItsOwnWithTheWall) {
  for (int n = 0; n < draws; ++n) {
    const Case c = draw_case(4, n);
    const Tube tube(c.tube);
    if (tube.depth(c.body.position.cast<Real>(), 0.1 * c.scale) < 1e-12L * c.scale) continue;
    Manifold m[max_pair_manifolds];
    const int count = box_tube(c.body, c.tube, 0.1 * c.scale, m);
    int next = 0;
    for (const Vec& corner : oracle::Box(c.body).vertices) {
      const Real gap = tube.distance(tube_wall, corner);
      if (std::abs(gap - 0.1L * c.scale) < 1e-12L * c.scale) {
        next += next < count && m[next].part == tube_wall &&
                std::abs(m[next].points[0].gap - static_cast<double>(gap)) < 1e-12 * c.scale;
        continue;
      }
      if (gap > 0.1L * c.scale) continue;
      ASSERT_LT(next, count) << n;
      ASSERT_EQ(m[next].part, tube_wall) << n;
      if (tube.radius - gap > 1e-2L * tube.radius)
        expect_contact(m[next], m[next].points[0], tube, corner, 10 * c.scale);
      for (int k = 0; k < next; ++k) ASSERT_NE(m[k].points[0].feature, m[next].points[0].feature);
      ++next;
    }
    for (int k = next; k < count; ++k) ASSERT_NE(m[k].part, tube_wall) << n;
  }
}

TEST(BoxTube, AnInscribedBoxHasAsManyManifoldsAsThereAre) {
  const Solid tube{Vec3(1, 2, 3), Quat::Identity(), Vec3(5, 5, 2)};
  const Solid box{tube.position, Quat::Identity(), Vec3(3, 4, 2)};
  Manifold m[max_pair_manifolds];
  ASSERT_EQ(box_tube(box, tube, 1e-12, m), max_pair_manifolds);
  for (int k = 0; k < 8; ++k) EXPECT_EQ(m[k].part, tube_wall);
  EXPECT_EQ(m[8].part, tube_cap_below);
  EXPECT_EQ(m[8].count, 4);
  EXPECT_EQ(m[8].normal, Vec3(0, 0, -1));
  EXPECT_EQ(m[9].part, tube_cap_above);
  EXPECT_EQ(m[9].count, 4);
  EXPECT_EQ(m[9].normal, Vec3(0, 0, 1));
}

TEST(BoxTube, ABoxLargerThanTheTubeOverlapsItAndStaysFinite) {
  const Solid tube{Vec3::Zero(), Quat::Identity(), Vec3(0.1, 0.1, 0.1)};
  const Solid box{Vec3::Zero(), Quat::Identity(), Vec3(1, 1, 1)};
  Manifold m[max_pair_manifolds];
  const int count = box_tube(box, tube, 0, m);
  ASSERT_EQ(count, max_pair_manifolds);
  for (int k = 0; k < count; ++k) {
    EXPECT_NEAR(m[k].normal.norm(), 1, 1e-15);
    for (int p = 0; p < m[k].count; ++p) {
      EXPECT_LT(m[k].points[p].gap, 0);
      EXPECT_TRUE(m[k].points[p].position.allFinite());
    }
  }
}

}  // namespace
}  // namespace scree
