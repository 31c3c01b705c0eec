#include "sim/record/comparison.hpp"

#include "core/error.hpp"
#include "sim/record/table.hpp"
#include "sim/scene/reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>

namespace scree {

namespace {

namespace fs = std::filesystem;

constexpr double infinite = std::numeric_limits<double>::infinity();

/// A column that both tables have.
struct Common {
  std::size_t in_a, in_b;
  double scale = 0;
  ColumnDifference difference;

  void compare(std::string_view a, std::string_view b, std::int64_t row, std::string_view key) {
    const std::optional<double> number_a = number_in(a), number_b = number_in(b);
    double distance = 0;
    if (number_a && number_b && std::isfinite(*number_a) && std::isfinite(*number_b)) {
      distance = std::abs(*number_a - *number_b);
      scale = std::max({scale, std::abs(*number_a), std::abs(*number_b)});
    } else {
      const bool are_nan = number_a && number_b && std::isnan(*number_a) && std::isnan(*number_b);
      distance = a == b || are_nan ? 0 : infinite;
    }
    if (!(distance > difference.largest)) return;
    difference.largest = distance;
    difference.row = row;
    difference.key = key;
  }
};

/// Returns the columns that both tables have. Adds a line to `unlike` for each of the others.
std::vector<Common> common_columns(const Table& a, const Table& b, const std::string& name, Comparison& out) {
  std::vector<Common> common;
  for (std::size_t k = 0; k < a.columns().size(); ++k) {
    const std::string& column = a.columns()[k];
    if (const std::optional<std::size_t> other = b.find(column))
      common.push_back({k, *other, 0, {.column = name + ' ' + column}});
    else
      out.unlike.push_back(fmt::format("{} {}: only in the first run", name, column));
  }
  for (const std::string& column : b.columns()) {
    if (!a.find(column)) out.unlike.push_back(fmt::format("{} {}: only in the second run", name, column));
  }
  return common;
}

void compare_tables(const fs::path& file_a, const fs::path& file_b, Comparison& out) {
  Table a(file_a), b(file_b);
  const std::string name = file_a.filename().string();
  std::vector<Common> common = common_columns(a, b, name, out);
  std::int64_t row = 0;
  bool more_a = a.next(), more_b = b.next();
  for (; more_a && more_b; more_a = a.next(), more_b = b.next()) {
    ++row;
    for (Common& column : common) column.compare(a.cell(column.in_a), b.cell(column.in_b), row, a.cell(0));
  }
  if (more_a != more_b)
    out.unlike.push_back(
        fmt::format("{}: the {} run has more rows than {}", name, more_a ? "first" : "second", row));
  out.rows += row;
  out.columns += std::ssize(common);
  for (Common& column : common) {
    if (column.difference.largest == 0) continue;
    column.difference.relative = column.scale > 0 ? column.difference.largest / column.scale : infinite;
    out.differences.push_back(std::move(column.difference));
  }
}

}  // namespace

bool Comparison::differences_are_within(double relative, double absolute) const {
  return std::ranges::all_of(differences, [=](const ColumnDifference& difference) {
    return difference.relative <= relative || difference.largest <= absolute;
  });
}

bool Comparison::is_within(double relative, double absolute) const {
  return unlike.empty() && differences_are_within(relative, absolute);
}

Comparison compare_runs(const fs::path& a, const fs::path& b) {
  Comparison comparison;
  compare_tables(a / "metrics.csv", b / "metrics.csv", comparison);
  const bool final_a = fs::exists(a / "final.csv"), final_b = fs::exists(b / "final.csv");
  if (final_a && final_b) compare_tables(a / "final.csv", b / "final.csv", comparison);
  if (final_a != final_b)
    comparison.unlike.push_back(fmt::format("final.csv: only in the {} run", final_a ? "first" : "second"));
  return comparison;
}

}  // namespace scree
