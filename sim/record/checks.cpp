#include "sim/record/checks.hpp"

#include "core/error.hpp"

#include <boost/math/distributions/students_t.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace scree {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// The words in the order of Reduce.
constexpr std::array<const char*, 7> reduce_words = {"",          "max of ",   "min of ",      "mean of ",
                                                     "drift of ", "range of ", "crossings of "};

std::string describe(const Check& check) {
  std::string words = reduce_words[static_cast<std::size_t>(check.reduce)] + check.measure;
  if (check.reduce == Reduce::crossings) words += fmt::format(" through {}", check.level);
  if (check.over) return words + fmt::format(" over {} to {}", (*check.over)[0], (*check.over)[1]);
  return words + (check.at ? fmt::format(" at {}", *check.at) : " at the end");
}

std::string describe_expectation(const Check& check) {
  std::string words;
  const auto add = [&words](const std::string& part) { words += (words.empty() ? "" : ", ") + part; };
  if (check.expect) add(fmt::format("{}", *check.expect));
  if (check.above) add(fmt::format("above {}", *check.above));
  if (check.below) add(fmt::format("below {}", *check.below));
  return words;
}

bool is_energy(const Measure& measure) { return measure.info->unit == "J"; }

/// Returns the larger of the tolerances given; without any it is 0, so that the value must be equal to the
/// bit.
double allowance(const Check& check, double unit) {
  return std::max(check.tolerance.value_or(0), check.relative.value_or(0) * unit);
}

/// Sets margin, error and verdict from the measured value, and from its confidence interval if it has one.
void decide(const Check& check, CheckResult& result) {
  double margin = std::numeric_limits<double>::infinity();
  bool passed = true;
  const double half_width = result.half_width.value_or(0);
  if (check.expect) {
    margin = *result.tolerance - std::abs(result.measured - *check.expect) - half_width;
    passed = margin >= 0;
  }
  const auto limit = [&](double slack) {
    margin = std::min(margin, slack - half_width);
    passed = passed && slack > half_width;
  };
  if (check.below) limit(*check.below - result.measured);
  if (check.above) limit(result.measured - *check.above);
  result.margin = margin;
  result.error = gives_error(check) ? std::abs(result.measured - check.expect.value_or(0)) : nan;
  result.verdict = passed ? Verdict::passed : Verdict::failed;
}

/// Returns half the width of the confidence interval of the mean of the distribution from which the values
/// are drawn, by Student's t.
double half_width_of_mean(const std::vector<double>& values, double mean, double confidence) {
  const auto n = static_cast<double>(values.size());
  double squares = 0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  const boost::math::students_t distribution(n - 1);
  return boost::math::quantile(distribution, 0.5 * (1 + confidence)) * std::sqrt(squares / (n * (n - 1)));
}

/// Returns the result of a check of the mean over all runs, of which each run is a sample.
CheckResult pooled_mean(const Check& check, const std::vector<CheckResult>& runs) {
  std::vector<double> values;
  double tolerance = 0;
  for (const CheckResult& run : runs) {
    values.push_back(run.measured);
    tolerance += run.tolerance.value_or(0);
  }
  const auto n = static_cast<double>(runs.size());
  CheckResult result = runs.front();
  result.measured = std::accumulate(values.begin(), values.end(), 0.0) / n;
  if (result.tolerance) result.tolerance = tolerance / n;
  result.half_width = half_width_of_mean(values, result.measured, *check.confidence);
  decide(check, result);
  return result;
}

}  // namespace

double Probe::value(const Measure& measure) const {
  static const Observation none;
  return evaluate(measure, measure.body >= 0 ? none : observe(is_of_overlaps(measure)), body);
}

void Series::add(double time, double value) {
  if (!std::isfinite(value)) {
    if (!bad_time_) bad_time_ = time;
    return;
  }
  if (count_++ == 0) first_ = min_ = max_ = value;
  latest_ = value;
  min_ = std::min(min_, value);
  max_ = std::max(max_, value);
  sum_ += value;
  // A value on the level is on neither side: a measure that touches the level and turns back does not cross
  // it.
  const int side = (value > level_) - (value < level_);
  if (side != 0 && side_ != 0 && side != side_) ++crossings_;
  if (side != 0) side_ = side;
}

