#include "core/hull_surface.hpp"

#include "core/error.hpp"
#include "core/geometry.hpp"
#include "core/qhull.hpp"
#include "core/tolerances.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

namespace scree {
namespace {

using Polygon = std::vector<int>;

[[noreturn]] void fail_flat() {
  throw InputError("the points lie in a plane, or nearly: they have no volume");
}

Vec3 extent_of(std::span<const Vec3> points) {
  Vec3 low = points.front(), high = points.front();
  for (const Vec3& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return high - low;
}

/// Returns the points relative to the first one, and scaled to a longest extent of 1, so that neither their
/// place nor their size matters.
std::vector<Vec3> scaled(std::span<const Vec3> points) {
  if (points.size() < 4) throw InputError("needs at least four points");
  if (!std::all_of(points.begin(), points.end(), [](const Vec3& p) { return p.allFinite(); }))
    throw InputError("a coordinate is no finite number");
  const double longest = extent_of(points).maxCoeff();
  if (!std::isfinite(longest))
    throw InputError("the points are too far apart: their distance is no finite number");
  if (!(longest > 0)) fail_flat();
  std::vector<Vec3> at;
  at.reserve(points.size());
  for (const Vec3& p : points) at.push_back((p - points.front()) / longest);
  return at;
}

template <class Value>
Vec3 farthest(const std::vector<Vec3>& points, Value value) {
  return *std::max_element(points.begin(), points.end(),
                           [&](const Vec3& a, const Vec3& b) { return value(a) < value(b); });
}

/// A box around points that have been scaled: the line through two points that are far apart, the direction
/// from it to the farthest point, and the direction at right angles to both.
struct Box {
  Mat3 axes;     ///< the three directions, as rows
  Vec3 extents;  ///< along each of them; the last one is the thickness
};

/// Returns a box whose thickness is at least the least extent along any direction, and at most a few times
/// that.
Box box_around(const std::vector<Vec3>& points) {
  const Vec3 a = farthest(points, [](const Vec3& x) { return -x.x(); });
  const Vec3 b = farthest(points, [&](const Vec3& x) { return (x - a).squaredNorm(); });
  const Vec3 along = (b - a).normalized();
  const auto aside = [&](const Vec3& x) -> Vec3 { return x - a - along.dot(x - a) * along; };
  const Vec3 way = aside(farthest(points, [&](const Vec3& x) { return aside(x).squaredNorm(); }));
  if (!(way.norm() > tolerance::thin_hull)) fail_flat();
  Box box;
  box.axes << along.transpose(), way.normalized().transpose(), along.cross(way).normalized().transpose();
  std::vector<Vec3> turned;
  for (const Vec3& p : points) turned.push_back(box.axes * (p - a));
  box.extents = extent_of(turned);
  if (!(box.extents[2] > tolerance::thin_hull)) fail_flat();
  return box;
}

/// Finds the surface of points. Lengths are relative to the longest extent of the points.
class Surface {
 public:
  explicit Surface(std::span<const Vec3> given)
      : given_(given), points_(scaled(given)), box_(box_around(points_)) {
    width_ = tolerance::coplanar * std::min(1.0, tolerance::coplanar_thicknesses * box_.extents[2]);
  }

  /// Finds the faces. In rare cases Qhull fails on points that are nearly equal; such points then count as
  /// one.
  std::vector<Polygon> find() {
    for (double apart = width_; !find_of_points(apart); apart *= 4)
      if (used_.size() <= 4)
        throw InputError("no hull was found: too many of the points are nearly in one plane");
    for (Polygon& face : faces_)
      std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
    std::sort(faces_.begin(), faces_.end());
    return std::move(faces_);
  }

 private:
  const Vec3& at(int p) const { return points_[static_cast<std::size_t>(p)]; }

  /// Finds the faces of points that are farther than `apart` from each other. Returns false if there are none
  /// that pass the checks. Facets of a thin plate can be so narrow that Qhull's normals are noise. Its points
  /// are then stretched to a cube, which changes neither the corners of the hull nor the order of those of a
  /// face.
  bool find_of_points(double apart) {
    leave_out_nearer(apart);
    const Polygon all = used_;
    if (find_in_frame(Mat3::Identity())) return true;
    used_ = all;
    return find_in_frame(box_.extents.cwiseInverse().asDiagonal() * box_.axes);
  }

  /// Finds the faces of the points in use, which are multiplied by a matrix before Qhull sees them.
  bool find_in_frame(const Mat3& frame) {
    for (;;) {
      find_faces(frame);
      const Polygon dents = find_dents();
      if (dents.empty()) return is_closed() && (has_too_many_faces() || holds_points());
      std::erase_if(used_, [&](int p) { return std::binary_search(dents.begin(), dents.end(), p); });
    }
  }

  /// Among points that are nearer to each other than `apart`, uses only the first along a direction.
  void leave_out_nearer(double apart) {
    // Along this direction, few points of a lattice have the same place.
    const Vec3 along(1, 0.618033988749895, 0.414213562373095);
    std::vector<std::pair<double, int>> order;
    for (int p = 0; p < static_cast<int>(points_.size()); ++p) order.emplace_back(along.dot(at(p)), p);
    std::sort(order.begin(), order.end());
    std::vector<std::pair<double, int>> kept;
    for (const auto& [place, p] : order) {
      const auto near =
          std::lower_bound(kept.begin(), kept.end(), std::pair{place - along.norm() * apart, 0});
      const bool is_new = std::none_of(near, kept.end(), [&, &point = p](const auto& other) {
        return (at(point) - at(other.second)).norm() <= apart;
      });
      if (is_new) kept.emplace_back(place, p);
    }
    used_.clear();
    for (const auto& [place, p] : kept) used_.push_back(p);
    std::sort(used_.begin(), used_.end());
  }

  /// Finds the faces of the hull of the points in use, counterclockwise from outside; none if Qhull finds
  /// none.
  void find_faces(const Mat3& frame) {
    std::vector<Vec3> given;
    for (const int p : used_) given.push_back(frame * at(p));
    faces_ = faces_by_qhull(given, width_);
    Vec3 inside = Vec3::Zero();
    for (const int p : used_) inside += at(p) / double(used_.size());
    for (Polygon& face : faces_) {
      for (int& corner : face) corner = used_[static_cast<std::size_t>(corner)];
      if (normal_of(face).dot(at(face.front()) - inside) < 0) std::reverse(face.begin(), face.end());
    }
  }

  /// Returns the normal that the hull's face will have. For a sliver, that of the scaled points would be
  /// another.
  Vec3 normal_of(const Polygon& face) const { return polygon_normal(face, given_); }

  Vec3 side_of(const Polygon& face, std::size_t k) const {
    return at(face[(k + 1) % face.size()]) - at(face[k]);
  }

  /// Finds one corner of each face that is concave by more than the width. In such a face, facets have been
  /// merged that bend by as much as one of its sides is long. The corners are in the order of the points.
  Polygon find_dents() const {
    Polygon dents;
    for (const Polygon& face : faces_)
      if (is_concave(face)) dents.push_back(least_dent(face));
    std::sort(dents.begin(), dents.end());
    return dents;
  }

  bool is_concave(const Polygon& face) const {
    const Vec3 normal = normal_of(face);
    for (std::size_t k = 0; face.size() > 3 && k < face.size(); ++k) {
      const Vec3 outward = side_of(face, k).cross(normal).normalized();
      for (const int corner : face)
        if (outward.dot(at(corner) - at(face[k])) > width_) return true;
    }
    return false;
  }

  /// Among the corners at which the border turns inward, returns the one nearest to the line between its
  /// neighbours.
  int least_dent(const Polygon& face) const {
    const Vec3 normal = normal_of(face);
    double least = HUGE_VAL;
    int dent = face.front();
    for (std::size_t k = 0; k < face.size(); ++k) {
      const std::size_t next = (k + 1) % face.size();
      const Vec3 in = side_of(face, k), out = side_of(face, next);
      const double depth = -in.cross(out).dot(normal) / (in + out).norm();
      if (!(depth > 0 && depth < least)) continue;
      least = depth;
      dent = face[next];
    }
    return dent;
  }

  /// Whether there are faces, each edge has two faces and each corner three or more, and there is no hole
  /// (Euler's formula).
  bool is_closed() const {
    std::map<std::pair<int, int>, int> edges;
    std::map<int, int> corners;
    for (const Polygon& face : faces_)
      for (std::size_t k = 0; k < face.size(); ++k) {
        ++corners[face[k]];
        ++edges[{face[k], face[(k + 1) % face.size()]}];
      }
    return std::all_of(edges.begin(), edges.end(),
                       [&](const auto& edge) {
                         return edge.second == 1 && edges.contains({edge.first.second, edge.first.first});
                       }) &&
           std::all_of(corners.begin(), corners.end(),
                       [](const auto& corner) { return corner.second >= 3; }) &&
           2 * (corners.size() + faces_.size()) == edges.size() + 4;
  }

  /// Whether the hull has so many faces that it must have too many vertices: it is then refused, so that its
  /// accuracy does not matter.
  bool has_too_many_faces() const { return faces_.size() > 2 * Hull::most_vertices; }

  /// Whether no point is far outside of a face, and no corner far from its face's plane. Qhull can merge
  /// facets whose normals are noise, as the normals of facets between nearly equal points are.
  bool holds_points() const {
    const double most = tolerance::most_off_face * width_;
    return std::all_of(faces_.begin(), faces_.end(), [&](const Polygon& face) {
      const Vec3 normal = normal_of(face);
      double least = HUGE_VAL;
      for (const int corner : face) least = std::min(least, normal.dot(at(corner) - at(face.front())));
      return std::all_of(points_.begin(), points_.end(),
                         [&](const Vec3& p) { return normal.dot(p - at(face.front())) <= least + most; });
    });
  }

  std::span<const Vec3> given_;
  std::vector<Vec3> points_;  ///< scaled()
  Box box_;
  double width_;  ///< the distance that counts as none
  Polygon used_;  ///< the points in use, in ascending order
  std::vector<Polygon> faces_;
};

}  // namespace

std::vector<std::vector<int>> hull_surface(std::span<const Vec3> points) { return Surface(points).find(); }

Vec3 polygon_normal(std::span<const int> corners, std::span<const Vec3> points) {
  using Fine = Eigen::Matrix<long double, 3, 1>;
  const auto from_first = [&](std::size_t k) -> Fine {
    return points[static_cast<std::size_t>(corners[k])].cast<long double>() -
           points[static_cast<std::size_t>(corners[0])].cast<long double>();
  };
  Fine area = Fine::Zero();
  for (std::size_t k = 1; k + 1 < corners.size(); ++k) area += from_first(k).cross(from_first(k + 1));
  return area.stableNormalized().cast<double>();
}

}  // namespace scree
