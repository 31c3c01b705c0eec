#include "sim/scene/time_grid.hpp"

#include "core/tolerances.hpp"

#include <algorithm>
#include <cmath>

namespace scree {

namespace {

// In doubles, 3 * 0.1 exceeds 0.3. Rounding must not decide which steps there are.
constexpr double rounding = tolerance::step_count;

std::int64_t count_steps(const TimeSettings& time) {
  return static_cast<std::int64_t>(std::ceil(time.end / time.step * (1 - rounding)));
}

}  // namespace

TimeGrid::TimeGrid(const TimeSettings& time) : step_(time.step), end_(time.end), last_(count_steps(time)) {}

double TimeGrid::time(std::int64_t step) const {
  return step >= last_ ? end_ : static_cast<double>(step) * step_;
}

double TimeGrid::length(std::int64_t step) const {
  const double rest = end_ - static_cast<double>(step - 1) * step_;
  return rest < step_ * (1 - rounding * static_cast<double>(last_)) ? rest : step_;
}

std::int64_t TimeGrid::nearest(double t) const {
  const auto last = static_cast<double>(last_);
  const auto before = static_cast<std::int64_t>(std::clamp(std::floor(t / step_), 0.0, last));
  const std::int64_t after = std::min(before + 1, last_);
  return std::abs(time(after) - t) < std::abs(time(before) - t) ? after : before;
}

std::int64_t TimeGrid::first_in(double from) const {
  const std::int64_t near = nearest(from);
  return time(near) < from * (1 - rounding) ? near + 1 : near;
}

std::int64_t TimeGrid::last_in(double to) const {
  const std::int64_t near = nearest(to);
  return time(near) > to * (1 + rounding) ? near - 1 : near;
}

TimeGrid::Steps TimeGrid::steps_in(const TimeSpan& span) const {
  return {nearest(span.from), contains(span.until) ? nearest(span.until) : last_ + 1};
}

bool TimeGrid::contains(double t) const { return t <= end_ * (1 + rounding); }

std::int64_t Cadence::due(std::int64_t step) {
  const bool repeats = period_ > 0 && std::isfinite(period_);
  std::int64_t count = 0;
  for (;; ++next_, ++count) {
    if (next_ > 0 && !repeats) return count;
    const double time = start_ + static_cast<double>(next_) * (repeats ? period_ : 0.0);
    if (!grid_.contains(time) || grid_.nearest(time) > step) return count;
  }
}

}  // namespace scree
