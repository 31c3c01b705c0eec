#include "sim/record/report/columns.hpp"

#include "sim/record/table.hpp"

#include <limits>

namespace scree::report {

namespace {
double value_of(std::string_view cell) {
  return number_in(cell).value_or(std::numeric_limits<double>::quiet_NaN());
}
}  // namespace

const Column* Columns::find(const std::string& name) const {
  const auto found = values.find(name);
  return found == values.end() ? nullptr : &found->second;
}

Columns read_columns(const std::filesystem::path& file) {
  Table table(file);
  Columns columns{table.columns(), {}};
  std::vector<Column*> in_order;
  for (const std::string& name : columns.names) in_order.push_back(&columns.values[name]);
  while (table.next())
    for (std::size_t c = 0; c < in_order.size(); ++c) in_order[c]->push_back(value_of(table.cell(c)));
  return columns;
}

WallTimes read_wall_times(const std::filesystem::path& timing) {
  const Columns columns = read_columns(timing);
  WallTimes times;
  const Column* time = columns.find("time");
  const Column* wall = columns.find("wall");
  if (time == nullptr || wall == nullptr) return times;
  // timing.csv has a row for each stage at each time.
  for (std::size_t k = 0; k < time->size(); ++k) {
    if (!times.time.empty() && times.time.back() == (*time)[k]) continue;
    times.time.push_back((*time)[k]);
    times.wall.push_back((*wall)[k]);
  }
  return times;
}

}  // namespace scree::report
