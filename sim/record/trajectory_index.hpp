// Where the parts of a trajectory are: frames of rows, one for each body that is there or two for each
// contact, in columns of numbers.
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
  FieldType type;  ///< numbers, no bytes

  friend bool operator==(const TrajectoryColumn&, const TrajectoryColumn&) = default;
};

struct TrajectoryFrame {
  std::int64_t step = 0;
  double time = 0;        ///< s
  std::int64_t rows = 0;  ///< bodies, or twice the contacts
};

/// The compressed numbers of so many rows of a column, in some file. The last one of a frame is filled up
/// with zeros.
struct TrajectoryChunk {
  std::int64_t place = 0;
  std::int64_t bytes = 0;
};

class TrajectoryIndex {
 public:
  /// In a chunk: what is read for one row stays small.
  static constexpr std::int64_t most_chunk_rows = 1 << 16;

  TrajectoryIndex(std::vector<TrajectoryColumn> columns, std::int64_t chunk_rows)
      : columns_(std::move(columns)), chunk_rows_(chunk_rows) {}

  const std::vector<TrajectoryColumn>& columns() const { return columns_; }
  std::int64_t chunk_rows() const { return chunk_rows_; }
  const std::vector<TrajectoryFrame>& frames() const { return frames_; }
  const std::vector<TrajectoryChunk>& chunks() const { return chunks_; }

  /// A frame, of which the first chunk of each column will be added next, or was added for an earlier frame
  /// as large.
  void add_frame(const TrajectoryFrame& frame, std::span<const std::int64_t> first_chunks);
  void add_chunk(const TrajectoryChunk& chunk) { chunks_.push_back(chunk); }
  /// Chunks of a column in a frame of so many rows.
  std::int64_t chunks_for(std::int64_t rows) const { return (rows + chunk_rows_ - 1) / chunk_rows_; }
  std::int64_t first_chunk(std::size_t frame, std::size_t column) const {
    return first_chunks_[frame * columns_.size() + column];
  }

  /// The same chunks, in another file.
  void move_chunks(std::vector<TrajectoryChunk> chunks) { chunks_ = std::move(chunks); }

  /// Frames and chunks; the columns are the same.
  void archive(Archive& archive);

  std::string text() const;
  /// Throws RunError unless the text is of an index in which every chunk lies in the first `bytes` of a file
  /// and has no more rows than its own bytes can hold.
  static TrajectoryIndex parse(std::string_view text, std::int64_t bytes);

  /// Throws RunError unless every chunk lies in the first `bytes` of a file.
  void expect_in_order(std::int64_t bytes) const;

 private:
  std::vector<TrajectoryColumn> columns_;
  std::int64_t chunk_rows_;
  std::vector<TrajectoryFrame> frames_;
  std::vector<TrajectoryChunk> chunks_;
  std::vector<std::int64_t> first_chunks_;  // of each column in each frame
};

}  // namespace scree
