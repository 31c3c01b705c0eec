// The reader of files that have a row for each body: a table, or a frame of particles (see RowSource).
#pragma once

#include "sim/scene/body_row.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace scree {

/// Returns the file that a path names: the path itself, or the final state in the folder of a run. Throws
/// InputError, without a line and column, if there is none.
std::filesystem::path find_body_file(const std::filesystem::path& path);

class BodyFile {
 public:
  /// Reads the names of the columns and counts the rows, in constant memory. Throws InputError with
  /// file:line:column, the column's name and what is allowed.
  explicit BodyFile(const std::filesystem::path& file, const BodyFileUse& use = {});
  BodyFile(const BodyFile&) = delete;
  BodyFile& operator=(const BodyFile&) = delete;

  std::int64_t count() const { return count_; }  ///< number of bodies; at least 1

  /// Returns sentences about what was left out, and about what was assumed because the file does not say it.
  const std::vector<std::string>& notes() const { return notes_; }

  /// Calls `take` with each row in order. Throws like the constructor.
  void read(const std::function<void(const BodyRow&)>& take);

  /// Returns the path of the file that a row names in its column `hull`.
  std::filesystem::path hull_file(const BodyRow& row) const { return file_.parent_path() / row.hull; }

  [[noreturn]] void fail(BodyColumn column, const SourceMark& mark, std::string_view what);

 private:
  void find_columns();
  void find_shape();
  void check_shape_of_scene();
  void find_shape_by_sizes();
  void count_rows();
  void note_ignored(const std::vector<bool>& is_used);
  bool has(BodyColumn column) const;
  SourceMark mark_of(BodyColumn column) const;
  BodyCells cells_of(const std::vector<Cell>& row) const;

  std::filesystem::path file_;
  Reader reader_;
  BodyFileUse use_;
  std::unique_ptr<RowSource> rows_;
  std::optional<RowReader> row_reader_;  ///< set once the columns of the file are known
  std::vector<std::string> notes_;
  std::int64_t count_ = 0;
};

}  // namespace scree
