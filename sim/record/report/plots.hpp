// Curves over time, drawn by gnuplot.
#pragma once

#include "sim/record/report/columns.hpp"

#include <string>
#include <vector>

namespace scree::report {

struct Curve {
  std::string title;
  Column values;  ///< one for each time; NaN where there is none
};

struct Plot {
  std::string title;
  std::string unit;             ///< of all its curves
  bool is_logarithmic = false;  ///< what is not positive is not drawn
  std::vector<Curve> curves = {};
  Column time = {};  ///< s
};

/// The rows that a picture shows as well as all of them: where there are many, of each run of rows those with
/// the least and the greatest value, so that no spike is lost.
std::vector<std::size_t> rows_to_draw(const Column& values, std::size_t most);

/// The SVG of each plot. Throws RunError if gnuplot is not installed, or fails.
std::vector<std::string> draw(const std::vector<Plot>& plots);

}  // namespace scree::report
