// Bodies from a file that has a row for each: a table, or a frame of particles (see RowSource).
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

/// The file that a path names: itself, or the final state in a run's folder. Throws InputError, without a
/// place, if there is none.
std::filesystem::path find_body_file(const std::filesystem::path& path);

class BodyFile {
 public:
  /// Reads what names the columns and counts the rows, in constant memory. Throws InputError:
  /// file:line:column, the column's name, what is allowed.
  explicit BodyFile(const std::filesystem::path& file, const BodyFileUse& use = {});
  BodyFile(const BodyFile&) = delete;
  BodyFile& operator=(const BodyFile&) = delete;

  std::int64_t count() const { return count_; }  ///< of bodies; at least 1

  /// What was left out, and what was understood that the file does not say: a sentence for each.
  const std::vector<std::string>& notes() const { return notes_; }

  /// Calls `take` with each row in order. Throws like the constructor.
  void read(const std::function<void(const BodyRow&)>& take);

  /// The file that a row names.
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
  std::optional<RowReader> row_reader_;  ///< once it is known what the file has
  std::vector<std::string> notes_;
  std::int64_t count_ = 0;
};

}  // namespace scree
