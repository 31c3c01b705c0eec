// Tests of the contacts of general shapes against independent oracles: boxes as hulls against the 15 axes in
// long double, round bodies against sampled directions, and meshes against sampled points of all their
// triangles.
#include "narrowphase/general_contacts.hpp"

#include "bench/narrowphase/families.hpp"
#include "bench/narrowphase/oracle.hpp"
#include "core/geometry.hpp"
#include "core/random_orientation.hpp"
#include "core/rng.hpp"
#include "core/tolerances.hpp"
#include "narrowphase/convex_axes.hpp"
#include "narrowphase/gjk.hpp"
#include "tests/narrowphase/families.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace scree {
namespace {

using oracle::Family;
using oracle::SolidPair;

std::vector<Vec3> corners_of(const Vec3& half) {
  std::vector<Vec3> corners;
  for (int c = 0; c < 8; ++c)
    corners.push_back(half.cwiseProduct(Vec3(c & 1 ? 1 : -1, c & 2 ? 1 : -1, c & 4 ? 1 : -1)));
  return corners;
}

double least_gap(const Manifold& m) {
  double least = HUGE_VAL;
  for (int k = 0; k < m.count; ++k) least = std::min(least, m.points[k].gap);
  return least;
}

class HullFamilies : public testing::TestWithParam<Family> {};
INSTANTIATE_TEST_SUITE_P(Each, HullFamilies, testing::ValuesIn(all_families()), test_name);

// The families hold all cases in which libccd fails: shallow and deep pairs, aligned ones, parallel edges,
// coincident centres, sizes of 1:1000, tiny and huge ones.
TEST_P(HullFamilies, BoxesAsHullsMeetAsBoxesDo) {
  for (std::uint64_t n = 0; n < 2000; ++n) {
    const SolidPair p = oracle::make_pair(GetParam(), n);
    const Hull hulls[2] = {make_hull(corners_of(p.a.size)), make_hull(corners_of(p.b.size))};
    const ShapeData data[2] = {{.hull = &hulls[0]}, {.hull = &hulls[1]}};
    const double margin = n % 4 ? 0.05 * p.smallest : 0.0;
    const double separation = static_cast<double>(oracle::separation(p.a, p.b));
    const double gap = separation > 0 ? static_cast<double>(oracle::distance(p.a, p.b)) : separation;
    const double slack = 1e-11 * p.length;
    const double given_away = oracle::most_given_away(gap, p.smallest) + tolerance::same_feature * p.smallest;
    Manifold m;
    const int found = find_general_contacts({Shape::polyhedron, p.a}, {Shape::polyhedron, p.b},
                                            {&data[0], &data[1]}, {.margin = margin}, &m);
    if (gap < margin - given_away - slack) {
      ASSERT_EQ(found, 1) << "draw " << n << " gap " << gap / p.smallest;
    }
    if (gap > margin + slack) {
      ASSERT_EQ(found, 0) << "draw " << n << " gap " << gap / p.smallest;
    }
    if (!found) continue;
    ASSERT_TRUE(m.normal.allFinite() && std::abs(m.normal.norm() - 1) < 1e-12) << "draw " << n;
    ASSERT_GE(m.count, 1);
    ASSERT_LE(m.count, Manifold::max_points);
    ASSERT_LE(std::abs(least_gap(m) - gap), given_away + slack)
        << "draw " << n << " gap " << gap / p.smallest;
    // The separation along the normal holds for the bodies, and not for the points alone.
    const ConvexBody a({Shape::polyhedron, p.a}, &data[0], p.a.position),
        b({Shape::polyhedron, p.b}, &data[1], p.a.position);
    ASSERT_GE(separation_along(a, b, m.normal), std::min(gap, 0.0) - given_away - slack) << "draw " << n;

    if (gap >= margin - given_away - slack) continue;
    Manifold swapped;
    ASSERT_EQ(find_general_contacts({Shape::polyhedron, p.b}, {Shape::polyhedron, p.a}, {&data[1], &data[0]},
                                    {.margin = margin}, &swapped),
              1);
    ASSERT_LE(std::abs(least_gap(swapped) - gap), given_away + slack) << "draw " << n;
  }
}

Vec3 random_direction(Random& random) {
  Vec3 d;
  do {
    for (int k = 0; k < 3; ++k) d[k] = random.uniform(-1, 1);
  } while (d.norm() > 1 || d.norm() < 0.1);
  return d.normalized();
}

/// Climbs in small random steps from the best of many directions: an oracle that has only the support
/// functions in common with the search.
double sampled_separation(const ConvexBody& a, const ConvexBody& b, Random& random) {
  Vec3 best = Vec3::UnitX();
  double most = -HUGE_VAL;
  for (int k = 0; k < 600; ++k) {
    const Vec3 d = random_direction(random);
    const double s = separation_along(a, b, d);
    if (s > most) {
      most = s;
      best = d;
    }
  }
  for (double step = 0.1; step > 1e-9; step *= 0.9)
    for (int k = 0; k < 24; ++k) {
      const Vec3 d = (best + step * random_direction(random)).normalized();
      const double s = separation_along(a, b, d);
      if (s > most) {
        most = s;
        best = d;
      }
    }
  return most;
}

TEST(GeneralContacts, RoundBodiesPartAlongTheirBestDirection) {
  Random random(2, 0);
  std::vector<Vec3> points;
  for (int k = 0; k < 24; ++k) points.push_back(0.4 * random_direction(random));
  const Hull hull = make_hull(points);
  const ShapeData of_hull{.hull = &hull}, none{};
  const auto shape_of = [&](int kind, Vec3& size, const ShapeData*& data) {
    data = &none;
    switch (kind) {
      case 0:
        size = {0.3, 0, 0};
        return Shape::sphere;
      case 1:
        size = {0.3, 0.2, 0.4};
        return Shape::box;
      case 2:
        size = {0.2, 0.2, 0.5};
        return Shape::capsule;
      case 3:
        size = {0.3, 0.3, 0.15};
        return Shape::cylinder;
      default:
        size = hull.half_extent();
        data = &of_hull;
        return Shape::polyhedron;
    }
  };
  int overlapping = 0;
  for (int n = 0; n < 1500; ++n) {
    const int kinds[2] = {n % 5, 2 + n / 5 % 3};
    ShapedSolid body[2];
    const ShapeData* data[2];
    for (int k = 0; k < 2; ++k) {
      body[k].shape = shape_of(kinds[k], body[k].solid.size, data[k]);
      body[k].solid.orientation = random_orientation(random);
      body[k].solid.position =
          Vec3(100, -50, 30) +
          (k == 0 ? Vec3(Vec3::Zero()) : Vec3(random.uniform(0.2, 0.9) * random_direction(random)));
    }
    Manifold m;
    const int found = find_general_contacts(body[0], body[1], {data[0], data[1]}, {.margin = HUGE_VAL}, &m);
    ASSERT_EQ(found, 1) << n;
    ASSERT_TRUE(m.normal.allFinite());
    const Vec3& origin = body[0].solid.position;
    const ConvexBody a(body[0], data[0], origin), b(body[1], data[1], origin);
    const double sampled = sampled_separation(a, b, random);
    const double given_away = oracle::most_given_away(sampled, 1.0);
    // The sampled direction may itself fall short of the best one, but the search must not fall short of it.
    ASSERT_GE(separation_along(a, b, m.normal), sampled - given_away - 1e-9)
        << n << " " << kinds[0] << kinds[1];
    ASSERT_GE(least_gap(m), sampled - given_away - 1e-9) << n << " " << kinds[0] << kinds[1];
    ConvexAxes axes;
    ASSERT_TRUE(best_axes(a, b, HUGE_VAL, std::min(a.size(), b.size()), axes));
    ASSERT_GE(axes.best.separation, sampled - 1e-6) << n << " " << kinds[0] << kinds[1];
    if (sampled > 1e-3) {
      // The best direction separates the bodies by the distance of their closest points; no direction can
      // show more.
      const ClosestPoints near = closest_points(a, b, Vec3::Zero(), 1e-12);
      ASSERT_NEAR((near.on_b - near.on_a).norm() - a.radius() - b.radius(), axes.best.separation, 1e-9) << n;
    }
    overlapping += sampled < 0;
  }
  EXPECT_GT(overlapping, 300);
  EXPECT_LT(overlapping, 1300);
}

TEST(GeneralContacts, RigidMotionAndScaleChangeNothing) {
  Random random(5, 1);
  for (int n = 0; n < 200; ++n) {
    const ShapedSolid a{Shape::cylinder, {Vec3::Zero(), random_orientation(random), {0.3, 0.3, 0.2}}};
    const ShapedSolid b{Shape::capsule,
                        {0.45 * random_direction(random), random_orientation(random), {0.1, 0.1, 0.4}}};
    Manifold m, moved;
    const ShapeData none{};
    ASSERT_EQ(find_general_contacts(a, b, {&none, &none}, {.margin = HUGE_VAL}, &m), 1);
    const Quat turn = random_orientation(random);
    for (const double scale : {1e-4, 1e4}) {
      const auto place = [&](const ShapedSolid& s) {
        return ShapedSolid{
            s.shape, {scale * (turn * s.solid.position), turn * s.solid.orientation, scale * s.solid.size}};
      };
      ASSERT_EQ(find_general_contacts(place(a), place(b), {&none, &none}, {.margin = HUGE_VAL}, &moved), 1);
      EXPECT_NEAR(least_gap(moved) / scale, least_gap(m), 1e-5) << n;
    }
  }
}

/// A mesh whose triangles are tested one by one.
struct Mesh {
  TriangleMesh mesh;
  std::vector<PlacedTriangle> placed;
  std::vector<Surroundings> around;

