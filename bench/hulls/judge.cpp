#include "bench/hulls/judge.hpp"

#include "bench/hulls/exact_hull.hpp"
#include "core/error.hpp"
#include "core/random_orientation.hpp"
#include "core/rng.hpp"
#include "core/tolerances.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace scree::oracle {
namespace {

using Real = long double;
using Vec = Eigen::Matrix<Real, 3, 1>;

/// The thickness, relative to the longest extent, from which on points must not be refused as flat.
constexpr Real surely_thick = 1e-6L;
/// The rounding of a place, relative to the largest coordinate of the points.
constexpr Real rounding = 0x1p-49L;

struct Range {
  Real low, high;
};

Range range_along(const std::vector<Vec>& points, const Vec& along) {
  Range range{points.front().dot(along), points.front().dot(along)};
  for (const Vec& p : points) {
    const Real x = p.dot(along);
    range = {std::min(range.low, x), std::max(range.high, x)};
  }
  return range;
}

/// Returns the least thickness of the points over the normals of the exact hull's triangles.
Real thickness(const std::vector<Vec>& points, const ExactHull& exact) {
  Real least = HUGE_VALL;
  for (const auto& t : exact.triangles) {
    const Vec& a = points[static_cast<std::size_t>(t[0])];
    const Vec n =
        (points[static_cast<std::size_t>(t[1])] - a).cross(points[static_cast<std::size_t>(t[2])] - a);
    if (n.isZero(0)) continue;  // zero only by rounding in 64 bits
    const Range range = range_along(points, n.normalized());
    least = std::min(least, range.high - range.low);
  }
  return exact.triangles.empty() ? 0 : least;
}

Real longest(const std::vector<Vec>& points) {
  Real most = 0;
  for (const Vec& axis : {Vec(1, 0, 0), Vec(0, 1, 0), Vec(0, 0, 1)}) {
    const Range range = range_along(points, axis);
    most = std::max(most, range.high - range.low);
  }
  return most;
}

/// Returns the distance that counts as none for points of such a longest extent and thickness.
Real width_of(Real longest, Real thickness) {
  return tolerance::coplanar * std::min<Real>(longest, tolerance::coplanar_thicknesses * thickness);
}

/// Returns what is wrong between faces, edges and vertices, or an empty string.
std::string fault_of_surface(const Hull& hull) {
  if (hull.vertices.size() + hull.faces.size() != hull.edges.size() + 2) return "Euler's formula is broken";
  if (hull.vertices.size() > Hull::most_vertices) return "too many vertices";
  std::map<std::pair<int, int>, int> face_at;
  std::vector<int> uses(hull.vertices.size());
  for (std::size_t f = 0; f < hull.faces.size(); ++f) {
    const auto corners = hull.corners_of(hull.faces[f]);
    if (corners.size() < 3) return "a face of fewer than three corners";
    for (std::size_t k = 0; k < corners.size(); ++k) {
      ++uses[static_cast<std::size_t>(corners[k])];
      const bool fresh =
          face_at.try_emplace({corners[k], corners[(k + 1) % corners.size()]}, static_cast<int>(f)).second;
      if (!fresh) return "an edge of two faces that go the same way";
    }
  }
  if (std::any_of(uses.begin(), uses.end(), [](int n) { return n < 3; }))
    return "a vertex of less than three faces";
  if (face_at.size() != 2 * hull.edges.size()) return "edges do not match faces";
  for (const Hull::Edge& edge : hull.edges) {
    const auto left = face_at.find({edge.from, edge.to}), right = face_at.find({edge.to, edge.from});
    if (left == face_at.end() || right == face_at.end() || left->second != edge.left ||
        right->second != edge.right || edge.left == edge.right)
      return "an edge without its two faces";
  }
  return "";
}

std::string fault_of_numbers(const Hull& hull) {
  bool finite = hull.centre.allFinite() && hull.axes.coeffs().allFinite() && hull.moments.allFinite();
  for (const Vec3& v : hull.vertices) finite = finite && v.allFinite();
  for (const Hull::Face& f : hull.faces)
    if (!(std::abs(f.normal.norm() - 1) < 1e-14)) return "a normal that is no unit vector";
  if (!finite) return "a number that is not finite";
  if (!(hull.volume > 0 && hull.moments.minCoeff() > 0)) return "no volume, or a moment of none";
  return 2 * hull.moments.maxCoeff() > hull.moments.sum() * (1 + 1e-14) ? "moments that no body has" : "";
}

/// Compares a found hull with its points, and notes the errors.
class Judge {
 public:
  Judge(const std::vector<Vec>& points, const Hull& hull, Real thickness, HullError& error)
      : points_(points),
        hull_(hull),
        longest_(longest(points)),
        width_(width_of(longest_, thickness)),
        error_(error),
        turn_(hull.axes.cast<Real>().normalized().toRotationMatrix()) {
    Real magnitude = 0;
    for (const Vec& p : points) magnitude = std::max(magnitude, p.cwiseAbs().maxCoeff());
    slack_ = rounding * magnitude;
    for (const Vec3& v : hull.vertices)
      vertices_.push_back(hull.centre.cast<Real>() + turn_ * v.cast<Real>());
  }

