// The parameters of the response and the contact laws of a scene, with defaults filled in.
#pragma once

#include "sim/laws/contact_laws.hpp"
#include "sim/laws/response_parameters.hpp"
#include "sim/scene/scene.hpp"

#include <vector>

namespace scree {

ResponseParameters response_parameters_of(const Scene& scene);

/// Returns the laws of all pairs of materials (materials x materials).
std::vector<PairLaw> pair_laws_of(const Scene& scene);

}  // namespace scree
