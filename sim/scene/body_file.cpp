// Checks the columns of a body file as a whole, and reads its rows one after another.
#include "sim/scene/body_file.hpp"

#include "sim/scene/particle_kinds.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

namespace scree {
namespace {

namespace fs = std::filesystem;

constexpr std::array places = {BodyColumn::x, BodyColumn::y, BodyColumn::z};

}  // namespace

fs::path find_body_file(const fs::path& path) {
  const auto fail = [&](const std::string& what) {
    throw InputError(fmt::format("{} {}", path.string(), what));
  };
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status))
    fail(fmt::format("cannot be read: {}", std::strerror(error ? error.value() : ENOENT)));
  if (fs::is_directory(status)) {
    if (!fs::is_regular_file(path / "final.csv", error))
      fail("is a folder without final.csv, which a run writes when it is done");
    return path / "final.csv";
  }
  if (!fs::is_regular_file(status)) fail("is neither a file nor a folder");
  return path;
}

BodyFile::BodyFile(const fs::path& file, const BodyFileUse& use)
    : file_(file), reader_(file.string(), {}), use_(use), rows_(open_rows(file, use.frame, reader_)) {
  find_columns();
  find_shape();
  row_reader_.emplace(rows_->style(), use_, reader_);
  count_rows();
  for (const std::string& note : rows_->notes()) notes_.push_back(note);
  rows_->close();
  for (std::string& note : notes_) note = fmt::format("{} {}", file.string(), note);
}

void BodyFile::fail(BodyColumn column, const SourceMark& mark, std::string_view what) {
  const Reader::Step step(reader_, name_of(column));
  reader_.fail(mark, what);
}

bool BodyFile::has(BodyColumn column) const {
  return std::ranges::any_of(rows_->columns(), [&](const RowColumn& c) { return c.column == column; });
}

/// Returns where the column is named; if it is not, where the columns are named.
SourceMark BodyFile::mark_of(BodyColumn column) const {
  for (const RowColumn& known : rows_->columns())
    if (known.column == column) return known.mark;
  return rows_->head();
}

void BodyFile::find_columns() {
  std::vector<BodyColumn> seen;
  for (const RowColumn& known : rows_->columns()) {
    if (!known.column) continue;
    if (std::ranges::find(seen, *known.column) != seen.end())
      fail(*known.column, known.mark, "the column is there twice");
    seen.push_back(*known.column);
  }
  for (const BodyColumn column : places)
    if (!has(column)) fail(column, rows_->head(), "the column is missing; x, y and z are needed");
}

/// Finds the shape of the bodies if no column gives it: either the scene gives it, or only one shape has the
/// sizes that the file has.
void BodyFile::find_shape() {
  if (use_.shape) {
    check_shape_of_scene();
  } else if (!has(BodyColumn::shape)) {
    find_shape_by_sizes();
  }
}

/// Fails if the file has a shape, or sizes, which the scene gives already.
void BodyFile::check_shape_of_scene() {
  constexpr std::array sizes = {BodyColumn::radius, BodyColumn::size_x, BodyColumn::size_y,
                                BodyColumn::size_z, BodyColumn::hull};
  if (has(BodyColumn::shape))
    fail(BodyColumn::shape, mark_of(BodyColumn::shape),
         "the scene says the shape beside `file` already; leave out one of the two");
  for (const BodyColumn column : sizes)
    if (use_.has_sizes && has(column))
      fail(column, mark_of(column),
           fmt::format("the scene says the size beside `file` already; write `shape: {}` there",
                       word_of(*use_.shape)));
}

void BodyFile::find_shape_by_sizes() {
  const bool round = has(BodyColumn::radius), edges = has(BodyColumn::size_x) && has(BodyColumn::size_y),
             along = has(BodyColumn::size_z), hull = has(BodyColumn::hull);
  if (round && !edges && !along && !hull) use_.shape = Shape::sphere;
  if (!round && edges && along && !hull) use_.shape = Shape::box;
  if (!round && !edges && !along && hull) use_.shape = Shape::polyhedron;
  if (!use_.shape)
    fail(BodyColumn::shape, rows_->head(),
         round && along && !edges
             ? "the column is missing; write `shape: capsule` or `shape: cylinder` beside `file`"
             : "the column is missing; say what the bodies are beside `file`, as in `sphere: {radius: 0.1}`");
  notes_.push_back(
      fmt::format("does not name the shape; by its sizes each body is a {}", word_of(*use_.shape)));
}

void BodyFile::count_rows() {
  const std::vector<RowColumn>& columns = rows_->columns();
  std::vector<bool> is_used(columns.size());
  std::vector<Cell> row;
  while (rows_->next(row)) {
    ++count_;
    for (std::size_t k = 0; k < row.size(); ++k) is_used[k] = is_used[k] || !row[k].text.empty();
  }
  if (count_ == 0) reader_.fail(rows_->head(), "there are no bodies, only the names of the columns");
  note_ignored(is_used);
}

/// Notes the columns that mean nothing for a body, if any of their cells is filled.
void BodyFile::note_ignored(const std::vector<bool>& is_used) {
  constexpr std::size_t most_told = 8;
  std::vector<std::string> names;
  for (std::size_t k = 0; k < is_used.size(); ++k) {
    const RowColumn& column = rows_->columns()[k];
    if (!is_used[k] || column.column || column.is_for_source) continue;
    const std::string name = column.name.empty() ? "one without a name" : column.name;
    if (names.empty() || names.back() != name) names.push_back(name);
  }
  if (names.empty()) return;
  const std::size_t more = names.size() - std::min(names.size(), most_told);
  names.resize(names.size() - more);
  notes_.push_back(fmt::format("has columns that say nothing of a body and are ignored: {}{}",
                               fmt::join(names, ", "), more > 0 ? fmt::format(" and {} more", more) : ""));
}

void BodyFile::read(const std::function<void(const BodyRow&)>& take) {
  rows_->rewind();
  std::vector<Cell> row;
  std::int64_t rows = 0;
  while (rows_->next(row)) {
    if (++rows > count_) break;
    take(row_reader_->read(cells_of(row)));
  }
  if (rows != count_) reader_.fail(rows_->head(), "the file changed while it was read");
  rows_->close();
}

BodyCells BodyFile::cells_of(const std::vector<Cell>& row) const {
  BodyCells cells;
  cells.mark.fill({row.front().mark.line, 1});
  for (std::size_t k = 0; k < row.size(); ++k) {
    const RowColumn& about = rows_->columns()[k];
    if (!about.column) continue;
    const auto column = static_cast<std::size_t>(*about.column);
    cells.text[column] = row[k].text;
    cells.mark[column] = row[k].mark;
    cells.about[column] = &about;
  }
  return cells;
}

}  // namespace scree
