// Small random scenes: everything that a scene can combine, drawn from one number.
#pragma once

#include <cstdint>
#include <string>

namespace scree {

/// What the laws that a scene must obey depend on.
struct RandomScene {
  std::string yaml;       ///< the whole scene; runs alone as a file
  bool closed = false;    ///< nothing acts from outside: no gravity, nothing fixed or driven
  bool overlaps = false;  ///< bodies may overlap at the start
};

/// Draws restitution, friction, ratios of mass and of size, overlaps at the start, shapes, gravity, what
/// holds the bodies (nothing, a floor, a room, a tube, a platform that moves), step and substeps. The same
/// text for the same seed, everywhere and always.
RandomScene random_scene(std::uint64_t seed);

}  // namespace scree
