// Tests of hulls and their masses, against closed forms and Monte Carlo sums, and of meshes and the
// surroundings of their triangles.
#include "core/geometry.hpp"

#include "core/error.hpp"
#include "core/random_orientation.hpp"
#include "core/rng.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace scree {
namespace {

std::vector<Vec3> box_points(const Vec3& half, const Quat& turn, const Vec3& at) {
  std::vector<Vec3> points;
  for (int c = 0; c < 8; ++c)
    points.push_back(at + turn * half.cwiseProduct(Vec3(c & 1 ? 1 : -1, c & 2 ? 1 : -1, c & 4 ? 1 : -1)));
  return points;
}

void expect_closed(const Hull& hull) {
  // The hull obeys Euler's formula, and every vertex is behind every face.
  EXPECT_EQ(hull.vertices.size() + hull.faces.size(), hull.edges.size() + 2);
  for (const Hull::Face& face : hull.faces) {
    const double offset = face.normal.dot(hull.vertices[static_cast<std::size_t>(hull.corners_of(face)[0])]);
    for (const Vec3& v : hull.vertices) EXPECT_LE(face.normal.dot(v), offset + 1e-9);
  }
}

TEST(Hull, ABoxAnywhereHasSixFacesAndItsMoments) {
  Random random(1, 0);
  for (int n = 0; n < 100; ++n) {
    const Vec3 half(random.uniform(0.1, 1), random.uniform(0.1, 1), random.uniform(0.1, 1));
    const Vec3 at(random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-9, 9));
    const Quat turn = n == 0 ? Quat::Identity() : random_orientation(random);
    std::vector<Vec3> points = box_points(half, turn, at);
    points.push_back(at);                                // inside the box
    points.push_back(at + turn * Vec3(half.x(), 0, 0));  // within a face
    points.push_back(0.5 * (points[0] + points[1]));     // within an edge
    const Hull hull = make_hull(points);
    ASSERT_EQ(hull.vertices.size(), 8u) << n;
    ASSERT_EQ(hull.faces.size(), 6u) << n;
    ASSERT_EQ(hull.edges.size(), 12u) << n;
    expect_closed(hull);
    EXPECT_NEAR(hull.volume, 8 * half.prod(), 1e-12 * hull.volume);
    EXPECT_NEAR((hull.centre - at).norm(), 0, 1e-13 * 20);
    std::array<double, 3> expected = {(half.y() * half.y() + half.z() * half.z()) / 3,
                                      (half.z() * half.z() + half.x() * half.x()) / 3,
                                      (half.x() * half.x() + half.y() * half.y()) / 3};
    std::array<double, 3> found = {hull.moments.x(), hull.moments.y(), hull.moments.z()};
    std::sort(expected.begin(), expected.end());
    std::sort(found.begin(), found.end());
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(found[k], expected[k], 1e-12);
    // The vertices of the hull are where the points were given.
    for (const Vec3& v : hull.vertices) {
      double nearest = HUGE_VAL;
      for (const Vec3& p : points) nearest = std::min(nearest, (hull.centre + hull.axes * v - p).norm());
      EXPECT_LT(nearest, 1e-12);
    }
  }
}

TEST(Hull, ACubesFrameIsThatOfItsPoints) {
  const Hull cube = make_hull(box_points(Vec3::Constant(0.5), Quat::Identity(), Vec3(3, 0, 0)));
  EXPECT_EQ(cube.axes.coeffs(), Quat::Identity().coeffs());
  EXPECT_EQ(cube.moments.x(), cube.moments.y());
  EXPECT_EQ(cube.moments.y(), cube.moments.z());
}

TEST(Hull, ATetrahedronsMassIsTheClosedForm) {
  // A tetrahedron with legs a, b, c along the axes (Tonon 2004) has its centre at a quarter of each leg and
  // the volume a b c / 6.
  const double a = 0.3, b = 0.5, c = 0.7;
  const std::vector<Vec3> points = {{0, 0, 0}, {a, 0, 0}, {0, b, 0}, {0, 0, c}};
  const Hull hull = make_hull(points);
  EXPECT_NEAR(hull.volume, a * b * c / 6, 1e-16);
  EXPECT_NEAR((hull.centre - Vec3(a, b, c) / 4).norm(), 0, 1e-15);
  const double trace = 3.0 / 40 * (a * a + b * b + c * c);  // half of the trace of the inertia
  EXPECT_NEAR(hull.moments.sum(), trace, 1e-15);
  EXPECT_EQ(hull.faces.size(), 4u);
}

