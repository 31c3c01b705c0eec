// What a scene says about the response, resolved.
#pragma once

#include "sim/laws/contact_laws.hpp"
#include "sim/laws/response_parameters.hpp"
#include "sim/scene/scene.hpp"

#include <vector>

namespace scree {

ResponseParameters response_parameters_of(const Scene& scene);

/// Materials x materials.
std::vector<PairLaw> pair_laws_of(const Scene& scene);

}  // namespace scree
