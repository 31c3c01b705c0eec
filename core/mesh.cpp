// The triangles of a mesh as bodies, and what each must know of those around it.
#include "core/geometry.hpp"
#include "core/tolerances.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace scree {

namespace {

using Edge = std::pair<int, int>;

Edge edge_of(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

/// The triangles at each edge and at each vertex, by number.
struct Incidence {
  std::map<Edge, std::vector<std::size_t>> at_edge;
  std::vector<std::vector<std::size_t>> at_vertex;

  Incidence(const TriangleMesh& mesh, const std::vector<PlacedTriangle>& placed)
      : at_vertex(mesh.vertices.size()) {
    for (std::size_t t = 0; t < placed.size(); ++t) {
      for (std::size_t k = 0; k < 3; ++k) {
        at_edge[edge_of(placed[t].corners[k], placed[t].corners[(k + 1) % 3])].push_back(t);
        at_vertex[static_cast<std::size_t>(placed[t].corners[k])].push_back(t);
      }
    }
  }
};

/// At right angles to the edge a b, in the triangle, towards its third corner.
Vec3 inward(const TriangleMesh& mesh, const PlacedTriangle& triangle, const Edge& edge) {
  const auto third =
      std::ranges::find_if(triangle.corners, [&](int c) { return c != edge.first && c != edge.second; });
  const auto at = [&](int v) -> const Vec3& { return mesh.vertices[static_cast<std::size_t>(v)]; };
  const Vec3 along = (at(edge.second) - at(edge.first)).normalized();
  const Vec3 to = at(*third) - at(edge.first);
  return (to - along.dot(to) * along).normalized();
}

}  // namespace

bool place_triangle(const TriangleMesh& mesh, std::size_t triangle, PlacedTriangle& out) {
  out.corners = mesh.triangles[triangle];
  const auto at = [&](std::size_t k) -> const Vec3& {
    return mesh.vertices[static_cast<std::size_t>(out.corners[k])];
  };
  const auto length = [&](std::size_t k) { return (at((k + 1) % 3) - at(k)).squaredNorm(); };
  std::size_t longest = 0;
  for (std::size_t k = 1; k < 3; ++k)
    if (length(k) > length(longest)) longest = k;
  std::rotate(out.corners.begin(), out.corners.begin() + static_cast<std::ptrdiff_t>(longest),
              out.corners.end());
  const double base = std::sqrt(length(0));
  if (!(base > 0) || !std::isfinite(base)) return false;
  const Vec3 x = (at(1) - at(0)) / base;
  const Vec3 to_apex = at(2) - at(0);
  const double along = x.dot(to_apex);
  const Vec3 up = to_apex - along * x;
  const double height = up.norm();
  if (!(height > tolerance::flat * base)) return false;
  Mat3 axes;
  axes.col(0) = x;
  axes.col(1) = up / height;
  axes.col(2) = axes.col(0).cross(axes.col(1));
  out.orientation = Quat(axes).normalized();
  out.position = at(0) + 0.5 * base * x + 0.5 * up;
  out.size = {0.5 * base, along - 0.5 * base, 0.5 * height};
  return true;
}

std::vector<Surroundings> surroundings_of(const TriangleMesh& mesh,
                                          const std::vector<PlacedTriangle>& placed) {
  const Incidence incidence(mesh, placed);
  std::vector<Surroundings> all(placed.size());
  const auto at = [&](int v) -> const Vec3& { return mesh.vertices[static_cast<std::size_t>(v)]; };
  for (std::size_t t = 0; t < placed.size(); ++t) {
    const PlacedTriangle& triangle = placed[t];
    const Quat to_frame = triangle.orientation.conjugate();
    Surroundings& s = all[t];
    const auto begin = [&](std::size_t owner) {
      return Surroundings::Feature{static_cast<int>(s.directions.size()), 0, owner == t};
    };
    const auto end = [&](Surroundings::Feature& f) {
      f.count = static_cast<int>(s.directions.size()) - f.first;
    };
    for (std::size_t k = 0; k < 3; ++k) {
      const Edge edge = edge_of(triangle.corners[k], triangle.corners[(k + 1) % 3]);
      const auto& sharing = incidence.at_edge.at(edge);
      s.edges[k] = begin(sharing.front());
      for (const std::size_t other : sharing)
        s.directions.push_back(to_frame * inward(mesh, placed[other], edge));
      end(s.edges[k]);
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const int corner = triangle.corners[k];
      const auto& around = incidence.at_vertex[static_cast<std::size_t>(corner)];
      s.vertices[k] = begin(around.front());
      std::vector<int> ends;
      for (const std::size_t other : around)
        for (const int v : placed[other].corners)
          if (v != corner && std::ranges::find(ends, v) == ends.end()) ends.push_back(v);
      for (const int v : ends) s.directions.push_back(to_frame * (at(v) - at(corner)).normalized());
      end(s.vertices[k]);
    }
  }
  return all;
}

}  // namespace scree
