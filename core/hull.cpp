// Convex hulls by insertion of one point after another (Seidel 1990; de Berg et al. 2008, chapter 11), with
// triangles that lie in one plane made one face; mass by tetrahedra.
#include "core/error.hpp"
#include "core/geometry.hpp"
#include "core/tolerances.hpp"

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

namespace scree {

namespace {

struct Facet {
  std::array<int, 3> corner;
  Vec3 normal;
  double offset;
};

class Builder {
 public:
  explicit Builder(std::span<const Vec3> points) : points_(points) {}

  Hull build() {
    start();
    for (int p = 0; p < static_cast<int>(points_.size()); ++p) insert(p);
    group();
    return hull();
  }

 private:
  const Vec3& at(int p) const { return points_[static_cast<std::size_t>(p)]; }

  [[noreturn]] static void fail_flat() {
    throw InputError("the points lie in a plane, or nearly: they have no volume");
  }

  template <class Value>
  int farthest(Value value) const {
    int best = 0;
    for (int p = 1; p < static_cast<int>(points_.size()); ++p)
      if (value(at(p)) > value(at(best))) best = p;
    return best;
  }

  /// A tetrahedron of points that are far apart.
  void start() {
    if (points_.size() < 4) throw InputError("needs four points at least");
    const int a = farthest([](const Vec3& x) { return -x.x(); });
    const int b = farthest([&](const Vec3& x) { return (x - at(a)).squaredNorm(); });
    const Vec3 along = (at(b) - at(a)).stableNormalized();
    const int c = farthest([&](const Vec3& x) { return (x - at(a)).cross(along).squaredNorm(); });
    const Vec3 across = (at(c) - at(a)).cross(along);
    const double length = (at(b) - at(a)).norm();
    eps_ = tolerance::flat * length;
    if (!(across.norm() > eps_)) fail_flat();
    const Vec3 normal = across.normalized();
    const int d = farthest([&](const Vec3& x) { return std::abs(normal.dot(x - at(a))); });
    if (!(std::abs(normal.dot(at(d) - at(a))) > eps_)) fail_flat();
    inside_ = 0.25 * (at(a) + at(b) + at(c) + at(d));
    for (const auto& [i, j, k] : {std::array{a, b, c}, {a, b, d}, {a, c, d}, {b, c, d}}) add(i, j, k);
  }

  void add(int i, int j, int k) {
    Vec3 normal = (at(j) - at(i)).cross(at(k) - at(i)).stableNormalized();
    if (normal.dot(at(i) - inside_) < 0) {
      normal = -normal;
      std::swap(j, k);
    }
    facets_.push_back({{i, j, k}, normal, normal.dot(at(i))});
  }

  void insert(int p) {
    std::map<std::pair<int, int>, int> horizon;
    std::vector<Facet> kept;
    for (const Facet& facet : facets_) {
      if (facet.normal.dot(at(p)) - facet.offset <= eps_) {
        kept.push_back(facet);
        continue;
      }
      for (int k = 0; k < 3; ++k) {
        const int from = facet.corner[static_cast<std::size_t>(k)];
        const int to = facet.corner[static_cast<std::size_t>((k + 1) % 3)];
        if (horizon.erase({to, from}) == 0) horizon[{from, to}] = 0;
      }
    }
    if (kept.size() == facets_.size()) return;
    facets_ = std::move(kept);
    for (const auto& [edge, unused] : horizon) add(edge.first, edge.second, p);
  }

  /// The facets that lie in one plane, connected or not: the hull is convex.
  void group() {
    face_of_.assign(facets_.size(), -1);
    // The largest come first: the normals of slivers are noise.
    std::vector<std::size_t> order(facets_.size());
    for (std::size_t f = 0; f < order.size(); ++f) order[f] = f;
    const auto area = [&](std::size_t f) {
      const auto& c = facets_[f].corner;
      return (at(c[1]) - at(c[0])).cross(at(c[2]) - at(c[0])).squaredNorm();
    };
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return area(a) > area(b); });
    for (const std::size_t seed : order) {
      if (face_of_[seed] >= 0) continue;
      const Facet& plane = facets_[seed];
      for (const std::size_t f : order) {
        const bool in_plane = std::ranges::all_of(facets_[f].corner, [&](int p) {
          return std::abs(plane.normal.dot(at(p)) - plane.offset) <= 4 * eps_;
        });
        if (face_of_[f] < 0 && in_plane && facets_[f].normal.dot(plane.normal) > 0) face_of_[f] = faces_;
      }
      normals_.push_back(plane.normal);
      ++faces_;
    }
  }

  /// The next corner of its face after each, at the rim of the face.
  std::vector<std::map<int, int>> rims() const {
    std::map<std::pair<int, int>, int> owner;
    for (std::size_t f = 0; f < facets_.size(); ++f)
      for (std::size_t k = 0; k < 3; ++k)
        owner[{facets_[f].corner[k], facets_[f].corner[(k + 1) % 3]}] = face_of_[f];
    std::vector<std::map<int, int>> next(static_cast<std::size_t>(faces_));
    for (const auto& [edge, face] : owner)
      if (owner.at({edge.second, edge.first}) != face)
        next[static_cast<std::size_t>(face)][edge.first] = edge.second;
    return next;
  }

