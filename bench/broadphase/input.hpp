// The inputs of the broad-phase benchmark: scenes and data sets.
#pragma once

#include "bench/broadphase/order.hpp"

#include <cstdint>
#include <string>

namespace scree::bench {

/// Returns whether the word names a scene file rather than a data set.
bool names_scene(const std::string& word);

/// Returns the boxes that the simulation makes of a scene in its first step. Throws InputError as `scree run`
/// does.
Objects<Host> objects_of_scene(const std::string& file);

/// Returns n objects of a data set, all free.
Objects<Host> objects_of_data_set(const std::string& name, std::int64_t n);

}  // namespace scree::bench
