// What guards and bounds of a run have counted, how much it matters, and the setting that would have had them
// count less.
#pragma once

#include "sim/observe/observation.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace scree {

/// The deepest overlap of a run, of the states that it has measured.
struct WorstOverlap {
  double relative = 0;  ///< by the smaller body's size
  double time = 0;      ///< s
  std::array<std::int32_t, 2> bodies{-1, -1};

  void include(const Observation& seen);
};

struct GuardCount {
  std::string_view name;     ///< of the measure, without `guards.`
  std::int64_t count;        ///< since the start
  std::string_view what;     ///< was counted
  std::string_view setting;  ///< to change, and how
  std::string effect;        ///< on the run, as far as its numbers show
  bool matters;              ///< changes whether to trust the run
};

/// What decides how much it matters, besides the counts.
struct GuardedRun {
  WorstOverlap worst;
  std::string bodies;      ///< those of the worst overlap, in words
  bool accurate = false;   ///< the mode of the run
  double restitution = 0;  ///< the largest one of any two materials
};

/// `last`: of the run's end.
std::vector<GuardCount> guards_of(const Observation& last, const GuardedRun& run);

}  // namespace scree
