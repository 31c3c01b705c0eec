// Small random scenes, each drawn from one seed: shapes, materials, motions and steps in many combinations.
#pragma once

#include <cstdint>
#include <string>

namespace scree {

/// A random scene, with the properties on which the laws depend that it must obey.
struct RandomScene {
  std::string yaml;       ///< the text of the whole scene, which runs as a file by itself
  bool closed = false;    ///< whether nothing acts from outside: no gravity, and no fixed or driven bodies
  bool overlaps = false;  ///< whether bodies may overlap at the start
};

/// Draws a scene: restitution, friction, ratios of mass and of size, overlaps at the start, shapes, gravity,
/// what holds the bodies (nothing, a floor, a room, a tube, a moving platform), step and substeps. The same
/// seed gives the same text everywhere and always.
RandomScene random_scene(std::uint64_t seed);

}  // namespace scree
