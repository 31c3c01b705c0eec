// Keys of a scene to vary, and every combination of their values.
#pragma once

#include "sim/scene/scene.hpp"

#include <string>
#include <vector>

namespace scree {

struct Variation {
  std::string key;                  ///< path of the key, as in Override
  std::vector<std::string> values;  ///< values in YAML
};

/// Parses KEY=V1,V2,... or, where values hold commas, KEY=[V1, V2, ...]. Throws InputError.
Variation parse_variation(const std::string& text);

/// Returns every combination of the values; those of the last key change fastest. If nothing varies, there is
/// one combination, without settings.
std::vector<std::vector<Override>> combinations(const std::vector<Variation>& variations);

/// Returns words such as "time.step=0.01 response.mode=accurate".
std::string describe(const std::vector<Override>& settings);

}  // namespace scree
