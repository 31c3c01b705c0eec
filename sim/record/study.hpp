// A study of speed against error: one scene in many settings, with the errors and the cost of each.
#pragma once

#include "sim/record/checks.hpp"
#include "sim/scene/variations.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace scree {

/// One combination of settings.
struct StudyPoint {
  std::vector<Override> settings = {};
  std::vector<CheckResult> checks = {};  ///< results of the checks; none if the run failed
  std::string problem = {};              ///< the reason why the run failed
  double cost = 0;                       ///< wall time per simulated second; NaN if the run failed

  /// Returns the error of a check. It is infinite if the run failed, if the check could not be evaluated, or
  /// if gives_error() is false for it.
  double error(std::size_t check) const;
};

struct Study {
  std::string scene;
  std::vector<Variation> variations;
  std::vector<StudyPoint> points;  ///< points in the order of combinations()

  /// Returns the checks of the scene in words; none if every run failed.
  std::vector<std::string> checks() const;
  /// Whether the check has been evaluated in some run, and has no error all the same: gives_error() is false
  /// for it.
  bool has_no_error(std::size_t check) const;
};

/// Returns the points that no other point beats: none has less error at no more cost, nor less cost at no
/// more error. They are sorted by cost.
std::vector<std::size_t> pareto_front(const Study& study, std::size_t check);

/// The points that differ only in the first key, in the order of its values.
struct Curve {
  std::string settings;  ///< settings of the other keys, in words; empty if there are none
  std::vector<std::size_t> points;
};
std::vector<Curve> curves_of(const Study& study);

/// Returns the order of convergence: the slope of log error over log value of the first key, by least squares
/// over the points whose error is more than rounding. It is NaN with fewer than three such points, or if the
/// values are not numbers > 0.
double fitted_order(const Study& study, const Curve& curve, std::size_t check);

/// The cheapest point that reaches an error.
struct Reached {
  double error;       ///< the error, a power of ten
  std::size_t point;  ///< number of a point of the front
};
/// Returns the cheapest point for each power of ten that a point of the front reaches and the cheaper ones do
/// not.
std::vector<Reached> cheapest_to(const Study& study, std::size_t check);

/// Returns a table with a row for each combination: settings, cost, and the error of each check.
std::string to_csv(const Study& study);
std::string to_json(const Study& study);

/// Returns a gnuplot script that draws NAME.svg and NAME.png: error over cost, a line for each curve, the
/// front.
std::string plot_script(const Study& study, std::size_t check, const std::string& name);

}  // namespace scree
