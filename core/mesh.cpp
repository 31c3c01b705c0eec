// Places the triangles of a mesh as bodies, and finds the neighbours of each.
#include "core/geometry.hpp"
#include "core/tolerances.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace scree {

namespace {

using Edge = std::pair<int, int>;

Edge edge_of(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

/// The triangles at each edge and at each vertex, by ascending number.
class Incidence {
 public:
  Incidence(const TriangleMesh& mesh, const std::vector<PlacedTriangle>& placed)
      : first_at_vertex_(mesh.vertices.size() + 1), at_vertex_(3 * placed.size()) {
    at_edge_.reserve(3 * placed.size());
    for (std::size_t t = 0; t < placed.size(); ++t) {
      for (std::size_t k = 0; k < 3; ++k) {
        at_edge_.emplace_back(edge_of(placed[t].corners[k], placed[t].corners[(k + 1) % 3]), t);
        ++first_at_vertex_[static_cast<std::size_t>(placed[t].corners[k]) + 1];
      }
    }
    std::ranges::sort(at_edge_);
    std::partial_sum(first_at_vertex_.begin(), first_at_vertex_.end(), first_at_vertex_.begin());
    std::vector<std::size_t> next = first_at_vertex_;
    for (std::size_t t = 0; t < placed.size(); ++t)
      for (const int v : placed[t].corners) at_vertex_[next[static_cast<std::size_t>(v)]++] = t;
  }

  /// Returns all pairs of this edge and a triangle beside it.
  std::span<const std::pair<Edge, std::size_t>> at_edge(const Edge& edge) const {
    const auto first = std::ranges::lower_bound(at_edge_, edge, {}, &std::pair<Edge, std::size_t>::first);
    const auto end =
        std::find_if(first, at_edge_.end(), [&](const auto& other) { return other.first != edge; });
    return {first, end};
  }
  std::span<const std::size_t> at_vertex(int v) const {
    const std::size_t first = first_at_vertex_[static_cast<std::size_t>(v)];
    return {at_vertex_.data() + first, first_at_vertex_[static_cast<std::size_t>(v) + 1] - first};
  }

 private:
  std::vector<std::pair<Edge, std::size_t>> at_edge_;
  std::vector<std::size_t> first_at_vertex_, at_vertex_;
};

/// The vertices at the other ends of a vertex's edges, each once, in the order of the triangles.
class Neighbours {
 public:
  Neighbours(const Incidence& incidence, const std::vector<PlacedTriangle>& placed, std::size_t vertices)
      : incidence_(incidence), placed_(placed), seen_by_(vertices, none) {}

  const std::vector<int>& of(int vertex) {
    ends_.clear();
    seen_by_[static_cast<std::size_t>(vertex)] = ++asked_;
    for (const std::size_t t : incidence_.at_vertex(vertex))
      for (const int v : placed_[t].corners)
        if (std::exchange(seen_by_[static_cast<std::size_t>(v)], asked_) != asked_) ends_.push_back(v);
    return ends_;
  }

 private:
  static constexpr std::int64_t none = 0;
  const Incidence& incidence_;
  const std::vector<PlacedTriangle>& placed_;
  std::vector<std::int64_t> seen_by_;  ///< number of the last call of of() that has met the vertex
  std::int64_t asked_ = none;
  std::vector<int> ends_;
};

/// Returns the unit vector in the triangle's plane at right angles to the edge, towards the third corner.
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

std::vector<MeshEdge> edges_of(std::span<const std::array<int, 3>> triangles) {
  std::vector<Edge> all;
  all.reserve(3 * triangles.size());
  for (const std::array<int, 3>& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) all.push_back(edge_of(t[k], t[(k + 1) % 3]));
  std::ranges::sort(all);
  std::vector<MeshEdge> edges;
  for (const auto& [from, to] : all) {
    if (edges.empty() || edges.back().from != from || edges.back().to != to) edges.push_back({from, to, 0});
    ++edges.back().count;
  }
  return edges;
}

std::vector<Surroundings> surroundings_of(const TriangleMesh& mesh,
                                          const std::vector<PlacedTriangle>& placed) {
  const Incidence incidence(mesh, placed);
  Neighbours neighbours(incidence, placed, mesh.vertices.size());
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
      const auto sharing = incidence.at_edge(edge);
      s.edges[k] = begin(sharing.front().second);
      for (const auto& [shared, other] : sharing)
        s.directions.push_back(to_frame * inward(mesh, placed[other], edge));
      end(s.edges[k]);
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const int corner = triangle.corners[k];
      s.vertices[k] = begin(incidence.at_vertex(corner).front());
      for (const int v : neighbours.of(corner))
        s.directions.push_back(to_frame * (at(v) - at(corner)).normalized());
      end(s.vertices[k]);
    }
  }
  return all;
}

}  // namespace scree
