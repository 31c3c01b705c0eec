// The laws that every scene obeys at every step, watched.
#pragma once

#include "sim/scene/scene.hpp"
#include "sim/step/simulation.hpp"
#include "tests/fuzz/random_scene.hpp"

#include <map>
#include <string>

namespace scree {

/// Where a law was first broken, and how badly it was at worst. `worst` is in the unit of `bound`.
struct Breach {
  std::int64_t first_step = 0;
  std::int64_t worst_step = 0;
  double worst = 0;
  double bound = 0;
};

/// By the name of the law.
using Breaches = std::map<std::string, Breach>;

/// Runs the scene to its end. A run that throws breaks the law `runs`.
Breaches watch(const Scene& scene, const RandomScene& origin);

}  // namespace scree
