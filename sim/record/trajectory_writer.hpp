// The writer of trajectory.vtkhdf: the motion of every body.
#pragma once

#include "core/archive.hpp"
#include "core/snapshot.hpp"
#include "sim/record/frame_journal.hpp"
#include "sim/record/trajectory_columns.hpp"

#include <cstdint>
#include <filesystem>
#include <vector>

namespace scree {

class TrajectoryWriter {
 public:
  /// The parameters are those of FrameJournal.
  TrajectoryWriter(const Scene& scene, std::filesystem::path file, AtomicFile::Opening opening, int threads);

  /// Adds a frame of the bodies that are present, by ascending id.
  void append(const Snapshot& snapshot);
  void archive(Archive& archive);
  void finish() { journal_.finish(); }
  void drop() { journal_.drop(); }

  std::int64_t frames() const { return journal_.frames(); }

 private:
  std::vector<BodyColumnSource> sources_;
  FrameJournal journal_;
  std::vector<std::int32_t> rows_;  ///< bodies in the rows of the last frame
};

}  // namespace scree
