// Frames of rows in columns, as they are written: to a journal, which becomes a VTKHDF file when all are
// there. So a run that dies half way can go on with it, and readers never see half a file.
#pragma once

#include "core/archive.hpp"
#include "sim/record/files.hpp"
#include "sim/record/trajectory_index.hpp"
#include "sim/record/vtkhdf.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <vector>

namespace scree {

/// Simulated time and size of a frame, and where its numbers come from.
struct FrameSource {
  TrajectoryFrame frame;
  /// Sets the numbers of rows first, first + 1, ... of a column, as its type has them. From several threads.
  std::function<void(std::size_t column, std::int64_t first, std::int64_t rows, std::span<std::byte> out)>
      write;
  /// Whether a column is that of the frame before, which then has as many rows: it is not written again.
  std::function<bool(std::size_t column)> is_kept;
};

class FrameJournal {
 public:
  /// `expected_rows`: of a large frame. `threads` compress. Everything throws RunError with the path and the
  /// reason if the disk does not take it.
  FrameJournal(std::vector<TrajectoryColumn> columns, std::int64_t expected_rows, Cells cells,
               std::filesystem::path file, AtomicFile::Opening opening, int threads);

  void append(const FrameSource& source);
  /// What was added until the state was saved is on the disk; what was added since is gone on loading.
  void archive(Archive& archive);
  /// Writes the file. The journal stays until drop(): the run may have to go on with it.
  void finish();
  /// Nobody will go on with it: removes the journal.
  void drop();

  std::int64_t frames() const { return std::ssize(index_.frames()); }

 private:
  /// Of these columns, one after another.
  std::vector<std::string> chunks_of(const FrameSource& source,
                                     const std::vector<std::size_t>& columns) const;

  Cells cells_;
  std::filesystem::path file_;
  int threads_;
  TrajectoryIndex index_;
  AtomicFile journal_;
  std::int64_t journal_bytes_ = 0;
};

}  // namespace scree
