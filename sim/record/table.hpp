// The reader of tables of comma-separated values that runs have written: a line of names, then a line of
// cells for each row.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace scree {

/// Returns the number in a cell; nothing if the cell holds anything else.
std::optional<double> number_in(std::string_view cell);

/// A table, read line by line, since it may be larger than memory. Functions throw InputError, with the file
/// and the line, where the file is not a table.
class Table {
 public:
  explicit Table(const std::filesystem::path& file);

  const std::vector<std::string>& columns() const { return columns_; }
  /// Returns the number of the column of that name, if there is one.
  std::optional<std::size_t> find(const std::string& name) const;
  /// Reads the next row; returns false at the end.
  bool next();
  std::string_view cell(std::size_t column) const { return cells_[column]; }

 private:
  std::filesystem::path file_;
  std::ifstream stream_;
  std::string line_;
  std::vector<std::string_view> cells_;
  std::vector<std::string> columns_;
  std::unordered_map<std::string, std::size_t> place_;
  std::int64_t number_ = 0;
};

}  // namespace scree
