#include "sim/record/export_frame.hpp"

#include "core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace scree {

std::optional<std::size_t> ExportFrame::find(std::string_view name) const {
  const auto found = std::ranges::find(about, name, &TrajectoryColumn::name);
  if (found == about.end()) return std::nullopt;
  return static_cast<std::size_t>(found - about.begin());
}

std::size_t ExportFrame::require(std::string_view name) const {
  if (const auto found = find(name)) return *found;
  throw InputError(fmt::format("the trajectory has no {}", name));
}

Shape ExportFrame::shape(std::size_t column, std::size_t row) const {
  const double word = number(column, row);
  if (!(word <= static_cast<double>(Shape::polyhedron)))
    throw InputError(fmt::format("the trajectory has a shape {}, which this version does not know", word));
  return static_cast<Shape>(word);
}

ExportFrame read_export_frame(TrajectoryReader& trajectory, std::size_t frame) {
  const TrajectoryIndex& index = trajectory.index();
  ExportFrame columns{index.frames()[frame], index.columns(), {}};
  for (std::size_t c = 0; c < index.columns().size(); ++c)
    columns.numbers.push_back(trajectory.numbers(frame, c));
  return columns;
}

void append_number(std::string& text, double number, const FieldType& type) {
  const auto out = std::back_inserter(text);
  if (type.kind == FieldType::Kind::real && type.width == sizeof(float)) {
    fmt::format_to(out, "{}", static_cast<float>(number));
  } else {
    fmt::format_to(out, "{}", number);
  }
}

void append_row(std::string& text, const ExportFrame& frame, std::size_t column, std::size_t row,
                char separator) {
  const FieldType& type = frame.about[column].type;
  for (std::size_t k = 0; k < static_cast<std::size_t>(type.columns); ++k) {
    text += separator;
    append_number(text, frame.number(column, row, k), type);
  }
}

}  // namespace scree
