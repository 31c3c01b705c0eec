// A file of bodies as rows of words under columns, whatever its format is.
#pragma once

#include "sim/scene/body_column.hpp"
#include "sim/scene/text_lines.hpp"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace scree {

/// What the words under it say of a body: value = scale * number + offset.
struct RowColumn {
  std::string name;  ///< as in the file
  SourceMark mark;
  std::optional<BodyColumn> column = {};  ///< none: nothing that a body has
  double scale = 1;
  double offset = 0;
  bool is_for_source = false;  ///< the rows' own reader uses it
};

/// How sizes are written.
enum class SizeStyle {
  own,    ///< as BodyColumn says
  ovito,  ///< as `scree export` writes them, in the columns size_x to size_z: see docs/trajectories.md
};

class RowSource {
 public:
  virtual ~RowSource() = default;

  const std::vector<RowColumn>& columns() const { return columns_; }
  SizeStyle style() const { return style_; }
  /// Where a message about the columns points.
  const SourceMark& head() const { return head_; }
  /// What the reader of a scene should know of the file, beyond its rows: whole sentences' ends, for "it
  /// ...".
  const std::vector<std::string>& notes() const { return notes_; }

  /// The next row: as many cells as there are columns. False at the end.
  virtual bool next(std::vector<Cell>& row) = 0;
  virtual void rewind() = 0;
  virtual void close() = 0;

 protected:
  std::vector<RowColumn> columns_;
  SizeStyle style_ = SizeStyle::own;
  SourceMark head_{1, 1};
  std::vector<std::string> notes_;
};

/// A CSV file, an XYZ file or a dump of LAMMPS, told apart by their first lines; of the last two the frame of
/// that number, from 0, or the last one. Throws InputError, by the reader.
std::unique_ptr<RowSource> open_rows(const std::filesystem::path& file, std::optional<std::int64_t> frame,
                                     const Reader& reader);

}  // namespace scree
