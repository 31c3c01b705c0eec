// The checks of a scene, which are evaluated during the run.
#pragma once

#include "core/archive.hpp"
#include "sim/scene/measure.hpp"
#include "sim/scene/scene.hpp"
#include "sim/scene/time_grid.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace scree {

/// Access to the present state. Only what is requested is computed: `overlaps` need a narrow phase.
struct Probe {
  std::function<const Observation&(bool overlaps)> observe;
  std::function<BodyState(std::int32_t)> body;

  double value(const Measure& measure) const;
};

/// The outcome of a check. not_evaluated: its values are not finite, or no step lies in its interval.
/// not_reached: the run stopped before its time. of_seeds: a single run cannot decide it; see pooled().
enum class Verdict { passed, failed, not_evaluated, not_reached, of_seeds };

/// Whether the check fails the run: one that could not be evaluated, or was not reached, has not passed.
inline bool is_failure(Verdict verdict) {
  return verdict == Verdict::failed || verdict == Verdict::not_evaluated || verdict == Verdict::not_reached;
}

/// Whether a check says which value would be exact: the one that it expects, or 0 if it has `below` alone. A
/// check with `above` and no expected value does not.
inline bool gives_error(const Check& check) { return check.expect || (check.below && !check.above); }

/// The result of one check.
struct CheckResult {
  std::string check;                      ///< the check in words: "max of penetration.max over 1 to 6"
  std::string expected;                   ///< the expectation in words: "1.428571", "below 1e-05"
  std::optional<double> tolerance = {};   ///< absolute tolerance, in the unit of `measured`
  double measured = 0;                    ///< measured value; NaN if not evaluated
  std::optional<double> half_width = {};  ///< half width of the confidence interval about `measured`
  double margin = 0;  ///< distance to the nearest limit, in the unit of `measured`; negative beyond it
  /// Distance from the exact value, in the unit of `measured`. NaN if the check was not evaluated, or if
  /// gives_error() is false for it.
  double error = 0;
  Verdict verdict = Verdict::not_evaluated;
  std::string problem = {};  ///< the reason why the check could not be evaluated
};

/// The reduction of the values of one measure, updated with each value.
class Series {
 public:
  Series() = default;
  Series(Reduce reduce, double level) : reduce_(reduce), level_(level) {}

  void add(double time, double value);
  std::int64_t count() const { return count_; }
  /// Returns the reduced value; NaN if there was no value.
  double result() const;
  /// Returns the time of the first value that was NaN or infinite.
  std::optional<double> bad_time() const { return bad_time_; }

 private:
  Reduce reduce_ = Reduce::none;
  double level_ = 0;
  std::int64_t count_ = 0;
  double first_ = 0, latest_ = 0, min_ = 0, max_ = 0, sum_ = 0;
  int side_ = 0;  ///< side of the level on which the last value lay that was not on the level
  std::int64_t crossings_ = 0;
  std::optional<double> bad_time_;
};

class Checks {
 public:
  /// Throws InputError if a measure does not exist in the scene.
  Checks(const Scene& scene, const TimeGrid& grid);

  /// Must be called at step 0 and after every step. Requests from the probe only what a check needs then.
  void record(std::int64_t step, const Probe& probe);

  /// Returns a result for each check of the scene, in order. `energy_scale` is that of the whole run (J).
  std::vector<CheckResult> results(double energy_scale) const;
  void archive(Archive& archive);

 private:
  struct Watch {
    Check check;
    Measure measure;
    std::int64_t first, last;  ///< first and last step that count; none counts if first > last
    bool within_run;           ///< whether its time is not after the scene's end
    Series series;
  };
  static CheckResult judge(const Watch& watch, double energy_scale);

  TimeGrid grid_;
  std::vector<Watch> watches_;
};

/// Combines the results of an ensemble's runs, each of which has a result for every check, into one result
/// for each check. A check with a confidence gets the mean of the runs and its interval by Student's t,
/// another one the result of the run with the least margin. If a run could not evaluate a check, the result
/// is that of this run.
std::vector<CheckResult> pooled(const std::vector<Check>& checks,
                                const std::vector<std::vector<CheckResult>>& runs);

}  // namespace scree
