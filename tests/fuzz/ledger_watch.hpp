// A watch over the laws that every scene must obey at every step.
#pragma once

#include "sim/scene/scene.hpp"
#include "sim/step/simulation.hpp"
#include "tests/fuzz/random_scene.hpp"

#include <map>
#include <string>

namespace scree {

/// The step in which a law was first broken, and the worst breach of it. `worst` is in the unit of `bound`.
struct Breach {
  std::int64_t first_step = 0;
  std::int64_t worst_step = 0;
  double worst = 0;
  double bound = 0;
};

/// Breaches by the name of the law.
using Breaches = std::map<std::string, Breach>;

/// Runs the scene to its end, and returns the laws that it breaks. A run that throws breaks the law `runs`.
Breaches watch(const Scene& scene, const RandomScene& origin);

}  // namespace scree
