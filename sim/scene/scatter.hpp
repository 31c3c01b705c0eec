// Random positions of bodies without overlap.
#pragma once

#include "core/bodies.hpp"

#include <cstdint>
#include <vector>

namespace scree {

/// Returns the distance from the point to the surface of body b (m). It is negative inside a sphere or plane,
/// and 0 inside a box.
double distance_to(const BodyTable& bodies, std::size_t b, const Vec3& point);

/// A box for the centres of bodies, and the way in which they are drawn in it.
struct Scattering {
  Vec3 from = Vec3::Zero();  ///< corners of the box (m)
  Vec3 to = Vec3::Zero();
  std::uint64_t seed = 0;
  Period period = {};       ///< period of the space: bodies keep clear of one another's images too
  std::uint64_t round = 0;  ///< number of the attempt; at each, a body draws other positions
  int tries = 2000;         ///< largest number of tries for a body before it counts as one that does not fit
};

/// Gives the bodies listed in `those` random positions with their centres in a box, such that the bounding
/// sphere of each keeps clear of the others and of the bodies listed in `obstacles`. The largest bodies are
/// placed first, and `those` is sorted into that order. Returns how many of them were placed; the first body
/// after these found no position within how.tries tries. The default number of tries is so large that near
/// the limit of random sequential packing the free share of the volume falls below 1/1000.
std::int64_t scatter(BodyTable& bodies, std::vector<std::int32_t>& those, const Scattering& how,
                     const std::vector<std::int32_t>& obstacles);

}  // namespace scree
