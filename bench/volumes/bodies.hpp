// The bodies of the benchmark: boxes of seven families at random places and in random orientations. Seeded by
// the body's number, so a family is the same everywhere.
#pragma once

#include "core/bodies.hpp"
#include "core/rng.hpp"

#include <cstdint>

namespace scree::bench {

/// By the ratio of the longest side to the shortest.
enum class BoxFamily {
  cubes,
  boxes_10,  ///< each side log-uniform from a tenth of the longest that there can be
  boxes_100,
  plates_10,  ///< two long sides
  plates_100,
  rods_10,  ///< one long side
  rods_100,
  count
};
const char* name_of(BoxFamily family);

/// Half extents, 1 m at most.
Vec3 random_half_extents(BoxFamily family, Random& random);

/// Mean volume in which the centre of one box must be to overlap another one, over all their orientations
/// (m^3): V_a + V_b + (S_a M_b + S_b M_a) / 4 pi, S the surfaces and M the integrals of mean curvature
/// (Isihara 1950, "Determination of molecular shape by osmotic measurement").
double excluded_volume(const Vec3& half_a, const Vec3& half_b);

struct BoxScene {
  BodyTable bodies;  ///< shape, size, position, orientation and mobility alone; neighbours are near in number
  double fraction;   ///< of the cube they are in, that their volumes add up to
};

/// Boxes that may overlap, at random in a cube in which each would overlap so many others, if it had no
/// walls.
BoxScene make_boxes(BoxFamily family, std::int64_t count, double overlaps_per_body);

}  // namespace scree::bench
