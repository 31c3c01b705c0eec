#include "sim/scene/csv_rows.hpp"

#include "sim/scene/hints.hpp"
#include "sim/scene/scalar.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <utility>

namespace scree {
namespace {

constexpr std::size_t longest_told = 40;  // largest number of bytes of a cell in a message

std::string all_names() {
  std::vector<std::string_view> names;
  for (int k = 0; k < body_columns; ++k) names.push_back(name_of(static_cast<BodyColumn>(k)));
  return fmt::format("{}", fmt::join(names, ","));
}

std::string small(std::string_view text) {
  std::string lower(text);
  for (char& c : lower)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return lower;
}

std::optional<BodyColumn> column_called(std::string_view name) {
  const std::string lower = small(name);
  for (int k = 0; k < body_columns; ++k)
    if (name_of(static_cast<BodyColumn>(k)) == lower) return static_cast<BodyColumn>(k);
  return {};
}

/// Returns whether two names are equal, or differ only by one letter that is extra, missing or wrong, or by
/// two adjacent letters that are swapped.
bool is_slip(std::string_view a, std::string_view b) {
  if (a.size() > b.size()) std::swap(a, b);
  if (b.size() > a.size() + 1) return false;
  const auto [x, y] = std::mismatch(a.begin(), a.end(), b.begin());
  const std::string_view rest_a(x, a.end()), rest_b(y, b.end());
  if (rest_a.empty()) return true;
  if (a.size() < b.size()) return rest_a == rest_b.substr(1);
  if (rest_a.substr(1) == rest_b.substr(1)) return true;
  return rest_a.size() > 1 && rest_a[0] == rest_b[1] && rest_a[1] == rest_b[0] &&
         rest_a.substr(2) == rest_b.substr(2);
}

/// Returns the column that a misspelt name is likely to mean; empty if there is none. Short names are left
/// out, because they are near to each other by chance: fx, vx.
std::string_view misspelt(std::string_view name) {
  constexpr std::size_t short_name = 4;
  const std::string lower = small(name);
  for (int k = 0; k < body_columns; ++k) {
    const std::string_view known = name_of(static_cast<BodyColumn>(k));
    if (known.size() >= short_name && is_slip(lower, known)) return known;
  }
  return {};
}

/// Returns the delimiter of a line: the mark that is most often in it outside quotes, or a blank if there is
/// none.
char delimiter_of(std::string_view line) {
  constexpr std::string_view marks = ",;\t|";
  std::array<int, marks.size()> counts{};
  bool quoted = false;
  for (const char c : line) {
    quoted = quoted != (c == '"');
    const std::size_t mark = quoted ? std::string_view::npos : marks.find(c);
    if (mark != std::string_view::npos) ++counts[mark];
  }
  const auto most = std::ranges::max_element(counts);
  return *most > 0 ? marks[static_cast<std::size_t>(most - counts.begin())] : ' ';
}

}  // namespace

CsvRows::CsvRows(TextLines lines, const Reader& reader) : reader_(reader), lines_(std::move(lines)) {
  read_head();
  behind_head_ = lines_.place();
}

/// Goes to the next line that is neither blank nor a comment. Returns false at the end of the file.
bool CsvRows::next_line() {
  while (lines_.next_filled()) {
    if (!trimmed(lines_.text()).starts_with('#')) return true;
    if (columns_.empty()) comment_ = lines_.number();
  }
  return false;
}

void CsvRows::read_head() {
  bool found = next_line();
  // Some spreadsheets name the delimiter in a first line `sep=;`, which is not needed: the line of names
  // shows it.
  if (found && lines_.text().starts_with("sep=") && lines_.text().size() <= 5) found = next_line();
  if (!found)
    reader_.fail({1, 1},
                 fmt::format("the file is empty; its first line names the columns, of {}", all_names()));
  head_ = {lines_.number(), 1};
  parted_by_ = delimiter_of(trimmed(lines_.text()));
  std::vector<Cell> names;
  split(names);
  const auto is_name = [](const Cell& cell) { return !cell.text.empty() && !is_number(cell.text); };
  if (std::ranges::none_of(names, is_name)) fail_names(names.front());
  for (const Cell& name : names) columns_.push_back(column_of(name));
}

void CsvRows::fail_names(const Cell& name) const {
  reader_.fail(
      name.mark,
      fmt::format("the first line must name the columns, of {}; this one has no names{}", all_names(),
                  comment_ > 0 ? fmt::format(" (if line {} has them, take its # away)", comment_) : ""));
}

/// Returns the column of a name. A name that means nothing to scree makes a column that is ignored; a name
/// that means something, but is not spelt as in BodyColumn, is an error.
RowColumn CsvRows::column_of(const Cell& name) const {
  RowColumn column{.name = std::string(name.text), .mark = name.mark, .column = column_called(name.text)};
  if (column.column) return column;
  const std::string_view advice = advice_for("column", name.text);
  const std::string_view meant = misspelt(name.text);
  if (advice.empty() && meant.empty()) return column;
  reader_.fail(name.mark, fmt::format("unknown column {}{}", name.text.substr(0, longest_told),
                                      advice.empty() ? fmt::format(" (did you mean {}?)", meant)
                                                     : fmt::format("; {}", advice)));
}

/// Returns the cell in quotes that starts at `at`, and moves `at` behind it. Two quotes within the cell stand
/// for one (RFC 4180, section 2.7).
Cell CsvRows::quoted_cell(std::size_t& at) {
  std::string& line = lines_.text();
  const std::size_t start = ++at;
  std::size_t end = start;
  for (;; ++at) {
    if (at == line.size()) lines_.fail("the quotes are not closed on their line", static_cast<int>(start));
    if (line[at] == '"' && (at + 1 == line.size() || line[at + 1] != '"')) break;
    at += line[at] == '"';
    line[end++] = line[at];
  }
  ++at;
  return {std::string_view(line).substr(start, end - start), {lines_.number(), static_cast<int>(start)}};
}

void CsvRows::split(std::vector<Cell>& cells) {
  const std::string_view line = lines_.text();
  cells.clear();
  if (parted_by_ == ' ') return split_at_blanks(line, lines_.number(), cells);
  const auto skip_blanks = [&](std::size_t at) {
    while (at < line.size() && (line[at] == ' ' || (line[at] == '\t' && parted_by_ != '\t'))) ++at;
    return at;
  };
  for (std::size_t at = 0;;) {
    at = skip_blanks(at);
    if (at < line.size() && line[at] == '"') {
      cells.push_back(quoted_cell(at));
      at = skip_blanks(at);
      if (at < line.size() && line[at] != parted_by_)
        lines_.fail("there is text behind the quotes that close a cell", static_cast<int>(at) + 1);
    } else {
      const std::size_t end = std::min(line.find(parted_by_, at), line.size());
      cells.push_back({trimmed(line.substr(at, end - at)), {lines_.number(), static_cast<int>(at) + 1}});
      at = end;
    }
    if (at >= line.size()) return;
    ++at;
  }
}

bool CsvRows::next(std::vector<Cell>& row) {
  const auto is_empty = [](const Cell& cell) { return cell.text.empty(); };
  do {
    if (!next_line()) return false;
    split(row);
  } while (std::ranges::all_of(row, is_empty));
  // Empty cells beyond the last column are dropped, and missing cells of last columns without a name are
  // added, because nothing is lost by it.
  const auto given = static_cast<std::ptrdiff_t>(row.size());
  while (row.size() > columns_.size() && row.back().text.empty()) row.pop_back();
  while (row.size() < columns_.size() && columns_[row.size()].name.empty())
    row.push_back({{}, {lines_.number(), 1}});
  if (row.size() != columns_.size())
    lines_.fail(fmt::format("has {} cells; the header names {} columns", given, columns_.size()));
  return true;
}

}  // namespace scree
