// What may be said of a run besides its scene.
#pragma once

#include <string>

namespace scree {

/// A change to a scene before anything in it is checked: `--set key.path=value` of the program.
struct Override {
  std::string path;   ///< bodies[2].velocity[0]
  std::string value;  ///< YAML
};

enum class SpaceChoice { automatic, host, cuda };

struct SimulationOptions {
  /// automatic: the GPU if the machine has one and the scene has bodies enough for it, else the processor.
  SpaceChoice space = SpaceChoice::automatic;
  int threads = 0;  ///< 0: all cores. Never changes the result.
};

}  // namespace scree
