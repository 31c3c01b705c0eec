// What the message of a step that the run cannot go on from is about.
#pragma once

#include "core/bodies.hpp"
#include "core/error.hpp"
#include "sim/scene/scene.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace scree {

/// Bodies with a number in their state that is not finite, or a place that is beyond what the broad phase can
/// hold, in order.
std::vector<std::int32_t> bodies_out_of_range(const BodyTable& bodies);

/// The free bodies, by descending kinetic energy of their centres.
std::vector<std::int32_t> by_kinetic_energy(const BodyTable& bodies);

/// ball[3] (body 17), body 18 and 5 more.
std::string words_for(const std::vector<std::int32_t>& bodies, const Scene& scene);

}  // namespace scree
