// What the broad-phase benchmark is asked to work on.
#pragma once

#include "bench/broadphase/order.hpp"

#include <cstdint>
#include <string>

namespace scree::bench {

/// Whether the words name a scene file, and not a data set.
bool names_scene(const std::string& word);

/// The boxes that the simulation makes of a scene in its first step. Throws InputError as `scree run` does.
Objects<Host> objects_of_scene(const std::string& file);

/// n objects of a data set, all free.
Objects<Host> objects_of_data_set(const std::string& name, std::int64_t n);

}  // namespace scree::bench
