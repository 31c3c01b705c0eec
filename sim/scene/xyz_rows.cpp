#include "sim/scene/xyz_rows.hpp"

#include "sim/scene/particle_kinds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <span>
#include <utility>

namespace scree {
namespace {

/// Returns the value of a key in a comment such as Lattice="1 0 0" Properties=pos:R:3, and where it starts;
/// nothing if the key is absent.
std::optional<std::pair<std::string_view, std::size_t>> value_of(std::string_view comment,
                                                                 std::string_view key) {
  for (std::size_t at = comment.find(key); at < comment.size(); at = comment.find(key, at + 1)) {
    if (at > 0 && comment[at - 1] != ' ' && comment[at - 1] != '\t') continue;
    std::size_t start = at + key.size();
    if (start >= comment.size() || comment[start] != '=') continue;
    ++start;
    const bool quoted = start < comment.size() && comment[start] == '"';
    start += quoted;
    const std::size_t end = std::min(comment.find_first_of(quoted ? "\"" : " \t", start), comment.size());
    return std::pair(comment.substr(start, end - start), start);
  }
  return {};
}

/// A property of extended XYZ and its meaning: consecutive columns of a body, from the first one on.
struct Property {
  std::string_view name;
  std::int64_t count;
  BodyColumn first;
  double scale = 1;
};

/// Properties as OVITO, ASE and scree name them. Their orientations are in the order x, y, z, w (OVITO's
/// manual, "Extended XYZ"), which add_property() handles by itself.
constexpr Property known_properties[] = {
    {"pos", 3, BodyColumn::x},
    {"position", 3, BodyColumn::x},
    {"velo", 3, BodyColumn::vx},
    {"vel", 3, BodyColumn::vx},
    {"velocity", 3, BodyColumn::vx},
    {"velocities", 3, BodyColumn::vx},
    {"angular_velocity", 3, BodyColumn::wx},
    {"radius", 1, BodyColumn::radius},
    {"diameter", 1, BodyColumn::radius, 0.5},
    {"mass", 1, BodyColumn::mass},
    {"masses", 1, BodyColumn::mass},
};

/// Properties that are known only in files of `scree export`; elsewhere they may mean anything.
constexpr Property own_properties[] = {
    {"type", 1, BodyColumn::shape},
    {"material", 1, BodyColumn::material},
    {"aspherical_shape", 3, BodyColumn::size_x},
};

const Property* find(std::span<const Property> table, std::string_view name, std::int64_t count) {
  const auto found = std::ranges::find_if(
      table, [&](const Property& known) { return known.name == name && known.count == count; });
  return found == table.end() ? nullptr : &*found;
}

}  // namespace

XyzRows::XyzRows(TextLines lines, std::optional<std::int64_t> frame, const Reader& reader)
    : FrameRows(std::move(lines), reader) {
  Frame chosen;
  std::string comment;
  SourceMark mark;
  std::int64_t frames = 0;
  for (; lines_.next_filled(); ++frames) {
    const std::int64_t rows = count_of(lines_.text(), "the number of particles");
    if (!lines_.next()) fail_short(0, rows);
    const Frame here{rows, lines_.place()};
    if (!frame || frames == *frame) {
      chosen = here;
      comment = lines_.text();
      mark = {lines_.number(), 1};
    }
    skip(here);
  }
  require_frame(frame, frames);
  head_ = mark;
  const auto types = value_of(comment, "types");
  is_own_ = types && types->first == particle_kinds;
  if (is_own_) style_ = SizeStyle::ovito;
  auto found = value_of(comment, "Properties");
  if (!found) found = value_of(comment, "properties");
  if (found) {
    mark.column = static_cast<int>(found->second) + 1;
    read_properties(found->first, mark);
  } else {
    count_plain_columns(chosen);
  }
  choose(chosen);
}

/// Reads the columns from name:type:count, again and again, separated by colons.
void XyzRows::read_properties(std::string_view properties, const SourceMark& mark) {
  constexpr std::int64_t most_columns = 1000;  // a line holds no more words
  std::vector<std::string_view> parts;
  for (std::size_t at = 0; at <= properties.size();) {
    const std::size_t end = std::min(properties.find(':', at), properties.size());
    parts.push_back(properties.substr(at, end - at));
    at = end + 1;
  }
  const auto fail = [&] { reader_.fail(mark, "Properties must be name:type:count, again and again"); };
  if (parts.size() % 3 != 0) fail();
  for (std::size_t k = 0; k < parts.size(); k += 3) {
    std::int64_t count = 0;
    const std::string_view text = parts[k + 2];
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
    if (error != std::errc{} || end != text.data() + text.size() || count < 1 || count > most_columns) fail();
    add_property(parts[k], count, mark);
  }
}

void XyzRows::add_property(std::string_view name, std::int64_t count, const SourceMark& mark) {
  if (name == "mobility" && count == 1 && is_own_) set_mobility(columns_.size());
  if (name == "orientation" && count == 4) {
    for (const BodyColumn column : {BodyColumn::qx, BodyColumn::qy, BodyColumn::qz, BodyColumn::qw})
      add_column(std::string(name), mark, column);
    return;
  }
  const Property* known = find(known_properties, name, count);
  if (!known && is_own_) known = find(own_properties, name, count);
  for (int k = 0; k < count; ++k)
    add_column(std::string(name), mark, known ? std::optional(after(known->first, k)) : std::nullopt,
               known ? known->scale : 1);
}

/// Makes the columns of a plain file: element, x, y, z, and, without a meaning, as many more as the first
/// particle has.
void XyzRows::count_plain_columns(const Frame& frame) {
  lines_.go_to(frame.place);
  std::vector<Cell> row;
  if (frame.rows > 0 && lines_.next()) split_at_blanks(lines_.text(), lines_.number(), row);
  add_column("element", head_, {});
  for (int k = 0; k < 3; ++k) add_column(std::string(1, "xyz"[k]), head_, after(BodyColumn::x, k));
  while (columns_.size() < row.size()) add_column(fmt::format("{}", columns_.size() + 1), head_, {});
}

}  // namespace scree