  explicit Mesh(TriangleMesh m) : mesh(std::move(m)) {
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      PlacedTriangle triangle;
      EXPECT_TRUE(place_triangle(mesh, t, triangle));
      placed.push_back(triangle);
    }
    around = surroundings_of(mesh, placed);
  }

  std::vector<Manifold> contacts(const ShapedSolid& body, const ShapeData* data, double margin) const {
    std::vector<Manifold> found;
    for (std::size_t t = 0; t < placed.size(); ++t) {
      const ShapeData of_triangle{.surroundings = &around[t]};
      Manifold m;
      if (find_general_contacts(
              body, {Shape::triangle, {placed[t].position, placed[t].orientation, placed[t].size}},
              {data, &of_triangle}, {.margin = margin}, &m))
        found.push_back(m);
    }
    return found;
  }

  double distance_to(const Vec3& point) const {
    double least = HUGE_VAL;
    for (const auto& t : mesh.triangles) {
      const Vec3 &a = mesh.vertices[static_cast<std::size_t>(t[0])],
                 &b = mesh.vertices[static_cast<std::size_t>(t[1])],
                 &c = mesh.vertices[static_cast<std::size_t>(t[2])];
      // A search with halved steps finds the nearest point, since the distance is convex in the weights.
      Eigen::Vector2d best(0.33, 0.33);
      double at_best = HUGE_VAL;
      for (double step = 0.25; step > 1e-10; step *= 0.5)
        for (bool better = true; better;) {
          better = false;
          for (int i = -1; i <= 1; ++i)
            for (int j = -1; j <= 1; ++j) {
              Eigen::Vector2d w = (best + step * Eigen::Vector2d(i, j)).cwiseMax(0);
              if (w.sum() > 1) w /= w.sum();
              const double d = (a + w.x() * (b - a) + w.y() * (c - a) - point).norm();
              if (d < at_best - 1e-15) {
                at_best = d;
                best = w;
                better = true;
              }
            }
        }
      least = std::min(least, at_best);
    }
    return least;
  }
};

