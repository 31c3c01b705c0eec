// The identity of a run, by which a checkpoint is recognised as one of the same run.
#pragma once

#include "core/archive.hpp"
#include "sim/scene/scene.hpp"

#include <cstdint>
#include <string>

namespace scree {

/// The properties that must be the same for a run to be continued, and the commit, which should be the same.
struct RunIdentity {
  std::string version, commit, space;
  std::string scene;         ///< the resolved scene
  std::uint64_t bodies = 0;  ///< checksum of the bodies at the start, which may come from files

  void archive(Archive& archive);
};

RunIdentity identity_of(const Scene& scene, const std::string& space);

/// Returns in words how the run of a checkpoint differs from the present one; empty if it is the same run.
std::string difference_of(const RunIdentity& saved, const RunIdentity& present);

}  // namespace scree
