// The charts of a run: the curves of the quantities that its scene has.
#pragma once

#include "sim/record/report/columns.hpp"
#include "sim/record/report/plots.hpp"

#include <string>
#include <vector>

namespace scree::report {

struct Chart {
  Plot plot;
  std::string caption;  ///< text that says what the curves show
};

/// The charts of one subject.
struct Chapter {
  std::string title;
  std::vector<Chart> charts;
};

/// Makes the chapters. Curves that are zero throughout, or rounding compared with the largest one of their
/// chart, are left out, and so are charts without a curve and chapters without a chart.
std::vector<Chapter> chapters_of(const Columns& metrics, const WallTimes& wall);

}  // namespace scree::report
