// Tests of welding: meshes that were torn apart become whole again, and parts that are meant to be separate
// stay separate.
#include "core/error.hpp"
#include "core/geometry.hpp"
#include "core/random_orientation.hpp"
#include "core/rng.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>
#include <vector>

namespace scree {
namespace {

using Corners = std::array<int, 3>;

const Vec3& at(const TriangleMesh& mesh, int v) { return mesh.vertices[static_cast<std::size_t>(v)]; }

/// Returns a wavy sheet of n x n squares, 1 m wide.
TriangleMesh sheet(int n, double height) {
  TriangleMesh mesh;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j) {
      const double x = double(i) / n, y = double(j) / n;
      mesh.vertices.emplace_back(x, y, height * std::sin(7 * x) * std::cos(5 * y));
    }
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const int a = i * (n + 1) + j, b = a + n + 1;
      mesh.triangles.push_back({a, b, b + 1});
      mesh.triangles.push_back({a, b + 1, a + 1});
    }
  return mesh;
}

TriangleMesh cube() {
  TriangleMesh mesh;
  for (int c = 0; c < 8; ++c) mesh.vertices.emplace_back(c & 1, (c >> 1) & 1, c >> 2);
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

/// Returns the mesh with its triangles in another order, each with corners of its own that are off by up to
/// `noise` along each axis.
TriangleMesh torn(const TriangleMesh& mesh, double noise, Random& random) {
  TriangleMesh apart;
  std::vector<Corners> triangles = mesh.triangles;
  for (std::size_t k = triangles.size(); k > 1; --k)
    std::swap(triangles[k - 1],
              triangles[std::min<std::size_t>(k - 1, std::size_t(random.uniform(0, double(k))))]);
  for (const Corners& t : triangles) {
    const int first = int(apart.vertices.size());
    for (const int v : t)
      apart.vertices.push_back(at(mesh, v) + Vec3(random.uniform(-noise, noise),
                                                  random.uniform(-noise, noise),
                                                  random.uniform(-noise, noise)));
    apart.triangles.push_back({first, first + 1, first + 2});
  }
  return apart;
}

void place(TriangleMesh& mesh, double size, const Quat& turn, const Vec3& by) {
  for (Vec3& v : mesh.vertices) v = size * (turn * v + by);
}

/// Returns the triangles, named by the vertices of `known` that are nearest to their corners; each begins at
/// its lowest vertex.
std::multiset<Corners> triangles_as_of(const TriangleMesh& mesh, const TriangleMesh& known) {
  std::multiset<Corners> all;
  for (const Corners& t : mesh.triangles) {
    Corners named{};
    std::ranges::transform(t, named.begin(), [&](int v) {
      const auto nearest = std::ranges::min_element(
          known.vertices, {}, [&](const Vec3& k) { return (k - at(mesh, v)).squaredNorm(); });
      return int(nearest - known.vertices.begin());
    });
    std::ranges::rotate(named, std::ranges::min_element(named));
    all.insert(named);
  }
  return all;
}

int count_used(const TriangleMesh& mesh) {
  std::set<int> used;
  for (const Corners& t : mesh.triangles) used.insert(t.begin(), t.end());
  return int(used.size());
}

int edges_with(const TriangleMesh& mesh, auto&& holds) {
  return int(
      std::ranges::count_if(edges_of(mesh.triangles), [&](const MeshEdge& e) { return holds(e.count); }));
}
int open_edges(const TriangleMesh& mesh) {
  return edges_with(mesh, [](int n) { return n == 1; });
}
int crowded_edges(const TriangleMesh& mesh) {
  return edges_with(mesh, [](int n) { return n > 2; });
}

double area(const TriangleMesh& mesh) {
  double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    sum += 0.5 * (at(mesh, b) - at(mesh, a)).cross(at(mesh, c) - at(mesh, a)).norm();
  return sum;
}

MeshReport welded(TriangleMesh& mesh, const Weld& how = {}) {
  MeshReport report;
  weld(mesh, how, report);
  return report;
}

TEST(Weld, AMeshThatIsWholeStaysAsItIs) {
  Random random(1, 0);
  for (const TriangleMesh& whole : {sheet(12, 0.1), sheet(5, 0), cube()}) {
    for (const double size : {1e-3, 1.0, 1e3}) {
      TriangleMesh mesh = whole;
      place(mesh, size, random_orientation(random), Vec3(3, -2, 1));
      const TriangleMesh before = mesh;
      const MeshReport report = welded(mesh);
      EXPECT_EQ(mesh.triangles, before.triangles);
      for (std::size_t k = 0; k < mesh.vertices.size(); ++k) EXPECT_EQ(mesh.vertices[k], before.vertices[k]);
      EXPECT_EQ(report.welded + report.split + report.left_out, 0);
      EXPECT_EQ(report.farthest, 0);
    }
  }
}

TEST(Weld, TornMeshesAreWholeAgain) {
  Random random(2, 0);
  for (const TriangleMesh& whole : {sheet(5, 0), sheet(14, 0.2), cube()}) {
    for (const double noise : {0.0, 1e-14, 1e-10, 1e-8, 1e-7, 1e-6, 1e-5}) {
      for (const double size : {1e-3, 1.0, 1e3}) {
        const Quat turn = random_orientation(random);
        TriangleMesh known = whole, mesh = torn(whole, noise, random);
        place(known, size, turn, Vec3(1, 2, 3));
        place(mesh, size, turn, Vec3(1, 2, 3));
        const MeshReport report = welded(mesh);
        SCOPED_TRACE(testing::Message() << "noise " << noise << ", size " << size);
        EXPECT_EQ(triangles_as_of(mesh, known), triangles_as_of(known, known));
        EXPECT_EQ(count_used(mesh), int(known.vertices.size()));
        EXPECT_EQ(open_edges(mesh), open_edges(known));
        EXPECT_EQ(report.split, 0);
        // Two copies of a vertex are at most 2 sqrt(3) noise apart, and rounding adds to this.
        EXPECT_LE(report.farthest, size * (2 * std::sqrt(3.0) * noise + 1e-13));
      }
    }
  }
}

/// Returns a square of two triangles, and above it a row of `parts` squares that meet its edge.
TriangleMesh junction(int parts) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  const int first = int(mesh.vertices.size());
  for (int k = 0; k <= parts; ++k) {
    mesh.vertices.emplace_back(double(k) / parts, 1, 0);
    mesh.vertices.emplace_back(double(k) / parts, 1.5, 0);
  }
  for (int k = 0; k < parts; ++k) {
    const int a = first + 2 * k;
    mesh.triangles.push_back({a, a + 2, a + 3});
    mesh.triangles.push_back({a, a + 3, a + 1});
  }
  return mesh;
}

