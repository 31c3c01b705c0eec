// The options of a run that are not in its scene.
#pragma once

#include <string>

namespace scree {

/// A change to a scene before anything in it is checked, as by the program's `--set key.path=value`.
struct Override {
  std::string path;   ///< key path, such as bodies[2].velocity[0]
  std::string value;  ///< value in YAML
};

enum class SpaceChoice { automatic, host, cuda };

struct SimulationOptions {
  /// Where to run. automatic: on the GPU if the machine has one and the scene has enough bodies for it, else
  /// on the processor.
  SpaceChoice space = SpaceChoice::automatic;
  int threads = 0;  ///< number of threads; 0: all cores. It never changes the result.
  /// Whether the forces on bodies that are not free can be measured at any time. If not, they are summed up
  /// only in scenes with a check that measures a force, and are NaN in others.
  bool all_forces = true;
};

}  // namespace scree
