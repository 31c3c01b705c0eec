// Makes a mesh whole: welds corners that nearly meet, and splits triangles at the corners on their edges.
#include "core/error.hpp"
#include "core/geometry.hpp"
#include "core/point_tree.hpp"
#include "core/tolerances.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

namespace scree {

namespace {

using Corners = std::array<int, 3>;

bool has_area(const Corners& t) { return t[0] != t[1] && t[1] != t[2] && t[2] != t[0]; }

bool goes_before(const Vec3& a, const Vec3& b) {
  return std::tuple(a.x(), a.y(), a.z()) < std::tuple(b.x(), b.y(), b.z());
}

class Welder {
 public:
  Welder(TriangleMesh& mesh, const Weld& how, MeshReport& report)
      : mesh_(mesh), given_(how.length), report_(report), used_(vertices_of(mesh.triangles)) {}

  void weld() {
    if (used_.empty()) return;
    Vec3 low = at(used_.front()), high = low;
    for (const int v : used_) {
      low = low.cwiseMin(at(v));
      high = high.cwiseMax(at(v));
    }
    size_ = (high - low).stableNorm();
    if (!std::isfinite(size_)) return;
    find_reaches();
    join_corners();
    room_ = most_for_each * (used_.size() + mesh_.triangles.size());
    // Triangles that were split may have corners on their new edges: corners that were on edges of the
    // triangle as well as in its interior.
    constexpr int most_rounds = 4;
    for (int round = 0; round < most_rounds && split_edges(); ++round) continue;
  }

 private:
  /// The largest number of corners near edges, and of parts of triangles, for each corner and triangle of the
  /// mesh. A surface has far fewer.
  static constexpr std::size_t most_for_each = 100;

  static std::vector<int> vertices_of(const std::vector<Corners>& triangles) {
    std::vector<int> used;
    used.reserve(3 * triangles.size());
    for (const Corners& t : triangles) used.insert(used.end(), t.begin(), t.end());
    std::ranges::sort(used);
    used.erase(std::unique(used.begin(), used.end()), used.end());
    return used;
  }

  Vec3& at(int v) { return mesh_.vertices[static_cast<std::size_t>(v)]; }
  double& reach(int v) { return reach_[static_cast<std::size_t>(v)]; }
  double length(int a, int b) { return (at(b) - at(a)).norm(); }

  double least() const { return tolerance::weld_least * size_; }
  double reach_beside(double edge) const {
    return given_.value_or(
        std::max(least(), std::min(tolerance::weld_size * size_, tolerance::weld_edge * edge)));
  }

  /// Finds for each corner the distance within which another one counts as the same.
  void find_reaches() {
    std::vector<double> shortest(mesh_.vertices.size(), HUGE_VAL);
    for (const Corners& t : mesh_.triangles) {
      for (std::size_t k = 0; k < 3; ++k) {
        const int a = t[k], b = t[(k + 1) % 3];
        const double edge = length(a, b);
        if (edge <= least()) continue;
        for (const int v : {a, b})
          shortest[static_cast<std::size_t>(v)] = std::min(shortest[static_cast<std::size_t>(v)], edge);
      }
    }
    reach_.resize(shortest.size());
    std::ranges::transform(shortest, reach_.begin(), [this](double edge) { return reach_beside(edge); });
  }

  /// Visits corners in the order of their places. Each one that is not joined yet takes in the corners within
  /// reach: therefore none moves farther than its reach, however many lie in a row.
  void join_corners() {
    std::vector<Vec3> places;
    places.reserve(used_.size());
    for (const int v : used_) places.push_back(at(v));
    const PointTree tree(places);
    std::vector<std::int32_t> order(used_.size()), near;
    std::iota(order.begin(), order.end(), 0);
    std::ranges::sort(order, [&](std::int32_t p, std::int32_t q) {
      return goes_before(places[static_cast<std::size_t>(p)], places[static_cast<std::size_t>(q)]);
    });
    constexpr int none = -1;
    std::vector<int> joined(mesh_.vertices.size(), none);
    for (const std::int32_t first : order) {
      const int v = used_[static_cast<std::size_t>(first)];
      if (joined[static_cast<std::size_t>(v)] != none) continue;
      tree.near_segment(at(v), at(v), reach(v), near);
      std::erase_if(near, [&](std::int32_t k) {
        const int other = used_[static_cast<std::size_t>(k)];
        return joined[static_cast<std::size_t>(other)] != none ||
               (places[static_cast<std::size_t>(k)] - at(v)).norm() > reach(other);
      });
      join(near, places, joined);
    }
    if (report_.welded == 0) return;
    for (Corners& t : mesh_.triangles)
      for (int& v : t) v = joined[static_cast<std::size_t>(v)];
    used_ = vertices_of(mesh_.triangles);
  }

