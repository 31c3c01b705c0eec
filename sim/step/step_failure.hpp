// The bodies that the message of a failed step is about, and their names in words.
#pragma once

#include "core/bodies.hpp"
#include "core/error.hpp"
#include "sim/scene/scene.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace scree {

/// Returns, in order, the bodies with a number in their state that is not finite, or with a position beyond
/// the range of the broad phase.
std::vector<std::int32_t> bodies_out_of_range(const BodyTable& bodies);

/// Returns the free bodies, by descending kinetic energy of their centres.
std::vector<std::int32_t> by_kinetic_energy(const BodyTable& bodies);

/// Returns a list of bodies in words, such as: ball[3] (body 17), body 18 and 5 more.
std::string words_for(const std::vector<std::int32_t>& bodies, const Scene& scene);

}  // namespace scree
