// Rows of one frame of a particle format that is text: a known number of lines, of words that blanks part.
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

  /// Where the rows are, once the lines have come to the frame.
  struct Frame {
    std::int64_t rows = 0;
    TextLines::Place place;  ///< behind the line before the first one
  };

  /// Reads on behind the frame. Throws InputError if it ends before its last row.
  void skip(const Frame& frame);
  void choose(const Frame& frame);
  /// Throws InputError if there is no frame of the number, of so many.
  void require_frame(std::optional<std::int64_t> wanted, std::int64_t frames) const;
  /// The whole number that the line is.
  std::int64_t count_of(std::string_view line, const char* what) const;
  void add_column(std::string name, SourceMark mark, std::optional<BodyColumn> column, double scale = 1,
                  double offset = 0);
  /// Which of the columns, the next one to be added, says that a body is not free, as `scree export` writes
  /// it.
  void set_mobility(std::size_t column) { mobility_ = column; }
  void fail_short(std::int64_t rows, std::int64_t of) const;

  const Reader& reader_;
  TextLines lines_;

 private:
  Frame frame_;
  std::int64_t left_ = 0;  ///< rows of the frame that are not read yet
  std::int64_t held_ = 0;  ///< rows of bodies that are not free, which are left out
  bool counted_ = false;
  std::optional<std::size_t> mobility_;
};

}  // namespace scree