TriangleMesh uneven(double roughness, std::uint64_t seed) {
  Random random(seed, 0);
  TriangleMesh mesh;
  constexpr int n = 7;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const double x = i + random.uniform(-0.3, 0.3), y = j + random.uniform(-0.3, 0.3);
      mesh.vertices.emplace_back(x, y, roughness * random.uniform(-1, 1));
    }
  for (int j = 0; j + 1 < n; ++j)
    for (int i = 0; i + 1 < n; ++i) {
      const int a = n * j + i, b = a + 1, c = a + n + 1, d = a + n;
      if (random.uniform(0, 1) < 0.5) {
        mesh.triangles.push_back({a, b, c});
        mesh.triangles.push_back({c, d, a});
      } else {
        mesh.triangles.push_back({a, b, d});
        mesh.triangles.push_back({b, c, d});
      }
    }
  return mesh;
}

TEST(MeshContacts, ASphereOnAFlatMeshHasOneContactWhereverItIs) {
  const Mesh mesh(uneven(0, 1));
  Random random(7, 0);
  for (int n = 0; n < 2000; ++n) {
    Vec3 at(random.uniform(1, 5), random.uniform(1, 5), random.uniform(0.1, 0.6));
    // Some spheres are over a vertex, and some over the middle of an edge.
    const auto& t = mesh.mesh.triangles[static_cast<std::size_t>(n) % mesh.mesh.triangles.size()];
    const Vec3 &a = mesh.mesh.vertices[static_cast<std::size_t>(t[0])],
               &b = mesh.mesh.vertices[static_cast<std::size_t>(t[1])];
    if (n % 3 == 1) at.head<2>() = a.head<2>();
    if (n % 3 == 2) at.head<2>() = 0.5 * (a + b).head<2>();
    if ((at.head<2>().array() < 0.7).any() || (at.head<2>().array() > 5.3).any()) continue;
    if (n % 2) at.z() = -at.z();
    const auto found = mesh.contacts({Shape::sphere, {at, Quat::Identity(), {0.5, 0, 0}}}, nullptr, 0.2);
    ASSERT_GE(found.size(), 1u) << n;
    ASSERT_LE(found.size(), 1u) << n;
    for (const Manifold& m : found) {
      EXPECT_NEAR(m.normal.z(), at.z() > 0 ? -1 : 1, 1e-15) << n;
      EXPECT_NEAR(m.points[0].gap, std::abs(at.z()) - 0.5, 1e-14) << n;
    }
  }
}

