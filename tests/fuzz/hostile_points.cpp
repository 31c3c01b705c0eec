#include "bench/hulls/judge.hpp"
#include "core/error.hpp"
#include "tests/fuzz/breach.hpp"
#include "tests/fuzz/hostile_input.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <vector>

namespace scree {
namespace {

/// The most points that are read, enough for hulls with too many vertices.
constexpr std::size_t most_points = 300;

std::vector<Vec3> doubles_in(std::string_view bytes) {
  std::array<double, 3> place;
  std::vector<Vec3> points;
  for (; bytes.size() >= sizeof(place) && points.size() < most_points; bytes.remove_prefix(sizeof(place))) {
    std::memcpy(place.data(), bytes.data(), sizeof(place));
    points.emplace_back(place[0], place[1], place[2]);
  }
  return points;
}

/// Returns points of which each coordinate is the sum of a whole number of 4 bits and of another one, also of
/// 4 bits, times a power of ten. The first byte gives that power, for all points.
std::vector<Vec3> lattice_in(std::string_view bytes) {
  std::vector<Vec3> points;
  if (bytes.empty()) return points;
  const double part = std::pow(10.0, -static_cast<double>(static_cast<unsigned char>(bytes.front()) % 20));
  bytes.remove_prefix(1);
  const auto number = [&](char byte) {
    const int bits = static_cast<unsigned char>(byte);
    return (bits >> 4) - 8 + part * ((bits & 15) - 8);
  };
  for (; bytes.size() >= 3 && points.size() < most_points; bytes.remove_prefix(3))
    points.emplace_back(number(bytes[0]), number(bytes[1]), number(bytes[2]));
  return points;
}

void require_reach(const Hull& hull, const std::vector<Vec3>& points) {
  const Vec3 half = hull.half_extent();
  for (const Vec3& p : points) {
    const Vec3 at = hull.axes.conjugate() * (p - hull.centre);
    const double rounding = 1e-14 * (p.norm() + hull.centre.norm());
    if (((at.cwiseAbs() - half).array() > 1e-3 * half.array() + rounding).any())
      breach("a hull without some of its points");
  }
}

}  // namespace

void read_hostile_points(std::string_view bytes) {
  if (bytes.empty()) return;
  const bool are_doubles = static_cast<unsigned char>(bytes.front()) % 2 == 0;
  bytes.remove_prefix(1);
  const std::vector<Vec3> points = are_doubles ? doubles_in(bytes) : lattice_in(bytes);
  Hull hull;
  try {
    hull = make_hull(points);
  } catch (const InputError&) {
    return;  // the message has no place, because the scene adds it
  }
  // Beyond these limits volumes (cubes of lengths) overflow, or squares underflow.
  double largest = 0, smallest = HUGE_VAL;
  for (const Vec3& v : hull.vertices) {
    largest = std::max(largest, v.norm());
    smallest = std::min(smallest, v.norm());
  }
  if (largest > 1e100 || smallest < 1e-80) return;
  const std::string fault = oracle::fault_of(hull);
  if (!fault.empty()) breach(fault);
  require_reach(hull, points);
}

}  // namespace scree
