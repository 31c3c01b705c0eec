// What a scene says about the response, resolved.
#pragma once

#include "sim/dynamics/contact_laws.hpp"
#include "sim/dynamics/state.hpp"
#include "sim/scene/scene.hpp"

#include <vector>

namespace scree {

ResponseParameters response_parameters_of(const Scene& scene);

/// Materials x materials.
std::vector<PairLaw> pair_laws_of(const Scene& scene);

}  // namespace scree
