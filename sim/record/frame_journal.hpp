// The frames of a trajectory while they are written: to a journal, from which a VTKHDF file is made when all
// are there. So a run that dies half way can be continued, and readers never see half a file.
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

/// The simulated time and the size of a frame, and the source of its numbers.
struct FrameSource {
  TrajectoryFrame frame;
  /// Sets the numbers of rows first, first + 1, ... of a column, in the column's type. It is called from
  /// several threads.
  std::function<void(std::size_t column, std::int64_t first, std::int64_t rows, std::span<std::byte> out)>
      write;
  /// Whether a column is equal to that of the frame before, which then has as many rows: it is not written
  /// again.
  std::function<bool(std::size_t column)> is_kept;
};

class FrameJournal {
 public:
  /// `expected_rows`: number of rows of a large frame. `threads`: number of threads that compress. All
  /// functions throw RunError with the path and the reason if the disk does not take the data.
  FrameJournal(std::vector<TrajectoryColumn> columns, std::int64_t expected_rows, Cells cells,
               std::filesystem::path file, AtomicFile::Opening opening, int threads);

  void append(const FrameSource& source);
  /// Saves how far the journal is written, after bringing that to the disk; on loading, removes what was
  /// added after the state was saved.
  void archive(Archive& archive);
  /// Writes the file. The journal stays until drop(), since the run may have to be continued.
  void finish();
  /// Removes the journal, as the run will not be continued.
  void drop();

  std::int64_t frames() const { return std::ssize(index_.frames()); }

 private:
  /// Returns the compressed chunks of these columns, one column after another.
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
