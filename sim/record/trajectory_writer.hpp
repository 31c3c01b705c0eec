// trajectory.vtkhdf, as it is written: frame after frame to a journal, which becomes the file when all are
// there. So a run that dies half way can go on with it, and readers never see half a file.
#pragma once

#include "core/archive.hpp"
#include "core/snapshot.hpp"
#include "sim/record/files.hpp"
#include "sim/record/trajectory_columns.hpp"
#include "sim/record/trajectory_index.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace scree {

class TrajectoryWriter {
 public:
  /// `threads` compress. Everything throws RunError with the path and the reason if the disk does not take
  /// it.
  TrajectoryWriter(const Scene& scene, std::filesystem::path file, AtomicFile::Opening opening, int threads);

  /// Adds a frame: the bodies that are there, by ascending id.
  void append(const Snapshot& snapshot);
  /// What was added until the state was saved is on the disk; what was added since is gone on loading.
  void archive(Archive& archive);
  /// Writes the file. The journal stays until drop(): the run may have to go on with it.
  void finish();
  /// Nobody will go on with it: removes the journal.
  void drop();

  std::int64_t frames() const { return static_cast<std::int64_t>(index_.frames().size()); }

 private:
  /// Of the bodies in rows_, column by column.
  std::vector<std::string> chunks_of(const BodyTable& bodies,
                                     const std::vector<const BodyColumnSource*>& columns) const;

  std::filesystem::path file_;
  int threads_;
  std::vector<BodyColumnSource> sources_;
  TrajectoryIndex index_;
  AtomicFile journal_;
  std::int64_t journal_bytes_ = 0;
  std::vector<std::int32_t> rows_;  ///< bodies of the last frame
};

}  // namespace scree
