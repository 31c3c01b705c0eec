// The reader of XYZ files, plain and extended. A frame has the number of particles, a comment, and a line for
// each particle. The comment of an extended file names the columns (Properties=pos:R:3:radius:R:1...); the
// columns of a plain file are the element, x, y and z.
#pragma once

#include "sim/scene/frame_rows.hpp"

namespace scree {

class XyzRows final : public FrameRows {
 public:
  XyzRows(TextLines lines, std::optional<std::int64_t> frame, const Reader& reader);

 private:
  void read_properties(std::string_view properties, const SourceMark& mark);
  void add_property(std::string_view name, std::int64_t count, const SourceMark& mark);
  void count_plain_columns(const Frame& frame);

  bool is_own_ = false;  ///< true: the file was written by `scree export`
};

}  // namespace scree
