// Makes a hull from its surface: polygons, edges and mass. The mass is summed over tetrahedra.
#include "core/error.hpp"
#include "core/geometry.hpp"
#include "core/hull_surface.hpp"
#include "core/tolerances.hpp"

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace scree {

namespace {

// Long double, because normals and mass of thin hulls are differences of products that are nearly equal.
using Real = long double;
using Fine = Eigen::Matrix<Real, 3, 1>;

void append_edges(Hull& hull) {
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

/// Returns the hull in the frame of the points, with its vertices in the order of the points.
Hull polyhedron_of(std::span<const Vec3> points) {
  const auto surface = hull_surface(points);
  std::map<int, int> number;
  for (const auto& face : surface)
    for (const int point : face) number[point] = 0;
  if (number.size() > Hull::most_vertices)
    throw InputError(
        fmt::format("the hull has {} vertices; at most {} are possible", number.size(), Hull::most_vertices));
  Hull hull;
  for (auto& [point, vertex] : number) {
    vertex = static_cast<int>(hull.vertices.size());
    hull.vertices.push_back(points[static_cast<std::size_t>(point)]);
  }
  for (const auto& face : surface) {
    const int first = static_cast<int>(hull.corners.size());
    for (const int point : face) hull.corners.push_back(number.at(point));
    hull.faces.push_back({Vec3::Zero(), first, static_cast<int>(face.size())});
    hull.faces.back().normal = polygon_normal(hull.corners_of(hull.faces.back()), hull.vertices);
  }
  append_edges(hull);
  return hull;
}

/// Volume, first and second moments, as sums over tetrahedra from the origin to the faces.
struct Mass {
  Real volume = 0;
  Fine first = Fine::Zero();                         ///< integral of x
  Eigen::Matrix<Real, 3, 3> second = second.Zero();  ///< integral of x x^T

  void add(const Fine& a, const Fine& b, const Fine& c) {
    const Real det = a.dot(b.cross(c));
    const Fine sum = a + b + c;
    volume += det / 6;
    first += det / 24 * sum;
    second += det / 120 * (sum * sum.transpose() + a * a.transpose() + b * b.transpose() + c * c.transpose());
  }
};

/// Returns the moments relative to a point, so that hulls far from the origin keep their digits.
Mass mass_of(const Hull& hull, const Vec3& origin) {
  Mass mass;
  for (const Hull::Face& face : hull.faces) {
    const auto c = hull.corners_of(face);
    const auto at = [&](std::size_t k) -> Fine {
      return hull.vertices[static_cast<std::size_t>(c[k])].cast<Real>() - origin.cast<Real>();
    };
    for (std::size_t k = 1; k + 1 < c.size(); ++k) mass.add(at(0), at(k), at(k + 1));
  }
  return mass;
}

/// Sets the principal moments of a hull, and the axes that they are about. Axes that are principal but for
/// rounding stay as they are, and moments that are equal but for rounding are made equal.
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

void move_to_principal_frame(Hull& hull) {
  const Vec3 origin = hull.vertices.front();
  const Mass mass = mass_of(hull, origin);
  const Fine centre = mass.first / mass.volume;
  const Mat3 second = (mass.second / mass.volume - centre * centre.transpose()).cast<double>();
  diagonalize(second.trace() * Mat3::Identity() - second, hull);
  hull.volume = static_cast<double>(mass.volume);
  const Fine place = origin.cast<Real>() + centre;
  hull.centre = place.cast<double>();
  const Mat3 turn = hull.axes.toRotationMatrix().transpose();
  for (Vec3& v : hull.vertices) v = turn * (v.cast<Real>() - place).cast<double>();
  for (Hull::Face& face : hull.faces) face.normal = turn * face.normal;
}

}  // namespace

Vec3 Hull::half_extent() const {
  Vec3 half = Vec3::Zero();
  for (const Vec3& v : vertices) half = half.cwiseMax(v.cwiseAbs());
  return half;
}

Hull make_hull(std::span<const Vec3> points) {
  Hull hull = polyhedron_of(points);
  move_to_principal_frame(hull);
  return hull;
}

}  // namespace scree
