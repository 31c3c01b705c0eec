// The interface to a file of bodies as rows of words under columns, whatever its format is.
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

/// A column, and the meaning of the words under it: value = scale * number + offset.
struct RowColumn {
  std::string name;  ///< name as in the file
  SourceMark mark;
  std::optional<BodyColumn> column = {};  ///< column of a body; absent: the words mean nothing for a body
  double scale = 1;
  double offset = 0;
  bool is_for_source = false;  ///< true: the RowSource itself uses the column
};

/// The way in which sizes are written.
enum class SizeStyle {
  own,    ///< as BodyColumn says
  ovito,  ///< as `scree export` writes them, in the columns size_x to size_z: see docs/trajectories.md
};

class RowSource {
 public:
  virtual ~RowSource() = default;

  const std::vector<RowColumn>& columns() const { return columns_; }
  SizeStyle style() const { return style_; }
  /// Returns the line and column for messages about the columns.
  const SourceMark& head() const { return head_; }
  /// Returns what the user should know of the file beyond its rows. Each note is a sentence without its
  /// subject, the name of the file.
  const std::vector<std::string>& notes() const { return notes_; }

  /// Reads the next row, with as many cells as there are columns. Returns false at the end.
  virtual bool next(std::vector<Cell>& row) = 0;
  virtual void rewind() = 0;
  virtual void close() = 0;

 protected:
  std::vector<RowColumn> columns_;
  SizeStyle style_ = SizeStyle::own;
  SourceMark head_{1, 1};
  std::vector<std::string> notes_;
};

/// Opens a CSV file, an XYZ file or a dump of LAMMPS, which are distinguished by their first lines. `frame`:
/// the number, from 0, of the frame of an XYZ file or a dump; absent: the last frame. Throws InputError
/// through the reader.
std::unique_ptr<RowSource> open_rows(const std::filesystem::path& file, std::optional<std::int64_t> frame,
                                     const Reader& reader);

}  // namespace scree