TEST(Weld, TrianglesAreSplitAtCornersOnTheirEdges) {
  Random random(3, 0);
  for (int parts = 2; parts <= 6; ++parts) {
    for (const double noise : {0.0, 1e-14, 1e-10, 1e-7, 1e-5}) {
      for (const double size : {1e-3, 1.0, 1e3}) {
        TriangleMesh mesh = torn(junction(parts), noise, random);
        place(mesh, size, random_orientation(random), Vec3(1, 2, 3));
        const MeshReport report = welded(mesh);
        SCOPED_TRACE(testing::Message() << parts << " parts, noise " << noise << ", size " << size);
        EXPECT_EQ(report.split, 1);
        EXPECT_EQ(mesh.triangles.size(), std::size_t(2 * parts + 2 + parts - 1));
        EXPECT_EQ(open_edges(mesh), 3 + parts + 2);
        EXPECT_EQ(crowded_edges(mesh), 0);
        EXPECT_NEAR(area(mesh), 1.5 * size * size, (20 * noise + 1e-12) * size * size);
      }
    }
  }
}

TEST(Weld, CornersOnAllEdgesOfATriangleSplitIt) {
  // The triangle is surrounded by smaller ones, `each` + 1 along each edge.
  for (int each = 1; each <= 5; ++each) {
    TriangleMesh mesh;
    mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0.3, 0.8, 0}};
    mesh.triangles = {{0, 1, 2}};
    for (int k = 0; k < 3; ++k) {
      const Vec3 a = mesh.vertices[std::size_t(k)], b = mesh.vertices[std::size_t((k + 1) % 3)];
      const Vec3 out = Vec3((b - a).y(), -(b - a).x(), 0) * 0.3;
      for (int n = 0; n <= each; ++n) {
        const int first = int(mesh.vertices.size());
        mesh.vertices.push_back(a + (b - a) * n / (each + 1));
        mesh.vertices.push_back(a + (b - a) * (n + 1) / (each + 1));
        mesh.vertices.push_back(a + (b - a) * (n + 0.5) / (each + 1) + out);
        mesh.triangles.push_back({first + 1, first, first + 2});
      }
    }
    const double before = area(mesh);
    const MeshReport report = welded(mesh);
    EXPECT_EQ(report.split, 1);
    EXPECT_NEAR(area(mesh), before, 1e-12);
    EXPECT_EQ(open_edges(mesh), 6 * (each + 1));
    EXPECT_EQ(edges_with(mesh, [](int n) { return n == 2; }), 3 * (each + 1) + 3 * each);
    EXPECT_EQ(mesh.triangles.size(), std::size_t(3 * (each + 1) + 1 + 3 * each));
  }
}