  void hold_faces() {
    for (const Hull::Face& face : hull_.faces) {
      const Vec n = turn_ * face.normal.cast<Real>();
      hold_support(n);
      const Range range = range_along(points_, n);
      const auto corners = hull_.corners_of(face);
      Real least = HUGE_VALL;
      for (const int c : corners) least = std::min(least, at(c).dot(n));
      // All corners of a face must be equally far out, and no point farther.
      note(range.high - least, width_, error_.plane);
      hold_polygon(corners, n);
    }
  }

  void hold_supports(Random& random) {
    for (int k = 0; k < 16; ++k) hold_support((random_orientation(random) * Vec3::UnitX()).cast<Real>());
  }

 private:
  const Vec& at(int corner) const { return vertices_[static_cast<std::size_t>(corner)]; }

  void note(Real found, Real width, double& most) const {
    most = std::max(most, static_cast<double>((found - slack_) / width));
  }

  /// Checks that the corners of a face are on the inner side of each of its edges.
  void hold_polygon(std::span<const int> corners, const Vec& n) {
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const Vec& a = at(corners[k]);
      const Vec outward = (at(corners[(k + 1) % corners.size()]) - a).cross(n).normalized();
      for (const int c : corners) note((at(c) - a).dot(outward), width_, error_.polygon);
    }
  }

  void hold_support(const Vec& along) {
    const Range exact = range_along(points_, along), found = range_along(vertices_, along);
    // A thin plate may have an edge like a knife's, whose place along the plate matters less than that of its
    // faces.
    const Real width = width_of(longest_, exact.high - exact.low);
    note(std::max(exact.high - found.high, found.low - exact.low), width, error_.support);
    if (found.high > exact.high + slack_ || found.low < exact.low - slack_)
      error_.fault = "a vertex outside of the points";
  }

  const std::vector<Vec>& points_;
  const Hull& hull_;
  Real longest_, width_, slack_ = 0;
  HullError& error_;
  Eigen::Matrix<Real, 3, 3> turn_;
  std::vector<Vec> vertices_;
};

/// Returns the thickness across the line from the point farthest from the first point to the point farthest
/// from that one.
Real thickness_of_line(const std::vector<Vec>& points) {
  const auto farthest = [&](const auto& measure) {
    return *std::max_element(points.begin(), points.end(),
                             [&](const Vec& a, const Vec& b) { return measure(a) < measure(b); });
  };
  const Vec a = farthest([&](const Vec& p) { return (p - points.front()).norm(); });
  const Vec b = farthest([&](const Vec& p) { return (p - a).norm(); });
  const auto aside = [&](const Vec& p) { return (b - a).cross(p - a).norm() / (b - a).norm(); };
  return aside(farthest(aside));
}

std::string fault_of_refusal(const std::string& words, const std::vector<Vec>& points,
                             const ExactHull& exact) {
  if (words.find("vertices") != std::string::npos)
    return exact.corners() > Hull::most_vertices ? "" : "refused: " + words;
  // If the points lie along a line, the normals are noise even in 64 bits, and so is a thickness measured
  // along them.
  const Real thick = std::min(thickness(points, exact), thickness_of_line(points));
  return !(thick >= surely_thick * longest(points)) ? "" : "refused: " + words;
}

void note_bounds(HullError& error) {
  if (!error.fault.empty()) return;
  for (const auto& [what, found] : {std::pair{"a support is short by", error.support},
                                    {"a plane is off by", error.plane},
                                    {"a face is concave by", error.polygon},
                                    {"the volume is off by", error.volume}})
    if (!(found <= most_error)) error.fault = fmt::format("{} {:.2g} tolerances", what, found);
}

}  // namespace

std::string fault_of(const Hull& hull) {
  const std::string fault = fault_of_surface(hull);
  return fault.empty() ? fault_of_numbers(hull) : fault;
}

HullError judge_hull(const HullPoints& set) {
  HullError error;
  std::vector<Vec> points;
  for (const Vec3& p : set.points) points.push_back(p.cast<Real>());
  std::optional<Hull> hull;
  std::string refusal;
  try {
    hull = make_hull(set.points);
  } catch (const InputError& problem) {
    refusal = problem.what();
  } catch (const std::exception& problem) {
    error.fault = fmt::format("threw {}", problem.what());
    return error;
  }
  const ExactHull exact = exact_hull(set.points, set.unit);
  if (!hull) {
    error.refused = true;
    error.fault = fault_of_refusal(refusal, points, exact);
    return error;
  }
  error.fault = fault_of(*hull);
  if (!error.fault.empty()) return error;
  const Real thick = thickness(points, exact);
  Judge judge(points, *hull, thick, error);
  judge.hold_faces();
  Random random(0x5e7, set.points.size());
  judge.hold_supports(random);
  error.volume = static_cast<double>(std::fabs(hull->volume - exact.volume) / exact.volume * thick /
                                     width_of(longest(points), thick));
  note_bounds(error);
  return error;
}

}  // namespace scree::oracle
