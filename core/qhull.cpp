#include "core/qhull.hpp"

#include <fmt/format.h>

extern "C" {
#include <libqhull_r/qhull_ra.h>
}

#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <utility>

namespace scree {
namespace {

using Edges = std::vector<std::pair<int, int>>;

/// A stream in memory that takes the messages of Qhull, which would otherwise appear on the user's screen.
class Unread {
 public:
  Unread() : file_(open_memstream(&text_, &size_)) {}
  ~Unread() {
    if (file_) std::fclose(file_);
    std::free(text_);
  }
  Unread(const Unread&) = delete;
  Unread& operator=(const Unread&) = delete;
  FILE* file() const { return file_; }

 private:
  char* text_ = nullptr;
  std::size_t size_ = 0;
  FILE* file_;
};

/// A run of Qhull and its memory. An error of Qhull jumps back into qh_new_qhull(), which returns it. Outside
/// of that call an error would end the program, so the functions here only read Qhull's lists and call
/// nothing that may fail.
class Qhull {
 public:
  Qhull(const std::vector<Vec3>& points, double width) {
    if (!unread_.file()) return;
    // C- merges facets; Pp suppresses the warning about narrow hulls, which are allowed. Without QR or QJ
    // nothing is random.
    std::string command = fmt::format("qhull C-{} Pp", width);
    coordinates_.reserve(3 * points.size());
    for (const Vec3& p : points) coordinates_.insert(coordinates_.end(), {p.x(), p.y(), p.z()});
    qh_zero(&state_, unread_.file());
    ready_ = true;
    found_ = qh_new_qhull(&state_, 3, static_cast<int>(points.size()), coordinates_.data(), False,
                          command.data(), nullptr, unread_.file()) == qh_ERRnone;
  }
  ~Qhull() {
    if (!ready_) return;
    int blocks = 0, bytes = 0;
    qh_freeqhull(&state_, !qh_ALL);
    qh_memfreeshort(&state_, &blocks, &bytes);
  }
  Qhull(const Qhull&) = delete;
  Qhull& operator=(const Qhull&) = delete;

  bool found() const { return found_; }

  /// Returns the edges of each face, in no particular order.
  std::vector<Edges> edges() const {
    std::vector<Edges> all;
    for (const facetT* facet = state_.facet_list; facet && facet->next; facet = facet->next)
      all.push_back(facet->simplicial ? sides_of(*facet) : ridges_of(*facet));
    return all;
  }

 private:
  int point_of(const setT* vertices, int k) const {
    const auto* vertex = static_cast<const vertexT*>(vertices->e[k].p);
    return static_cast<int>((vertex->point - state_.first_point) / 3);
  }

  Edges sides_of(const facetT& triangle) const {
    Edges edges;
    for (int k = 0; k < 3; ++k)
      edges.emplace_back(point_of(triangle.vertices, k), point_of(triangle.vertices, (k + 1) % 3));
    return edges;
  }

  Edges ridges_of(const facetT& facet) const {
    Edges edges;
    for (int k = 0; facet.ridges->e[k].p; ++k) {
      const auto* ridge = static_cast<const ridgeT*>(facet.ridges->e[k].p);
      edges.emplace_back(point_of(ridge->vertices, 0), point_of(ridge->vertices, 1));
    }
    return edges;
  }

  Unread unread_;
  std::vector<double> coordinates_;
  qhT state_;
  bool ready_ = false, found_ = false;
};

/// Returns the corners of the polygon that the edges form, beginning with the lowest number; empty if they
/// form none.
std::vector<int> polygon_of(const Edges& edges) {
  std::map<int, std::vector<int>> beside;
  for (const auto& [a, b] : edges) {
    beside[a].push_back(b);
    beside[b].push_back(a);
  }
  std::vector<int> corners;
  int last = -1, corner = beside.begin()->first;
  do {
    const std::vector<int>& both = beside.at(corner);
    if (both.size() != 2) return {};
    corners.push_back(corner);
    const int next = both[0] == last ? both[1] : both[0];
    last = std::exchange(corner, next);
  } while (corner != corners.front());
  return corners.size() == edges.size() && corners.size() >= 3 ? corners : std::vector<int>{};
}

}  // namespace

std::vector<std::vector<int>> faces_by_qhull(const std::vector<Vec3>& points, double width) {
  const Qhull qhull(points, width);
  if (!qhull.found()) return {};
  std::vector<std::vector<int>> faces;
  for (const Edges& edges : qhull.edges()) {
    faces.push_back(polygon_of(edges));
    if (faces.back().empty()) return {};
  }
  return faces;
}

}  // namespace scree
