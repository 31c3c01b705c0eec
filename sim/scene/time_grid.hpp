// The instants of a run: which step is nearest to a time, and which steps lie in an interval.
#pragma once

#include "core/archive.hpp"
#include "sim/scene/scene.hpp"

#include <cstdint>

namespace scree {

class TimeGrid {
 public:
  explicit TimeGrid(const TimeSettings& time);

  /// Returns the number of the last step; the state at t = 0 is step 0.
  std::int64_t last() const { return last_; }
  /// Returns the time after a step (s); the last step ends at time.end exactly.
  double time(std::int64_t step) const;
  /// Returns the length of a step (s): time.step, except for a last step that is shorter. The first step is
  /// step 1.
  double length(std::int64_t step) const;
  /// Returns the step nearest to a time; of two equally near steps, the earlier one. Times beyond the run
  /// give its first or last step.
  std::int64_t nearest(double time) const;
  /// Return the first and the last step in the closed interval [from, to]. If there is none, the first is
  /// greater than the last.
  std::int64_t first_in(double from) const;
  std::int64_t last_in(double to) const;
  /// The steps k whose time is in the span, first <= k < end. A body with this span exists in the states
  /// after these steps; a force with this span acts in the steps that follow them.
  struct Steps {
    std::int64_t first;
    std::int64_t end;
    bool holds(std::int64_t step) const { return first <= step && step < end; }
  };
  Steps steps_in(const TimeSpan& span) const;
  /// Returns whether a time is at most the end of the run, up to rounding.
  bool contains(double time) const;

 private:
  double step_;
  double end_;
  std::int64_t last_;
};

/// Events that happen every `period` of simulated time (s), from `start` on (s), each at the step nearest to
/// its time.
class Cadence {
 public:
  /// If the period is infinite, or 0 or less, there is one event, at the start.
  Cadence(const TimeGrid& grid, double period, double start = 0)
      : grid_(grid), period_(period), start_(start) {}

  /// Returns how many events are due at a step; each is counted once. Calls must be in ascending order of
  /// steps.
  std::int64_t due(std::int64_t step);
  void archive(Archive& archive) { archive("next", next_); }

 private:
  TimeGrid grid_;
  double period_;
  double start_;
  std::int64_t next_ = 0;
};

}  // namespace scree
