// The bodies of the benchmark: boxes of seven families at random places and in random orientations. The
// random numbers are seeded by the body's number, so a family is the same on every machine.
#pragma once

#include "core/bodies.hpp"
#include "core/rng.hpp"

#include <cstdint>

namespace scree::bench {

/// Families of boxes, named by the largest ratio of the longest side to the shortest.
enum class BoxFamily {
  cubes,
  boxes_10,  ///< each side log-uniform from a tenth of the longest possible side
  boxes_100,
  plates_10,  ///< two long sides
  plates_100,
  rods_10,  ///< one long side
  rods_100,
  count
};
const char* name_of(BoxFamily family);

/// Returns random half extents, 1 m at most.
Vec3 random_half_extents(BoxFamily family, Random& random);

/// Returns the mean volume in which the centre of one box must be to overlap another one, over all their
/// orientations (m^3): V_a + V_b + (S_a M_b + S_b M_a) / 4 pi, where S are the surfaces and M the integrals
/// of mean curvature (Isihara 1950, "Determination of molecular shape by osmotic measurement").
double excluded_volume(const Vec3& half_a, const Vec3& half_b);

struct BoxScene {
  BodyTable bodies;  ///< shape, size, position, orientation and mobility alone; bodies near in space are near
                     ///< in number
  double fraction;   ///< share of the cube that the bodies' volumes add up to
};

/// Makes boxes that may overlap, at random places in a cube. The cube's size is such that each box would
/// overlap `overlaps_per_body` others if the cube had no walls.
BoxScene make_boxes(BoxFamily family, std::int64_t count, double overlaps_per_body);

}  // namespace scree::bench