  /// Joins the corners to one: to the one with the lowest number, at their mean.
  void join(std::vector<std::int32_t>& group, const std::vector<Vec3>& places, std::vector<int>& joined) {
    const auto place = [&](std::int32_t k) -> const Vec3& { return places[static_cast<std::size_t>(k)]; };
    const int kept = used_[static_cast<std::size_t>(std::ranges::min(group))];
    for (const std::int32_t k : group)
      joined[static_cast<std::size_t>(used_[static_cast<std::size_t>(k)])] = kept;
    if (group.size() == 1) return;
    std::ranges::sort(group, [&](std::int32_t p, std::int32_t q) { return goes_before(place(p), place(q)); });
    Vec3 sum = Vec3::Zero();
    for (const std::int32_t k : group) {
      sum += place(k) - place(group.front());
      reach(kept) = std::min(reach(kept), reach(used_[static_cast<std::size_t>(k)]));
    }
    at(kept) = place(group.front()) + sum / static_cast<double>(group.size());
    report_.welded += std::ssize(group) - 1;
    for (const std::int32_t k : group)
      report_.farthest = std::max(report_.farthest, (place(k) - at(kept)).norm());
  }

  /// Does one round of splitting. Returns true if there are corners on edges.
  bool split_edges() {
    report_.left_out += static_cast<std::int64_t>(
        std::erase_if(mesh_.triangles, [](const Corners& t) { return !has_area(t); }));
    find_corners_on_edges();
    if (on_edge_.empty()) return false;
    std::vector<Corners> whole;
    whole.reserve(mesh_.triangles.size());
    for (const Corners& t : mesh_.triangles) {
      const std::size_t before = whole.size();
      cut(t, {true, true, true}, whole);
      if (whole.size() == before) ++report_.left_out;
      if (whole.size() > before && whole.back() != t) ++report_.split;
    }
    mesh_.triangles = std::move(whole);
    return true;
  }

  void find_corners_on_edges() {
    on_edge_.clear();
    std::vector<Vec3> places;
    for (const int v : used_) places.push_back(at(v));
    const PointTree tree(places);
    const std::vector<MeshEdge> edges = edges_of(mesh_.triangles);
    std::vector<std::int32_t> near;
    for (const auto& [a, b, count] : edges) {
      const double edge = length(a, b);
      tree.near_segment(at(a), at(b), reach_beside(edge), near);
      if (near.size() > room_) fail();
      room_ -= near.size();
      if (near.size() == 2) continue;
      std::vector<std::pair<double, int>> between;
      for (const std::int32_t k : near) {
        const int v = used_[static_cast<std::size_t>(k)];
        const auto [square, share] = distance_from_segment(at(v), at(a), at(b));
        // Only corners are used that make the parts shorter than the whole edge, so that splitting ends.
        if (v != a && v != b && square <= reach(v) * reach(v) && share > 0 && share < 1 &&
            length(a, v) < edge && length(v, b) < edge)
          between.emplace_back(share, v);
      }
      if (between.empty()) continue;
      std::ranges::sort(between, [&](const auto& p, const auto& q) {
        return p.first != q.first ? p.first < q.first : goes_before(at(p.second), at(q.second));
      });
      std::vector<int>& chain = on_edge_[{a, b}];
      for (const auto& [share, v] : between) chain.push_back(v);
    }
  }

  /// Appends the triangle, or its parts between the corners on its edges. Only edges with `is_whole` are cut.
  /// Triangles on both sides of an edge use the same corners, so that they still share the parts of the edge.
  void cut(const Corners& t, const std::array<bool, 3>& is_whole, std::vector<Corners>& out) {
    if (!has_area(t)) return;
    if (room_-- == 0) fail();
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3], apex = t[(k + 2) % 3];
      const auto found = on_edge_.find({std::min(a, b), std::max(a, b)});
      if (!is_whole[k] || found == on_edge_.end()) continue;
      std::vector<int> way = found->second;
      if (a > b) std::ranges::reverse(way);
      way.push_back(b);
      int from = a;
      for (const int to : way) {
        cut({from, to, apex}, {false, to == b && is_whole[(k + 1) % 3], from == a && is_whole[(k + 2) % 3]},
            out);
        from = to;
      }
      return;
    }
    out.push_back(t);
  }

  [[noreturn]] static void fail() {
    throw InputError(
        "has corners on edges at far more places than a surface has; give `weld: off`, or a shorter one");
  }

  TriangleMesh& mesh_;
  std::optional<double> given_;
  MeshReport& report_;
  std::vector<int> used_;  ///< vertices of triangles, ascending
  double size_ = 0;        ///< diagonal of the mesh's box (m)
  std::size_t room_ = 0;   ///< corners near edges and parts of triangles that are still allowed in all rounds
  std::vector<double> reach_;
  std::map<std::pair<int, int>, std::vector<int>> on_edge_;  ///< corners on each edge, from its lower vertex
};

}  // namespace

void weld(TriangleMesh& mesh, const Weld& how, MeshReport& report) {
  if (how.on) Welder(mesh, how, report).weld();
}

}  // namespace scree
