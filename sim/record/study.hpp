// Speed against error: one scene in many settings, what each got wrong and what it cost.
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
  std::vector<CheckResult> checks = {};  ///< none if the run failed
  std::string problem = {};              ///< why it did
  double cost = 0;                       ///< wall time per simulated second; NaN if the run failed

  /// Infinite where the run failed, or the check could not be evaluated: a point outside.
  double error(std::size_t check) const;
};

struct Study {
  std::string scene;
  std::vector<Variation> variations;
  std::vector<StudyPoint> points;  ///< in the order of combinations()

  /// Of the scene, in words; none if every run failed.
  std::vector<std::string> checks() const;
};

/// Points that no other beats: none has less error at no more cost, nor less cost at no more error. By cost.
std::vector<std::size_t> pareto_front(const Study& study, std::size_t check);

/// Points that differ in the first key alone, in the order of its values.
struct Curve {
  std::string settings;  ///< of the other keys, in words; empty if there are none
  std::vector<std::size_t> points;
};
std::vector<Curve> curves_of(const Study& study);

/// Order of convergence: the slope of log error over log value of the first key, by least squares over the
/// points whose error is more than rounding. NaN with fewer than three, or if the values are no numbers > 0.
double fitted_order(const Study& study, const Curve& curve, std::size_t check);

/// The cheapest way to an error.
struct Reached {
  double error;       ///< a power of ten
  std::size_t point;  ///< of the front
};
/// For each power of ten that one point of the front reaches and the cheaper ones do not.
std::vector<Reached> cheapest_to(const Study& study, std::size_t check);

/// A row for each combination: settings, cost, and the error of each check.
std::string to_csv(const Study& study);
std::string to_json(const Study& study);

/// A gnuplot script that draws NAME.svg and NAME.png: error over cost, a line for each curve, the front.
std::string plot_script(const Study& study, std::size_t check, const std::string& name);

}  // namespace scree
