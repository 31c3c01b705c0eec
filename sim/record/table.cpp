#include "sim/record/table.hpp"

#include "core/error.hpp"
#include "sim/scene/reader.hpp"

#include <fmt/format.h>

#include <charconv>
#include <system_error>

namespace scree {

namespace {

std::vector<std::string_view> cells_of(std::string_view line) {
  std::vector<std::string_view> cells;
  for (std::size_t begin = 0;;) {
    const std::size_t end = line.find(',', begin);
    cells.push_back(line.substr(begin, end - begin));
    if (end == std::string_view::npos) return cells;
    begin = end + 1;
  }
}

}  // namespace

std::optional<double> number_in(std::string_view cell) {
  double value = 0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  return error == std::errc() && end == cell.data() + cell.size() ? std::optional(value) : std::nullopt;
}

Table::Table(const std::filesystem::path& file) : file_(file), stream_(file) {
  if (!stream_.is_open()) throw InputError(fmt::format("{}: cannot be read", file.string()));
  if (!next()) throw InputError(fmt::format("{}: is empty", file.string()));
  for (const std::string_view name : cells_) {
    if (!place_.emplace(name, columns_.size()).second)
      throw InputError(printable(fmt::format("{}: two columns are called {}", file.string(), name)));
    columns_.emplace_back(name);
  }
}

std::optional<std::size_t> Table::find(const std::string& name) const {
  const auto found = place_.find(name);
  return found == place_.end() ? std::nullopt : std::optional(found->second);
}

bool Table::next() {
  if (!std::getline(stream_, line_)) return false;
  ++number_;
  cells_ = cells_of(line_);
  if (!columns_.empty() && cells_.size() != columns_.size())
    throw InputError(fmt::format("{}:{}: {} cells, where the first line has {}", file_.string(), number_,
                                 cells_.size(), columns_.size()));
  return true;
}

}  // namespace scree
