// The index of a trajectory: where its parts are in the file. A trajectory has frames of rows, one row for
// each body that is present or two for each contact, in columns of numbers.
#pragma once

#include "core/archive.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace scree {

struct TrajectoryColumn {
  std::string name;
  FieldType type;  ///< a type of numbers, not of bytes

  friend bool operator==(const TrajectoryColumn&, const TrajectoryColumn&) = default;
};

struct TrajectoryFrame {
  std::int64_t step = 0;
  double time = 0;        ///< s
  std::int64_t rows = 0;  ///< number of bodies, or twice that of contacts
};

/// The compressed numbers of chunk_rows() rows of a column, in some file. The last chunk of a frame is filled
/// up with zeros.
struct TrajectoryChunk {
  std::int64_t place = 0;
  std::int64_t bytes = 0;
};

class TrajectoryIndex {
 public:
  /// Largest number of rows in a chunk: it keeps small what must be read for one row.
  static constexpr std::int64_t most_chunk_rows = 1 << 16;

  TrajectoryIndex(std::vector<TrajectoryColumn> columns, std::int64_t chunk_rows)
      : columns_(std::move(columns)), chunk_rows_(chunk_rows) {}

  const std::vector<TrajectoryColumn>& columns() const { return columns_; }
  std::int64_t chunk_rows() const { return chunk_rows_; }
  const std::vector<TrajectoryFrame>& frames() const { return frames_; }
  const std::vector<TrajectoryChunk>& chunks() const { return chunks_; }

  /// Adds a frame. The first chunk of each of its columns will be added next, or was added for an earlier
  /// frame of the same size.
  void add_frame(const TrajectoryFrame& frame, std::span<const std::int64_t> first_chunks);
  void add_chunk(const TrajectoryChunk& chunk) { chunks_.push_back(chunk); }
  /// Returns the number of chunks of a column in a frame of so many rows.
  std::int64_t chunks_for(std::int64_t rows) const { return (rows + chunk_rows_ - 1) / chunk_rows_; }
  std::int64_t first_chunk(std::size_t frame, std::size_t column) const {
    return first_chunks_[frame * columns_.size() + column];
  }

  /// Sets the positions of the chunks in another file.
  void move_chunks(std::vector<TrajectoryChunk> chunks) { chunks_ = std::move(chunks); }

  /// Saves or loads the frames and chunks; the columns stay the same.
  void archive(Archive& archive);

  std::string text() const;
  /// Reads an index. Throws RunError if the text is not an index in which every chunk lies in the first
  /// `bytes` of a file and has no more rows than its bytes can hold.
  static TrajectoryIndex parse(std::string_view text, std::int64_t bytes);

  /// Throws RunError if a chunk does not lie in the first `bytes` of a file.
  void expect_in_order(std::int64_t bytes) const;

 private:
  std::vector<TrajectoryColumn> columns_;
  std::int64_t chunk_rows_;
  std::vector<TrajectoryFrame> frames_;
  std::vector<TrajectoryChunk> chunks_;
  std::vector<std::int64_t> first_chunks_;  // first chunk of each column in each frame
};

}  // namespace scree
