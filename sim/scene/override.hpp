// --set key.path=value: changes to the tree of a scene before it is read.
#pragma once

#include "sim/scene/reader.hpp"
#include "sim/scene/type.hpp"

#include <vector>

namespace scree {

/// Applies the overrides in order. Keys that the table knows are created where they are absent, and start
/// with their default; list items and named entries must exist. Throws InputError that names the part of the
/// path that is unknown.
void apply_overrides(Node& root, const Type& type, const std::vector<Override>& overrides);

}  // namespace scree
