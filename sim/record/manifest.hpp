// manifest.json: what made this folder, on what, and how it came out.
#pragma once

#include "sim/model/model.hpp"
#include "sim/record/checks.hpp"
#include "sim/record/guards.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace scree {

/// The state after a step.
struct StateMark {
  std::int64_t step;
  std::uint64_t hash;
};

/// A body of a step that failed, in the state before it.
struct FailedBody {
  std::string name;  ///< as the error has it
  Vec3 position;     ///< m
  Vec3 velocity;     ///< m/s
  Vec3 spin;         ///< rad/s
};

struct RunSummary {
  std::string status = {};  ///< done, failed, interrupted
  std::string error = {};   ///< why it failed
  std::vector<FailedBody> failed = {};
  std::string space = {};  ///< where the broad phase ran
  std::vector<Feature> model = {};
  std::int64_t steps = 0;
  std::int64_t steps_total = 0;
  double time = 0;        ///< s
  Observation last = {};  ///< the newest; of the last state, unless that could not be observed
  std::uint64_t state_hash = 0;
  std::vector<StateMark> states = {};  ///< on the way
  double wall = 0;  ///< of the whole run, drawing and writing included, but not the time it was stopped (s)
  std::vector<std::int64_t> resumed_at = {};  ///< steps
  std::int64_t frames = 0;
  std::string movie = {};     ///< file name; empty if there is none
  std::string renderer = {};  ///< what drew the frames of this run, or of the last part of it; empty: nothing
  std::int64_t trajectory_frames = 0;
  std::vector<CheckResult> checks = {};
  std::vector<std::string> warnings = {};
  std::vector<GuardCount> guards = {};
};

/// The text of manifest.json; the wall times by stage are those of core/timing.hpp.
std::string manifest_of(const Scene& scene, const RunSummary& run);

/// What a manifest tells for a run to be repeated.
struct RecordedRun {
  std::string scene_hash, commit, space;
  std::vector<StateMark> states;  ///< with the last
};
/// Throws InputError if the file is no manifest.
RecordedRun read_manifest(const std::filesystem::path& file);
/// As the manifest of a run of this scene has it.
std::string scene_hash_of(const Scene& scene);

/// The steps of the run that a manifest tells of, if that is done; nothing if it is not, or the file is none.
std::optional<std::int64_t> steps_done(const std::filesystem::path& manifest);

/// As manifests and summaries write hashes: 16 hexadecimal digits.
std::string hex(std::uint64_t hash);

}  // namespace scree
