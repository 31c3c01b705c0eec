#include "bench/hulls/exact_hull.hpp"

#include <boost/multiprecision/cpp_int.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <utility>

namespace scree::oracle {
namespace {

using Wide = boost::multiprecision::int256_t;
using Real = long double;
using Whole = std::array<std::int64_t, 3>;

constexpr Real most_units = 0x1p60L;

Whole minus(const Whole& a, const Whole& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

template <class Number>
Number determinant(const Whole& a, const Whole& b, const Whole& c) {
  const auto n = [](std::int64_t x) { return Number(x); };
  return n(a[0]) * (n(b[1]) * n(c[2]) - n(b[2]) * n(c[1])) +
         n(a[1]) * (n(b[2]) * n(c[0]) - n(b[0]) * n(c[2])) +
         n(a[2]) * (n(b[0]) * n(c[1]) - n(b[1]) * n(c[0]));
}

int sign_of_determinant(const Whole& a, const Whole& b, const Whole& c) {
  const auto size = [](const Whole& v) {
    return std::max({std::fabs(Real(v[0])), std::fabs(Real(v[1])), std::fabs(Real(v[2]))});
  };
  const Real found = determinant<Real>(a, b, c);
  // There are six products of three factors, with four roundings each, and five more roundings of the sums.
  const Real rounding = 6 * 9 * 0x1p-64L * size(a) * size(b) * size(c);
  if (std::fabs(found) > rounding) return found > 0 ? 1 : -1;
  return determinant<Wide>(a, b, c).sign();
}

class Builder {
 public:
  Builder(std::span<const Vec3> points, double unit) : unit_(unit) {
    at_.reserve(points.size());
    for (const Vec3& p : points) at_.push_back(in_units(p, points.front()));
  }

  ExactHull build() {
    if (!start()) return {};
    for (int p = 0; p < static_cast<int>(at_.size()); ++p) insert(p);
    Wide sum = 0;
    for (const auto& t : triangles_) sum += determinant<Wide>(at(t[0]), at(t[1]), at(t[2]));
    const Real cube = Real(unit_) * Real(unit_) * Real(unit_);
    return {std::move(triangles_), sum.convert_to<Real>() / 6 * cube};
  }

 private:
  const Whole& at(int p) const { return at_[static_cast<std::size_t>(p)]; }

  Whole in_units(const Vec3& p, const Vec3& first) const {
    Whole whole;
    for (int k = 0; k < 3; ++k) {
      const Real units = Real(p[k]) / Real(unit_) - Real(first[k]) / Real(unit_);
      if (!(std::fabs(units) < most_units) || units != std::rint(units))
        throw std::logic_error("exact_hull: the points are no whole multiples of the unit");
      whole[static_cast<std::size_t>(k)] = static_cast<std::int64_t>(units);
    }
    return whole;
  }

  /// Returns 1 if `d` is outside of the triangle, 0 if it is in the triangle's plane, -1 if it is inside.
  int side(int a, int b, int c, int d) const {
    return sign_of_determinant(minus(at(b), at(a)), minus(at(c), at(a)), minus(at(d), at(a)));
  }

  bool are_in_line(int a, int b, int c) const {
    const Whole u = minus(at(b), at(a)), v = minus(at(c), at(a));
    const auto cross = [&](std::size_t i, std::size_t j) {
      return Wide(u[i]) * Wide(v[j]) - Wide(u[j]) * Wide(v[i]);
    };
    return cross(0, 1) == 0 && cross(1, 2) == 0 && cross(2, 0) == 0;
  }

  /// Makes a tetrahedron of the first points that span one. Returns false if no points do.
  bool start() {
    const int count = static_cast<int>(at_.size());
    int b = 1, c = 1, d = 1;
    while (b < count && at(b) == at(0)) ++b;
    while (b < count && c < count && are_in_line(0, b, c)) ++c;
    while (b < count && c < count && d < count && side(0, b, c, d) == 0) ++d;
    if (b >= count || c >= count || d >= count) return false;
    if (side(0, b, c, d) > 0) std::swap(b, c);
    triangles_ = {{0, b, c}, {0, d, b}, {b, d, c}, {c, d, 0}};
    return true;
  }

  void insert(int p) {
    std::vector<std::array<int, 3>> kept;
    std::vector<std::pair<int, int>> rim;
    for (const auto& t : triangles_) {
      if (side(t[0], t[1], t[2], p) <= 0) {
        kept.push_back(t);
        continue;
      }
      for (std::size_t k = 0; k < 3; ++k) {
        const std::pair<int, int> edge{t[k], t[(k + 1) % 3]};
        const auto twin = std::find(rim.begin(), rim.end(), std::pair{edge.second, edge.first});
        if (twin == rim.end()) {
          rim.push_back(edge);
        } else {
          rim.erase(twin);
        }
      }
    }
    if (rim.empty()) return;
    for (const auto& [from, to] : rim) kept.push_back({from, to, p});
    triangles_ = std::move(kept);
  }

  double unit_;
  std::vector<Whole> at_;
  std::vector<std::array<int, 3>> triangles_;
};

}  // namespace

int ExactHull::corners() const {
  std::vector<int> seen;
  for (const auto& t : triangles) seen.insert(seen.end(), t.begin(), t.end());
  std::sort(seen.begin(), seen.end());
  return static_cast<int>(std::unique(seen.begin(), seen.end()) - seen.begin());
}

ExactHull exact_hull(std::span<const Vec3> points, double unit) { return Builder(points, unit).build(); }

}  // namespace scree::oracle
