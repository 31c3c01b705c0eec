// Keys of a scene to vary, and every combination of their values.
#pragma once

#include "sim/scene/scene.hpp"

#include <string>
#include <vector>

namespace scree {

struct Variation {
  std::string key;                  ///< as of Override
  std::vector<std::string> values;  ///< YAML
};

/// Of KEY=V1,V2,... or, where values hold commas, KEY=[V1, V2, ...]. Throws InputError.
Variation parse_variation(const std::string& text);

/// Every combination, the last key's values changing fastest: one, without settings, if nothing varies.
std::vector<std::vector<Override>> combinations(const std::vector<Variation>& variations);

/// "time.step=0.01 response.mode=accurate".
std::string describe(const std::vector<Override>& settings);

}  // namespace scree
