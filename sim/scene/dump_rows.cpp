#include "sim/scene/dump_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <utility>

namespace scree {
namespace {

constexpr std::string_view timestep = "ITEM: TIMESTEP", atoms = "ITEM: ATOMS";

struct Name {
  std::string_view name;
  BodyColumn column;
  double scale = 1;
};

constexpr Name names[] = {
    {"x", BodyColumn::x},       {"y", BodyColumn::y},           {"z", BodyColumn::z},
    {"xu", BodyColumn::x},      {"yu", BodyColumn::y},          {"zu", BodyColumn::z},
    {"vx", BodyColumn::vx},     {"vy", BodyColumn::vy},         {"vz", BodyColumn::vz},
    {"omegax", BodyColumn::wx}, {"omegay", BodyColumn::wy},     {"omegaz", BodyColumn::wz},
    {"quatw", BodyColumn::qw},  {"quati", BodyColumn::qx},      {"quatj", BodyColumn::qy},
    {"quatk", BodyColumn::qz},  {"radius", BodyColumn::radius}, {"diameter", BodyColumn::radius, 0.5},
    {"mass", BodyColumn::mass},
};

/// Names of the columns that only `scree export` writes; its sizes are twice those in its XYZ files.
constexpr Name own_names[] = {
    {"type", BodyColumn::shape},
    {"shapex", BodyColumn::size_x, 0.5},
    {"shapey", BodyColumn::size_y, 0.5},
    {"shapez", BodyColumn::size_z, 0.5},
};

/// Names of positions as shares of the cell, as the dump style `atom` has them.
constexpr std::string_view scaled[] = {"xs", "ys", "zs", "xsu", "ysu", "zsu"};

double number_of(std::string_view text, const TextLines& lines) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) lines.fail("must be the bounds of the box");
  return value;
}

}  // namespace

DumpRows::DumpRows(TextLines lines, std::optional<std::int64_t> frame, const Reader& reader)
    : FrameRows(std::move(lines), reader) {
  Head chosen;
  std::int64_t frames = 0;
  for (; lines_.next_filled(); ++frames) {
    Head head = read_head();
    skip(head.frame);
    if (!frame || frames == *frame) chosen = std::move(head);
  }
  require_frame(frame, frames);
  head_ = chosen.mark;
  if (!chosen.units.empty() && chosen.units != "si")
    notes_.push_back(fmt::format("says that its units are {}; its numbers are taken as SI", chosen.units));
  read_names(chosen);
  choose(chosen.frame);
}

std::string_view DumpRows::next_value() {
  if (!lines_.next()) lines_.fail("the file ends within a frame");
  return trimmed(lines_.text());
}

/// Reads the head of a frame, from the current line to the line that names the columns.
DumpRows::Head DumpRows::read_head() {
  Head head;
  std::optional<std::int64_t> rows;
  if (trimmed(lines_.text()) != timestep) lines_.fail(fmt::format("must be {}", timestep));
  for (std::string_view line = timestep; !line.starts_with(atoms); line = next_value()) {
    if (line == timestep || line == "ITEM: TIME") {
      next_value();
    } else if (line == "ITEM: UNITS") {
      head.units = next_value();
    } else if (line == "ITEM: NUMBER OF ATOMS") {
      rows = count_of(next_value(), "the number of atoms");
    } else if (line.starts_with("ITEM: BOX BOUNDS")) {
      head.is_oblique =
          line.find("xy") != std::string_view::npos || line.find("abc") != std::string_view::npos;
      read_box(head);
    } else {
      lines_.fail("is no item of a dump that scree knows");
    }
  }
  if (!rows) lines_.fail("ITEM: NUMBER OF ATOMS must come before the atoms");
  head.names = lines_.text();
  head.mark = {lines_.number(), 1};
  head.frame = {*rows, lines_.place()};
  return head;
}

void DumpRows::read_box(Head& head) {
  std::vector<Cell> ends;
  for (std::size_t a = 0; a < 3; ++a) {
    next_value();
    split_at_blanks(lines_.text(), lines_.number(), ends);
    if (ends.size() < 2) lines_.fail("must be the bounds of the box");
    head.low[a] = number_of(ends[0].text, lines_);
    head.high[a] = number_of(ends[1].text, lines_);
  }
}

bool DumpRows::has(BodyColumn column) const {
  return std::ranges::any_of(columns_, [&](const RowColumn& known) { return known.column == column; });
}

void DumpRows::read_names(const Head& head) {
  std::vector<Cell> cells;
  split_at_blanks(head.names, head.mark.line, cells);
  cells.erase(cells.begin(), cells.begin() + 2);  // the words ITEM: and ATOMS
  const auto is_there = [&](std::string_view name) {
    return std::ranges::any_of(cells, [&](const Cell& cell) { return cell.text == name; });
  };
  // Only columns of `scree export` have a radius beside the shape; LAMMPS's own ellipsoids have none.
  if (is_there("type") && is_there("radius") && is_there("shapex")) style_ = SizeStyle::ovito;
  for (const Cell& cell : cells) add(cell, head);
}

/// Adds the column of a name. Positions may be in the file more than once, in different forms; the first one
/// is used.
void DumpRows::add(const Cell& name, const Head& head) {
  std::string text(name.text);
  const auto is_it = [&](const Name& known) { return known.name == name.text; };
  const Name* known = std::ranges::find_if(names, is_it);
  if (known == std::end(names)) known = nullptr;
  if (style_ == SizeStyle::ovito) {
    if (text == "mobility") set_mobility(columns_.size());
    const Name* own = std::ranges::find_if(own_names, is_it);
    if (own != std::end(own_names)) known = own;
  } else if (text.starts_with("shape")) {
    reader_.fail(name.mark, fmt::format("{}: ellipsoids are not modelled", text));
  }
  if (known && !has(known->column)) return add_column(text, name.mark, known->column, known->scale);
  const auto share = static_cast<std::size_t>(std::ranges::find(scaled, name.text) - std::begin(scaled));
  const auto axis = share % 3;
  const BodyColumn place = after(BodyColumn::x, static_cast<int>(axis));
  if (share == std::size(scaled) || has(place)) return add_column(text, name.mark, {});
  if (head.is_oblique)
    reader_.fail(name.mark,
                 fmt::format("{}: shares of an oblique cell are not read; dump x y z, or xu yu zu", text));
  add_column(text, name.mark, place, head.high[axis] - head.low[axis], head.low[axis]);
}

}  // namespace scree
