// manifest.json: the program, the machine and the scene of a run, and how the run ended.
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

  friend bool operator==(const StateMark&, const StateMark&) = default;
};

/// A body of a step that failed, in the state before that step.
struct FailedBody {
  std::string name;  ///< name of the body, as in the error
  Vec3 position;     ///< m
  Vec3 velocity;     ///< m/s
  Vec3 spin;         ///< rad/s
};

struct RunSummary {
  std::string status = {};  ///< done, failed, interrupted
  std::string error = {};   ///< the error that ended the run; empty if none did
  std::vector<FailedBody> failed = {};
  std::string space = {};  ///< the space in which the steps were taken
  std::vector<Feature> model = {};
  std::int64_t steps = 0;
  std::int64_t steps_total = 0;
  double time = 0;        ///< s
  Observation last = {};  ///< the newest observation: that of the last state, unless it could not be made
  std::uint64_t state_hash = 0;
  std::vector<StateMark> states = {};  ///< some states during the run
  double wall = 0;  ///< wall time with drawing and writing, without the time in which the run was stopped (s)
  std::vector<std::int64_t> resumed_at = {};  ///< steps at which the run was resumed
  std::int64_t frames = 0;
  std::string movie = {};     ///< file name of the movie; empty if there is none
  std::string renderer = {};  ///< renderer of the frames (of the last part); empty if none were drawn
  std::int64_t trajectory_frames = 0;
  std::vector<CheckResult> checks = {};
  std::vector<std::string> warnings = {};
  std::vector<GuardCount> guards = {};
};

/// Returns the text of manifest.json. The wall times by stage are those of core/timing.hpp.
std::string manifest_of(const Scene& scene, const RunSummary& run);

/// The entries of a manifest that are needed to repeat its run.
struct RecordedRun {
  std::string scene_hash, commit, space;
  std::vector<StateMark> states;  ///< the recorded states, of which the last is that of the end
};
/// Reads a manifest. Throws InputError if there is no such file, or if it is not the manifest of a run.
RecordedRun read_manifest(const std::filesystem::path& file);
/// Returns the hash of a scene that the manifest of its run has.
std::string scene_hash_of(const Scene& scene);

/// Returns the number of steps of the run that a manifest belongs to, if that run is done; nothing if it is
/// not done, or if the file is not a manifest.
std::optional<std::int64_t> steps_done(const std::filesystem::path& manifest);

/// Returns a hash as manifests and summaries show it: 16 hexadecimal digits.
std::string hex(std::uint64_t hash);

}  // namespace scree
