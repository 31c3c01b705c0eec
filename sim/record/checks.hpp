// The scene's own acceptance test, evaluated as the run goes on.
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

/// Access to the present state. What is not asked for is not computed: `overlaps` cost a narrow phase.
struct Probe {
  std::function<const Observation&(bool overlaps)> observe;
  std::function<BodyState(std::int32_t)> body;

  double value(const Measure& measure) const;
};

/// of_seeds: a single run cannot tell; see pooled().
enum class Verdict { passed, failed, not_evaluated, of_seeds };

/// What could not be evaluated has not passed.
inline bool is_failure(Verdict verdict) {
  return verdict == Verdict::failed || verdict == Verdict::not_evaluated;
}

/// How one check came out.
struct CheckResult {
  std::string check;                      ///< in words: "max of penetration.max over 1 to 6"
  std::string expected;                   ///< in words: "1.428571", "below 1e-05"
  std::optional<double> tolerance = {};   ///< absolute, in the unit of `measured`
  double measured = 0;                    ///< NaN if not evaluated
  std::optional<double> half_width = {};  ///< of the confidence interval about `measured`
  double margin = 0;  ///< to the nearest limit, in the unit of `measured`; negative: beyond it
  /// How far from ideal, in the unit of `measured`: from what is expected; if that is only `below`, from 0;
  /// if only `above`, what is missing. NaN if not evaluated.
  double error = 0;
  Verdict verdict = Verdict::not_evaluated;
  std::string problem = {};  ///< why it could not be evaluated
};

/// The values of one measure, reduced as they come.
class Series {
 public:
  Series() = default;
  Series(Reduce reduce, double level) : reduce_(reduce), level_(level) {}

  void add(double time, double value);
  std::int64_t count() const { return count_; }
  /// NaN if there was no value.
  double result() const;
  /// Time of the first value that was NaN or infinite.
  std::optional<double> bad_time() const { return bad_time_; }

 private:
  Reduce reduce_ = Reduce::none;
  double level_ = 0;
  std::int64_t count_ = 0;
  double first_ = 0, latest_ = 0, min_ = 0, max_ = 0, sum_ = 0;
  int side_ = 0;  ///< of the level on which the last value that was off it lay
  std::int64_t crossings_ = 0;
  std::optional<double> bad_time_;
};

class Checks {
 public:
  /// Throws InputError if a measure does not exist in the scene.
  Checks(const Scene& scene, const TimeGrid& grid);

  /// To be called after every step, and at step 0; asks of the probe only what a check needs there.
  void record(std::int64_t step, const Probe& probe);

  /// One for each check of the scene, in order. A check whose time the run did not reach, or whose values are
  /// not all finite, has not been evaluated, which is not a pass. `energy_scale` is that of the whole run
  /// (J).
  std::vector<CheckResult> results(double energy_scale) const;
  void archive(Archive& archive);

 private:
  struct Watch {
    Check check;
    Measure measure;
    std::int64_t first, last;  ///< steps that count; none if first > last
    bool within_run;           ///< false: asks for a time after the end
    Series series;
  };
  static CheckResult judge(const Watch& watch, double energy_scale);

  TimeGrid grid_;
  std::vector<Watch> watches_;
};

/// The results of an ensemble's runs, each of all checks, as one: of a check with a confidence the mean of
/// the runs and its interval by Student's t, of others the run with the least margin; where some run could
/// not evaluate a check, that.
std::vector<CheckResult> pooled(const std::vector<Check>& checks,
                                const std::vector<std::vector<CheckResult>>& runs);

}  // namespace scree