double Series::result() const {
  if (count_ == 0) return nan;
  switch (reduce_) {
    case Reduce::none:
      break;
    case Reduce::max:
      return max_;
    case Reduce::min:
      return min_;
    case Reduce::mean:
      return sum_ / static_cast<double>(count_);
    case Reduce::drift:
      return std::max(max_ - first_, first_ - min_);
    case Reduce::range:
      return max_ - min_;
    case Reduce::crossings:
      return static_cast<double>(crossings_);
  }
  return latest_;
}

Checks::Checks(const Scene& scene, const TimeGrid& grid) : grid_(grid) {
  for (const Check& check : scene.checks) {
    const double from = check.over ? (*check.over)[0] : check.at.value_or(scene.time.end);
    const double to = check.over ? (*check.over)[1] : from;
    watches_.push_back({.check = check,
                        .measure = parse_measure(check.measure, scene),
                        .first = check.over ? grid.first_in(from) : grid.nearest(from),
                        .last = check.over ? grid.last_in(to) : grid.nearest(to),
                        .within_run = grid.contains(to),
                        .series = Series(check.reduce, check.level)});
  }
}

void Checks::record(std::int64_t step, const Probe& probe) {
  for (Watch& watch : watches_) {
    if (watch.first <= step && step <= watch.last) {
      watch.series.add(grid_.time(step), probe.value(watch.measure));
    }
  }
}

void Checks::archive(Archive& archive) {
  std::vector<Series> series;
  for (const Watch& watch : watches_) series.push_back(watch.series);
  archive("series", series);
  if (series.size() != watches_.size())
    throw InputError("the saved state has another number of checks than the scene");
  for (std::size_t k = 0; k < series.size(); ++k) watches_[k].series = series[k];
}

std::vector<CheckResult> Checks::results(double energy_scale) const {
  std::vector<CheckResult> results;
  for (const Watch& watch : watches_) results.push_back(judge(watch, energy_scale));
  return results;
}

CheckResult Checks::judge(const Watch& watch, double energy_scale) {
  const Check& check = watch.check;
  CheckResult result{.check = describe(check),
                     .expected = describe_expectation(check),
                     .tolerance = {},
                     .measured = nan,
                     .margin = nan,
                     .error = nan,
                     .verdict = Verdict::not_evaluated,
                     .problem = {}};
  if (!watch.within_run) {
    result.problem = "the scene ends before that";
  } else if (watch.first > watch.last) {
    result.problem = "no step in that interval";
  } else if (const auto time = watch.series.bad_time()) {
    result.problem = fmt::format("not a finite number at {} s", *time);
  } else if (watch.series.count() < watch.last - watch.first + 1) {
    result.verdict = Verdict::not_reached;
    result.problem = "the run stopped before that";
  }
  if (!result.problem.empty()) return result;

  // Energies have no natural zero, so relative tolerances of energies are relative to the run's energy scale.
  double unit = std::abs(check.expect.value_or(0));
  result.measured = watch.series.result();
  if (is_energy(watch.measure)) {
    const bool in_units_of_scale = check.reduce == Reduce::drift && result.measured != 0;
    if (in_units_of_scale) result.measured /= energy_scale;
    unit = check.reduce == Reduce::drift ? 1 : energy_scale;
  }

  if (check.expect) result.tolerance = allowance(check, unit);
  decide(check, result);
  if (check.confidence) result.verdict = Verdict::of_seeds;
  return result;
}

std::vector<CheckResult> pooled(const std::vector<Check>& checks,
                                const std::vector<std::vector<CheckResult>>& runs) {
  std::vector<CheckResult> results;
  for (std::size_t c = 0; c < checks.size(); ++c) {
    std::vector<CheckResult> of_check;
    for (const auto& run : runs) of_check.push_back(run[c]);
    const auto silent =
        std::ranges::find_if(of_check, [](const CheckResult& result) { return !result.problem.empty(); });
    if (silent != of_check.end()) {
      results.push_back(*silent);
    } else if (checks[c].confidence) {
      results.push_back(pooled_mean(checks[c], of_check));
    } else {
      results.push_back(*std::ranges::min_element(of_check, {}, &CheckResult::margin));
    }
  }
  return results;
}

}  // namespace scree
