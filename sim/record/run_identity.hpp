// Of which run a checkpoint is.
#pragma once

#include "core/archive.hpp"
#include "sim/scene/scene.hpp"

#include <cstdint>
#include <string>

namespace scree {

/// What must be the same for a run to go on, and the commit, which should be.
struct RunIdentity {
  std::string version, commit, space;
  std::string scene;         ///< resolved
  std::uint64_t bodies = 0;  ///< checksum of the bodies that it starts with, which may come from files

  void archive(Archive& archive);
};

RunIdentity identity_of(const Scene& scene, const std::string& space);

/// In what a checkpoint is of another run than the present one; empty if it is of the same.
std::string difference_of(const RunIdentity& saved, const RunIdentity& present);

}  // namespace scree
