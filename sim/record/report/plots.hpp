// Plots of curves over time, drawn by gnuplot.
#pragma once

#include "sim/record/report/columns.hpp"

#include <string>
#include <vector>

namespace scree::report {

struct Curve {
  std::string title;
  Column values;  ///< a value for each time; NaN where there is none
};

struct Plot {
  std::string title;
  std::string unit;             ///< quantity and unit of all curves
  bool is_logarithmic = false;  ///< whether the values have a logarithmic axis, which shows positive ones
  std::vector<Curve> curves = {};
  Column time = {};  ///< s
};

/// Returns the rows to draw, at most `most`, which give the same picture as all of them. If there are more
/// rows, they are cut into runs, and the rows with the least and the greatest value of each run are drawn, so
/// that no spike is lost.
std::vector<std::size_t> rows_to_draw(const Column& values, std::size_t most);

/// Returns the SVG of each plot. Throws RunError if gnuplot is not installed, or fails.
std::vector<std::string> draw(const std::vector<Plot>& plots);

}  // namespace scree::report
