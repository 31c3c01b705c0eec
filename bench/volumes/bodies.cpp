#include "bench/volumes/bodies.hpp"

#include "core/random_orientation.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace scree::bench {

namespace {

struct Shares {
  const char* name;
  double aspect;
  int long_sides;  ///< number of long sides; 0: each side is random
};

const Shares& shares_of(BoxFamily family) {
  static constexpr Shares all[] = {{"cubes", 1, 3},      {"boxes 10", 10, 0},    {"boxes 100", 100, 0},
                                   {"plates 10", 10, 2}, {"plates 100", 100, 2}, {"rods 10", 10, 1},
                                   {"rods 100", 100, 1}};
  return all[static_cast<int>(family)];
}

double surface_of(const Vec3& half) {
  return 8 * (half.x() * half.y() + half.y() * half.z() + half.z() * half.x());
}

double mean_curvature_of(const Vec3& half) { return 2 * pi * half.sum(); }

/// Returns the cell of a place, as z, y, x. Cells are as wide as the longest box, so that boxes in
/// neighbouring places get near numbers.
std::array<std::int64_t, 3> cell_of(const Vec3& at) {
  constexpr double width = 2;
  const auto along = [](double x) { return static_cast<std::int64_t>(std::floor(x / width)); };
  return {along(at.z()), along(at.y()), along(at.x())};
}

}  // namespace

const char* name_of(BoxFamily family) { return shares_of(family).name; }

Vec3 random_half_extents(BoxFamily family, Random& random) {
  const Shares& shares = shares_of(family);
  Vec3 half = Vec3::Ones();
  for (int k = 0; k < 3; ++k) {
    const double exponent = shares.long_sides == 0 ? random.uniform() : k < shares.long_sides ? 0.0 : 1.0;
    half[k] = std::pow(shares.aspect, -exponent);
  }
  return half;
}

double excluded_volume(const Vec3& half_a, const Vec3& half_b) {
  return volume_of(Shape::box, half_a) + volume_of(Shape::box, half_b) +
         (surface_of(half_a) * mean_curvature_of(half_b) + surface_of(half_b) * mean_curvature_of(half_a)) /
             (4 * pi);
}

BoxScene make_boxes(BoxFamily family, std::int64_t count, double overlaps_per_body) {
  BoxScene scene;
  BodyTable& bodies = scene.bodies;
  double volume = 0, excluded = 0;
  for (std::int64_t k = 0; k < count; ++k) {
    Random random(301, static_cast<std::uint64_t>(k));
    bodies.shape.push_back(Shape::box);
    bodies.mobility.push_back(Mobility::free);
    bodies.size.push_back(random_half_extents(family, random));
    bodies.orientation.push_back(random_orientation(random));
    volume += volume_of(Shape::box, bodies.size.back());
    excluded += excluded_volume(bodies.size.back(), bodies.size[static_cast<std::size_t>(k / 2)]);
  }
  // The sum is the mean over random pairs, times the number of bodies. Divided by the volume of the cube it
  // is the number of overlaps per body.
  const double side = std::cbrt(excluded / overlaps_per_body);
  for (std::int64_t k = 0; k < count; ++k) {
    Random random(302, static_cast<std::uint64_t>(k));
    Vec3 at;
    for (double& x : at) x = random.uniform(-side / 2, side / 2);
    bodies.position.push_back(at);
  }
  std::ranges::sort(bodies.position, {}, cell_of);
  scene.fraction = volume / (side * side * side);
  return scene;
}

}  // namespace scree::bench
