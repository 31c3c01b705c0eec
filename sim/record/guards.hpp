// The counts of what the guards and limits of a run had to do, how much each matters, and the setting that
// makes it smaller.
#pragma once

#include "sim/observe/observation.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace scree {

/// The deepest overlap in the states of a run that were measured.
struct WorstOverlap {
  double relative = 0;  ///< depth as a share of the smaller body's size
  double time = 0;      ///< s
  std::array<std::int32_t, 2> bodies{-1, -1};

  void include(const Observation& seen);
};

struct GuardCount {
  std::string_view name;     ///< name of the measure, without `guards.`
  std::int64_t count;        ///< number of events since the start
  std::string_view what;     ///< the events, in words
  std::string_view setting;  ///< the key to change, and how
  std::string effect;        ///< effect on the run, as far as its numbers show
  bool matters;              ///< whether the count changes whether to trust the run
};

/// The properties of a run that decide, besides the counts, how much a count matters.
struct GuardedRun {
  WorstOverlap worst;
  std::string bodies;      ///< the bodies of the worst overlap, in words
  bool accurate = false;   ///< whether the run is in the accurate mode
  double restitution = 0;  ///< largest restitution of any two materials
};

/// Returns the count of each guard. `last` is the observation at the end of the run.
std::vector<GuardCount> guards_of(const Observation& last, const GuardedRun& run);

/// Returns a share as a percentage of three digits, without an exponent.
std::string percent_words(double share);

/// Returns a guard's count, its effect and the setting to change, in words.
std::string line_of(const GuardCount& guard);

/// Returns a warning if the deepest overlap of the run is more than 5 % of the smaller body's size and no
/// guard that matters says so already; else an empty text.
std::string overlap_warning(const std::vector<GuardCount>& guards, const GuardedRun& run);

}  // namespace scree
