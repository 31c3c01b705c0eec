// The rows of one frame of a particle format that is text: a known number of lines, whose words are separated
// by blanks.
#pragma once

#include "sim/scene/row_source.hpp"

#include <optional>
#include <string_view>

namespace scree {

class FrameRows : public RowSource {
 public:
  bool next(std::vector<Cell>& row) final;
  void rewind() final;
  void close() final { lines_.close(); }

 protected:
  FrameRows(TextLines lines, const Reader& reader) : reader_(reader), lines_(std::move(lines)) {}

  /// The number of rows of a frame, and where they are in the file.
  struct Frame {
    std::int64_t rows = 0;
    TextLines::Place place;  ///< end of the line before the first row
  };

  /// Skips the rows of a frame. Throws InputError if the file ends before the last row.
  void skip(const Frame& frame);
  void choose(const Frame& frame);
  /// Throws InputError if the file, which has `frames` frames, has no frame of the wanted number.
  void require_frame(std::optional<std::int64_t> wanted, std::int64_t frames) const;
  /// Returns the whole number that a line consists of. `what` describes it in messages.
  std::int64_t count_of(std::string_view line, const char* what) const;
  void add_column(std::string name, SourceMark mark, std::optional<BodyColumn> column, double scale = 1,
                  double offset = 0);
  /// Sets the index of the column, the next one to be added, that says whether a body is free, as `scree
  /// export` writes it.
  void set_mobility(std::size_t column) { mobility_ = column; }
  void fail_short(std::int64_t rows, std::int64_t of) const;

  const Reader& reader_;
  TextLines lines_;

 private:
  Frame frame_;
  std::int64_t left_ = 0;  ///< number of rows of the frame that are not read yet
  std::int64_t held_ = 0;  ///< number of rows of bodies that are not free, which are left out
  bool counted_ = false;
  std::optional<std::size_t> mobility_;
};

}  // namespace scree