  Hull hull() const {
    const auto next = rims();
    std::map<int, int> uses;  // faces at each point
    for (const auto& rim : next)
      for (const auto& [from, to] : rim) ++uses[from];
    Hull hull;
    std::map<int, int> number;
    for (const auto& [point, faces] : uses) {
      if (faces < 3) continue;  // within an edge
      number[point] = static_cast<int>(hull.vertices.size());
      hull.vertices.push_back(at(point));
    }
    if (hull.vertices.size() > Hull::most_vertices)
      throw InputError(fmt::format("the hull has {} vertices; at most {} are possible", hull.vertices.size(),
                                   Hull::most_vertices));
    for (std::size_t face = 0; face < next.size(); ++face)
      append_face(next[face], number, normals_[face], hull);
    append_edges(hull);
    return hull;
  }

  static void append_face(const std::map<int, int>& rim, const std::map<int, int>& number, const Vec3& normal,
                          Hull& hull) {
    const int first = static_cast<int>(hull.corners.size());
    const int begin = rim.begin()->first;
    int point = begin;
    do {
      if (const auto found = number.find(point); found != number.end()) hull.corners.push_back(found->second);
      point = rim.at(point);
    } while (point != begin);
    hull.faces.push_back({normal, first, static_cast<int>(hull.corners.size()) - first});
  }

  static void append_edges(Hull& hull) {
    std::map<std::pair<int, int>, int> face_at;
    for (std::size_t f = 0; f < hull.faces.size(); ++f) {
      const auto corners = hull.corners_of(hull.faces[f]);
      for (std::size_t k = 0; k < corners.size(); ++k)
        face_at[{corners[k], corners[(k + 1) % corners.size()]}] = static_cast<int>(f);
    }
    for (const auto& [edge, face] : face_at) {
      if (edge.first > edge.second) continue;
      hull.edges.push_back({edge.first, edge.second, face, face_at.at({edge.second, edge.first})});
    }
  }

  std::span<const Vec3> points_;
  double eps_ = 0;
  Vec3 inside_;
  std::vector<Facet> facets_;
  std::vector<int> face_of_;
  std::vector<Vec3> normals_;
  int faces_ = 0;
};

/// Volume, centre and second moments, of tetrahedra over the faces.
struct Mass {
  double volume = 0;
  Vec3 first = Vec3::Zero();   ///< integral of x
  Mat3 second = Mat3::Zero();  ///< integral of x x^T

  void add(const Vec3& a, const Vec3& b, const Vec3& c) {
    const double det = a.dot(b.cross(c));
    const Vec3 sum = a + b + c;
    volume += det / 6;
    first += det / 24 * sum;
    second += det / 120 * (sum * sum.transpose() + a * a.transpose() + b * b.transpose() + c * c.transpose());
  }
};

Mass mass_of(const Hull& hull) {
  Mass mass;
  for (const Hull::Face& face : hull.faces) {
    const auto c = hull.corners_of(face);
    const auto at = [&](std::size_t k) -> const Vec3& {
      return hull.vertices[static_cast<std::size_t>(c[k])];
    };
    for (std::size_t k = 1; k + 1 < c.size(); ++k) mass.add(at(0), at(k), at(k + 1));
  }
  return mass;
}

/// Principal moments, and the axes that they are about. Axes that are principal but for rounding stay as they
/// are, and moments that are equal but for rounding are equal.
void diagonalize(const Mat3& inertia, Hull& hull) {
  const double largest = inertia.cwiseAbs().maxCoeff();
  const double rounding = tolerance::equal_moments * largest;
  Mat3 axes = Mat3::Identity();
  Vec3 moments = inertia.diagonal();
  if (std::max({std::abs(inertia(0, 1)), std::abs(inertia(0, 2)), std::abs(inertia(1, 2))}) > rounding) {
    const Eigen::SelfAdjointEigenSolver<Mat3> solver(inertia);
    moments = solver.eigenvalues();
    axes = solver.eigenvectors();
    if (axes.determinant() < 0) axes.col(2) = -axes.col(2);
  }
  for (int k = 0; k < 3; ++k)
    for (int m = 0; m < k; ++m)
      if (std::abs(moments[k] - moments[m]) <= rounding) moments[k] = moments[m];
  hull.moments = moments;
  hull.axes = Quat(axes).normalized();
}

/// The largest distance of a vertex from its faces' planes is noise: the normals stay as the facets had them.
void move_to_principal_frame(Hull& hull) {
  // About a vertex, so that what is far from the origin keeps its digits.
  const Vec3 origin = hull.vertices.front();
  for (Vec3& v : hull.vertices) v -= origin;
  const Mass mass = mass_of(hull);
  const Vec3 centre = mass.first / mass.volume;
  const Mat3 second = mass.second / mass.volume - centre * centre.transpose();
  diagonalize(second.trace() * Mat3::Identity() - second, hull);
  hull.volume = mass.volume;
  hull.centre = origin + centre;
  const Mat3 turn = hull.axes.toRotationMatrix().transpose();
  for (Vec3& v : hull.vertices) v = turn * (v - centre);
  for (Hull::Face& face : hull.faces) face.normal = turn * face.normal;
}

}  // namespace

Vec3 Hull::half_extent() const {
  Vec3 half = Vec3::Zero();
  for (const Vec3& v : vertices) half = half.cwiseMax(v.cwiseAbs());
  return half;
}

Hull make_hull(std::span<const Vec3> points) {
  Hull hull = Builder(points).build();
  move_to_principal_frame(hull);
  return hull;
}

}  // namespace scree
