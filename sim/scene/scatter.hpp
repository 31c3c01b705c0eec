// Random places without overlap.
#pragma once

#include "core/bodies.hpp"

#include <cstdint>
#include <vector>

namespace scree {

/// Distance from the point to the surface of body b (m); negative inside a sphere or plane, 0 inside a box.
double distance_to(const BodyTable& bodies, std::size_t b, const Vec3& point);

/// A box for centres, and how they are drawn in it.
struct Scattering {
  Vec3 from = Vec3::Zero();  ///< corners (m)
  Vec3 to = Vec3::Zero();
  std::uint64_t seed = 0;
  Period period = {};       ///< in which bodies keep clear of one another's images too
  std::uint64_t round = 0;  ///< in each of which a body draws other places
  int tries = 2000;         ///< for a body, until it counts as one that does not fit
};

/// Gives the bodies listed in `those` random positions with centres in a box, such that the sphere around
/// each keeps clear of all others of them and of the bodies listed in `obstacles`. The largest are placed
/// first, and `those` is put into that order. Returns how many of them fitted: the first of the others found
/// no place in a bounded number of tries. By default so many that at random sequential packing's limit the
/// free share of the volume falls under 1/1000.
std::int64_t scatter(BodyTable& bodies, std::vector<std::int32_t>& those, const Scattering& how,
                     const std::vector<std::int32_t>& obstacles);

}  // namespace scree
