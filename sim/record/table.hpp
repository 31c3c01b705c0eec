// Tables of comma-separated values, as runs write them: a line of names, then a line of cells for each row.
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

/// A cell that is a number and nothing else.
std::optional<double> number_in(std::string_view cell);

/// One line at a time: a table may be larger than memory. Throws InputError, with the file and the line,
/// where it is no table.
class Table {
 public:
  explicit Table(const std::filesystem::path& file);

  const std::vector<std::string>& columns() const { return columns_; }
  /// Of a column, if there is one of that name.
  std::optional<std::size_t> find(const std::string& name) const;
  /// Goes on to the next row; false at the end.
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
