// manifest.json: what made this folder, on what, and how it came out.
#pragma once

#include "sim/model.hpp"
#include "sim/record/checks.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace scree {

struct RunSummary {
  std::string status = {};  ///< done, failed, interrupted
  std::string error = {};   ///< why it failed
  std::string space = {};   ///< where the broad phase ran
  std::vector<Feature> model = {};
  std::int64_t steps = 0;
  std::int64_t steps_total = 0;
  double time = 0;        ///< s
  Observation last = {};  ///< the newest; of the last state, unless that could not be observed
  std::uint64_t state_hash = 0;
  double wall = 0;  ///< of the whole run, drawing and writing included (s)
  std::int64_t frames = 0;
  std::string movie = {};  ///< file name; empty if there is none
  std::vector<CheckResult> checks = {};
  std::vector<std::string> warnings = {};
};

/// The text of manifest.json; the wall times by stage are those of core/timing.hpp.
std::string manifest_of(const Scene& scene, const RunSummary& run);

/// As manifests and summaries write hashes: 16 hexadecimal digits.
std::string hex(std::uint64_t hash);

}  // namespace scree