TEST(Hull, MassOfRandomPointsIsThatOfSamples) {
  Random random(3, 0);
  std::vector<Vec3> points;
  for (int k = 0; k < 40; ++k)
    points.emplace_back(random.uniform(-1, 1), random.uniform(-0.6, 0.6), random.uniform(0, 0.5));
  const Hull hull = make_hull(points);
  expect_closed(hull);
  const Vec3 half = hull.half_extent();
  std::int64_t inside = 0;
  Vec3 sum = Vec3::Zero(), squares = Vec3::Zero();
  Vec3 products = Vec3::Zero();
  constexpr int samples = 400000;
  for (int k = 0; k < samples; ++k) {
    const Vec3 x(random.uniform(-half.x(), half.x()), random.uniform(-half.y(), half.y()),
                 random.uniform(-half.z(), half.z()));
    const bool in = std::all_of(hull.faces.begin(), hull.faces.end(), [&](const Hull::Face& f) {
      return f.normal.dot(x - hull.vertices[static_cast<std::size_t>(hull.corners_of(f)[0])]) <= 0;
    });
    if (!in) continue;
    ++inside;
    sum += x;
    squares += x.cwiseProduct(x);
    products += Vec3(x.y() * x.z(), x.z() * x.x(), x.x() * x.y());
  }
  const auto n = static_cast<double>(inside);
  EXPECT_NEAR(8 * half.prod() * n / samples, hull.volume, 0.01 * hull.volume);
  EXPECT_LT((sum / n).norm(), 5e-3);       // the centre of mass is the origin
  EXPECT_LT((products / n).norm(), 2e-3);  // the axes are principal
  const Vec3 s = squares / n;
  EXPECT_LT((Vec3(s.y() + s.z(), s.z() + s.x(), s.x() + s.y()) - hull.moments).norm(),
            0.01 * hull.moments.norm());
}

TEST(Hull, PointsWithoutVolumeAreRefused) {
  const std::vector<Vec3> three = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const std::vector<Vec3> flat = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0.3, 0.3, 1e-13}};
  const std::vector<Vec3> same(5, Vec3(1, 2, 3));
  const std::vector<Vec3> line = {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}};
  for (const auto& points : {three, flat, same, line}) EXPECT_THROW(make_hull(points), InputError);
  std::vector<Vec3> ball;
  Random random(4, 0);
  for (int k = 0; k < 300; ++k) ball.push_back(random_orientation(random) * Vec3::UnitX());
  EXPECT_THROW(make_hull(ball), InputError);
}

TEST(Mesh, CornersAreWhereTheVerticesAre) {
  Random random(5, 0);
  for (int n = 0; n < 200; ++n) {
    TriangleMesh mesh;
    for (int k = 0; k < 3; ++k)
      mesh.vertices.emplace_back(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    mesh.triangles = {{0, 1, 2}};
    PlacedTriangle t;
    ASSERT_TRUE(place_triangle(mesh, 0, t));
    for (int k = 0; k < 3; ++k) {
      const Vec3 at = t.position + t.orientation * triangle_corner(t.size, k);
      EXPECT_LT((at - mesh.vertices[static_cast<std::size_t>(t.corners[static_cast<std::size_t>(k)])]).norm(),
                1e-14);
    }
    const Vec3 front =
        (mesh.vertices[1] - mesh.vertices[0]).cross(mesh.vertices[2] - mesh.vertices[0]).normalized();
    EXPECT_NEAR((t.orientation * Vec3::UnitZ()).dot(front), 1, 1e-12);
    EXPECT_LE(std::abs(t.size.y()), t.size.x());
  }
  TriangleMesh line;
  line.vertices = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  line.triangles = {{0, 1, 2}};
  PlacedTriangle unused;
  EXPECT_FALSE(place_triangle(line, 0, unused));
}

TEST(Mesh, EachEdgeAndVertexHasOneOwner) {
  TriangleMesh cube;
  cube.vertices = box_points(Vec3::Ones(), Quat::Identity(), Vec3::Zero());
  cube.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  std::vector<PlacedTriangle> placed(12);
  for (std::size_t t = 0; t < 12; ++t) ASSERT_TRUE(place_triangle(cube, t, placed[t]));
  int edges = 0, vertices = 0;
  for (const Surroundings& s : surroundings_of(cube, placed)) {
    for (const auto& edge : s.edges) {
      edges += edge.owned;
      EXPECT_EQ(edge.count, 2);
    }
    for (const auto& vertex : s.vertices) vertices += vertex.owned;
  }
  EXPECT_EQ(edges, 18);
  EXPECT_EQ(vertices, 8);
}

}  // namespace
}  // namespace scree