TEST(Weld, TrianglesWithoutAreaThatFillAJunctionGo) {
  Random random(4, 0);
  for (const double noise : {0.0, 1e-14, 1e-10, 1e-7, 1e-5}) {
    TriangleMesh mesh = junction(2);
    // This triangle lies on the edge of the square: its corners are the two ends and the corner between them.
    mesh.triangles.push_back({3, 2, 6});
    TriangleMesh apart = torn(mesh, noise, random);
    const MeshReport report = welded(apart);
    EXPECT_EQ(report.left_out, 1) << noise;
    EXPECT_EQ(apart.triangles.size(), 7u) << noise;
    EXPECT_EQ(open_edges(apart), 7) << noise;
    for (const auto& [a, b, c] : apart.triangles)
      EXPECT_GT((at(apart, b) - at(apart, a)).cross(at(apart, c) - at(apart, a)).z(), 0.1) << noise;
  }
}

TEST(Weld, WhatIsMeantToBeApartStaysSo) {
  // The parts are two sheets with a gap of `width` between them, and a slab of small thickness.
  for (const double width : {1e-2, 1e-3, 2e-4}) {
    TriangleMesh two = sheet(4, 0);
    const int half = int(two.vertices.size());
    const TriangleMesh other = sheet(4, 0);
    for (const Vec3& v : other.vertices) two.vertices.push_back(v + Vec3(1 + width, 0, 0));
    for (const auto& [a, b, c] : other.triangles) two.triangles.push_back({a + half, b + half, c + half});
    EXPECT_EQ(welded(two).welded, 0) << width;
  }
  for (const double thickness : {1e-2, 1e-4, 1e-6}) {
    TriangleMesh slab = cube();
    for (Vec3& v : slab.vertices) v.z() *= thickness;
    const TriangleMesh before = slab;
    const MeshReport report = welded(slab);
    EXPECT_EQ(report.welded + report.split + report.left_out, 0) << thickness;
    EXPECT_EQ(slab.triangles, before.triangles);
  }
}

TEST(Weld, TheSceneMaySayHow) {
  Random random(5, 0);
  const TriangleMesh apart = torn(sheet(4, 0), 1e-4, random);
  TriangleMesh mesh = apart;
  EXPECT_EQ(welded(mesh, {.on = false, .length = {}}).welded, 0);
  EXPECT_EQ(mesh.triangles, apart.triangles);
  mesh = apart;
  const MeshReport report = welded(mesh, {.on = true, .length = 1e-3});
  EXPECT_EQ(count_used(mesh), 25);
  EXPECT_EQ(report.welded, 96 - 25);
  EXPECT_EQ(open_edges(mesh), 16);
  mesh = apart;
  EXPECT_EQ(welded(mesh, {.on = true, .length = 1e-6}).welded, 0);
  // Nothing is left of a mesh that is smaller than the length, and nothing breaks.
  mesh = apart;
  EXPECT_EQ(welded(mesh, {.on = true, .length = 10}).left_out, 32);
}

TEST(Weld, NothingDependsOnTheOrder) {
  Random random(6, 0);
  const auto places = [](const TriangleMesh& mesh) {
    std::multiset<std::vector<std::tuple<double, double, double>>> all;
    for (const Corners& t : mesh.triangles) {
      std::vector<std::tuple<double, double, double>> corners;
      for (const int v : t) corners.emplace_back(at(mesh, v).x(), at(mesh, v).y(), at(mesh, v).z());
      std::ranges::sort(corners);
      all.insert(corners);
    }
    return all;
  };
  for (int n = 0; n < 20; ++n) {
    TriangleMesh first = torn(junction(1 + n % 6), n % 2 == 0 ? 1e-5 : 0, random);
    TriangleMesh second = torn(first, 0, random);
    const MeshReport a = welded(first), b = welded(second);
    EXPECT_EQ(places(first), places(second));
    EXPECT_EQ(a.farthest, b.farthest);
    EXPECT_EQ(a.split, b.split);
  }
}

TEST(Weld, AnyTrianglesAtAllGiveWholeOnes) {
  Random random(7, 0);
  for (int n = 0; n < 300; ++n) {
    TriangleMesh mesh;
    const double grid = n % 3 == 0 ? 2 : n % 3 == 1 ? 5 : 1000;
    for (int k = 0; k < 30; ++k)
      mesh.vertices.emplace_back(std::floor(random.uniform(0, grid)), std::floor(random.uniform(0, grid)),
                                 n % 2 == 0 ? 0 : std::floor(random.uniform(0, grid)));
    for (int k = 0; k < 40; ++k)
      mesh.triangles.push_back(
          {int(random.uniform(0, 30)), int(random.uniform(0, 30)), int(random.uniform(0, 30))});
    try {
      const MeshReport report =
          welded(mesh, {.on = true, .length = n % 5 == 0 ? std::optional(1.2) : std::nullopt});
      EXPECT_TRUE(std::isfinite(report.farthest));
    } catch (const InputError&) {
      continue;  // triangles that overlap without end are refused
    }
    for (const auto& [a, b, c] : mesh.triangles) EXPECT_TRUE(a != b && b != c && c != a);
  }
}

}  // namespace
}  // namespace scree
