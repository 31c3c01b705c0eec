// The instants of a run: which step is nearest to a time, and which steps lie in an interval.
#pragma once

#include "core/archive.hpp"
#include "sim/scene/scene.hpp"

#include <cstdint>

namespace scree {

class TimeGrid {
 public:
  explicit TimeGrid(const TimeSettings& time);

  /// Number of the last step; the state at t = 0 is step 0.
  std::int64_t last() const { return last_; }
  /// Time after a step (s); the last one ends at time.end exactly.
  double time(std::int64_t step) const;
  /// Length of a step, counted from 1: time.step, but for a last step that is shorter.
  double length(std::int64_t step) const;
  /// The step nearest to a time; of two as near, the earlier one. Times beyond the run give its first or last
  /// step.
  std::int64_t nearest(double time) const;
  /// First and last step in the closed interval [from, to]; the first is the greater where there is none.
  std::int64_t first_in(double from) const;
  std::int64_t last_in(double to) const;
  /// The steps k whose time lies in the span, first <= k < end: what the span is about is there in their
  /// states, and acts in the steps that follow them.
  struct Steps {
    std::int64_t first;
    std::int64_t end;
    bool holds(std::int64_t step) const { return first <= step && step < end; }
  };
  Steps steps_in(const TimeSpan& span) const;
  /// Whether a time is not after the end, but for rounding.
  bool contains(double time) const;

 private:
  double step_;
  double end_;
  std::int64_t last_;
};

/// Things that happen every `period` of simulated time, each at the step nearest to its time, from `start` on
/// (s).
class Cadence {
 public:
  /// A period of 0 or less, or an infinite one, happens at the start alone.
  Cadence(const TimeGrid& grid, double period, double start = 0)
      : grid_(grid), period_(period), start_(start) {}

  /// How many are due at a step, each counted once. Steps must come in ascending order.
  std::int64_t due(std::int64_t step);
  void archive(Archive& archive) { archive("next", next_); }

 private:
  TimeGrid grid_;
  double period_;
  double start_;
  std::int64_t next_ = 0;
};

}  // namespace scree