TEST(MeshContacts, ASphereIsAsFarFromAMeshAsItsNearestPoint) {
  Random random(8, 0);
  for (const double roughness : {0.1, 0.5, 1.5}) {
    const Mesh mesh(uneven(roughness, 3));
    for (int n = 0; n < 60; ++n) {
      const Vec3 at(random.uniform(1, 5), random.uniform(1, 5), random.uniform(-1, 2));
      const double distance = mesh.distance_to(at);
      const auto found =
          mesh.contacts({Shape::sphere, {at, Quat::Identity(), {0.2, 0, 0}}}, nullptr, HUGE_VAL);
      double least = HUGE_VAL;
      for (const Manifold& m : found) least = std::min(least, m.points[0].gap);
      ASSERT_NEAR(least, distance - 0.2, 1e-7) << n;
    }
  }
}

TEST(MeshContacts, ABoxLyingOnAFlatMeshTouchesWithItsCornersAlone) {
  const Mesh mesh(uneven(0, 1));
  Random random(9, 0);
  for (int n = 0; n < 300; ++n) {
    const Quat turn(Eigen::AngleAxisd(random.uniform(0, 6), Vec3::UnitZ()));
    const Vec3 at(random.uniform(2.2, 3.8), random.uniform(2.2, 3.8), 0.2 - 1e-6);
    const auto found = mesh.contacts({Shape::box, {at, turn, {0.9, 0.7, 0.2}}}, nullptr, 0.01);
    int points = 0;
    for (const Manifold& m : found) {
      EXPECT_NEAR(m.normal.z(), -1, 1e-15) << n;
      for (int k = 0; k < m.count; ++k) {
        const Vec3 corner = turn.conjugate() * (m.points[k].position - at);
        EXPECT_NEAR(std::abs(corner.x()), 0.9, 1e-5);
        EXPECT_NEAR(std::abs(corner.y()), 0.7, 1e-5);
        EXPECT_NEAR(m.points[k].gap, -1e-6, 1e-14);
        ++points;
      }
    }
    ASSERT_EQ(points, 4) << n;
  }
}

// A box slides over the mesh in small steps: no point ever has another normal, however deep the box is.
TEST(MeshContacts, ABoxSlidingOverAFlatMeshMeetsNoEdge) {
  const Mesh mesh(uneven(0, 2));
  for (const double depth : {1e-9, 1e-6, 1e-4, 1e-3}) {
    for (int n = 0; n < 3000; ++n) {
      const Vec3 at(1.5 + 3.0 * n / 3000, 2.9 + 0.3 * n / 3000, 0.1 - depth);
      for (const Manifold& m :
           mesh.contacts({Shape::box, {at, Quat::Identity(), {0.3, 0.2, 0.1}}}, nullptr, 0.02))
        ASSERT_NEAR(m.normal.z(), -1, 1e-12) << depth << " " << n;
    }
  }
}

TEST(MeshContacts, ConvexBodiesOverAMeshAreNeverCloserThanTheirContactsSay) {
  Random random(11, 0);
  const Mesh mesh(uneven(0.4, 4));
  int touching = 0;
  for (int n = 0; n < 400; ++n) {
    const Shape shape =
        std::array{Shape::box, Shape::capsule, Shape::cylinder}[static_cast<std::size_t>(n % 3)];
    const ShapedSolid body{shape,
                           {{random.uniform(1.5, 4.5), random.uniform(1.5, 4.5), random.uniform(0.2, 1.0)},
                            random_orientation(random),
                            {0.25, 0.25, 0.4}}};
    double distance = HUGE_VAL;  // distance to all triangles, whatever the mesh finds
    const ConvexBody a(body, nullptr, Vec3::Zero());
    for (const PlacedTriangle& t : mesh.placed) {
      const ConvexBody b({Shape::triangle, {t.position, t.orientation, t.size}}, nullptr, Vec3::Zero());
      const ClosestPoints near = closest_points(a, b, Vec3::Zero(), 1e-12);
      distance = std::min(distance, near.apart ? near.distance - a.radius() : 0.0);
    }
    if (distance <= 0) continue;
    double least = HUGE_VAL;
    for (const Manifold& m : mesh.contacts(body, nullptr, 0.5)) least = std::min(least, least_gap(m));
    if (distance < 0.45) {
      ASSERT_LE(least, 1.35 * distance + 1e-4) << n;
      ++touching;
    }
    ASSERT_GE(least, distance - 1e-9) << n;
  }
  EXPECT_GT(touching, 100);
}

}  // namespace
}  // namespace scree
