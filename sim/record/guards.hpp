// What guards and bounds of a run have counted, and the setting that would have had them count less.
#pragma once

#include "sim/observation.hpp"

#include <cstdint>
#include <string_view>
#include <vector>

namespace scree {

struct GuardCount {
  std::string_view name;     ///< of the measure, without `guards.`
  std::int64_t count;        ///< since the start
  std::string_view what;     ///< was counted
  std::string_view setting;  ///< to change, and how
};

std::vector<GuardCount> guards_of(const Observation& now);

}  // namespace scree
