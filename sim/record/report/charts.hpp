// Which curves of a run are worth a look: those of what its scene has.
#pragma once

#include "sim/record/report/columns.hpp"
#include "sim/record/report/plots.hpp"

#include <string>
#include <vector>

namespace scree::report {

struct Chart {
  Plot plot;
  std::string caption;  ///< what is to be seen in it
};

/// Of a subject.
struct Chapter {
  std::string title;
  std::vector<Chart> charts;
};

/// Curves that are zero throughout are left out, or rounding beside the largest of their chart, charts
/// without a curve, and chapters without a chart.
std::vector<Chapter> chapters_of(const Columns& metrics, const WallTimes& wall);

}  // namespace scree::report
