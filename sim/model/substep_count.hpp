// How many substeps the next step is taken in, where the scene leaves it open.
#pragma once

#include "core/archive.hpp"
#include "core/tolerances.hpp"

#include <algorithm>

namespace scree {

/// Overlaps of a state, of the smaller body's smallest_size: the mean over the pairs that overlap, and the
/// deepest.
struct OverlapsLeft {
  double mean = 0, worst = 0;

  bool exceed(double mean_bound, double worst_bound) const {
    return mean > mean_bound || worst > worst_bound;
  }
};

/// Most substeps that a step takes by itself. Overlaps fall with the square of their length, and so this
/// grows with the square root of `quality` (ResponseParameters::quality), in powers of two.
inline int most_substeps(double quality) {
  int most = tolerance::most_substeps;
  for (; quality >= 4; quality /= 4) most *= 2;
  for (; quality <= 0.25 && most > 1; quality *= 4) most /= 2;
  return most;
}

/// With few contacts it follows the deepest overlap that a substep left to the position correction. Of a
/// heap that overlap is an extreme of many, most of which the correction parts. There it follows the overlaps
/// that are left at the end of steps, and these are measured: at every eighth step, and only while a substep
/// leaves deep ones to the correction (docs/decisions/0055).
class SubstepCount {
 public:
  explicit SubstepCount(double quality = 1) : quality_(quality) {}

  int next() const { return next_; }

  /// After a step of `taken` substeps with few contacts, the deepest overlap of which, before position
  /// correction, was `deepest` (of the smaller smallest_size).
  void judge(int taken, double deepest) {
    if (deepest > tolerance::substep_overlap / quality_) {
      refine(taken);
    } else if (deepest < tolerance::coarser_overlap / quality_ ||
               ++shallow_steps_ >= tolerance::wedged_steps) {
      coarsen(taken);
    }
  }

  /// The same after a step with a heap. `measure()` gives the OverlapsLeft at the end of the step.
  template <class Measure>
  void judge_heap(int taken, double deepest, const Measure& measure) {
    if (deepest > tolerance::heap_substep_overlap / quality_) return refine(taken);
    if (deepest < tolerance::coarser_overlap / quality_) {
      coarsen(taken);
      looks_to_try_ = looks_together;
      return;
    }
    if (++steps_ % steps_a_look != 0) return;
    const double mean = tolerance::mean_overlap_left / quality_;
    const double worst = tolerance::worst_overlap_left / quality_;
    const OverlapsLeft left = measure();
    if (left.exceed(2 * mean, 2 * worst)) return refine(taken);
    seen_.mean += left.mean / looks_together;
    seen_.worst += left.worst / looks_together;
    if (++looks_ % looks_together != 0) return;
    const OverlapsLeft seen = seen_;
    seen_ = {};
    if (seen.exceed(mean, worst)) return refine(taken);
    if (taken == 1 || seen.exceed(tried_from * mean, tried_from * worst) || looks_ < looks_to_try_) return;
    coarsen(taken);
    is_tried_ = true;
  }

  void archive(Archive& archive) {
    archive("next", next_);
    archive("shallow_steps", shallow_steps_);
    archive("steps", steps_);
    archive("looks", looks_);
    archive("looks_to_try", looks_to_try_);
    archive("is_tried", is_tried_);
    archive("mean_seen", seen_.mean);
    archive("worst_seen", seen_.worst);
  }

 private:
  // Larger: the number follows later, and single looks matter less.
  static constexpr int steps_a_look = 8, looks_together = 4;
  // Half as many substeps are tried from this share of what may be left, after this many looks at last.
  static constexpr double tried_from = 0.75;
  static constexpr int most_looks = 64;

  void refine(int taken) {
    // What was tried and left too much is tried less often.
    if (is_tried_) looks_to_try_ = std::min(2 * looks_to_try_, most_looks);
    use(std::min(2 * taken, most_substeps(quality_)));
  }
  void coarsen(int taken) { use(std::max(taken / 2, 1)); }
  void use(int substeps) {
    next_ = substeps;
    shallow_steps_ = steps_ = looks_ = 0;
    seen_ = {};
    is_tried_ = false;
  }

  double quality_;
  int next_ = 1;
  int shallow_steps_ = 0;  // since it was last chosen
  // Of a heap, likewise:
  int steps_ = 0, looks_ = 0;
  OverlapsLeft seen_;  // the mean of the looks that are judged together, as far as they were taken
  int looks_to_try_ = looks_together;  // before fewer substeps are tried
  bool is_tried_ = false;              // this number, and was not found good yet
};

}  // namespace scree
