// The number of substeps of the next step, if the scene leaves it open.
#pragma once

#include "core/archive.hpp"
#include "core/tolerances.hpp"

#include <algorithm>

namespace scree {

/// Overlaps of a state (of the smaller body's smallest_size): the mean over the pairs that overlap, and the
/// deepest.
struct OverlapsLeft {
  double mean = 0, worst = 0;

  bool exceed(double mean_bound, double worst_bound) const {
    return mean > mean_bound || worst > worst_bound;
  }
};

/// Returns the largest number of substeps that a step takes by itself. Overlaps fall with the square of the
/// substep's length, and so this number grows with the square root of `quality`
/// (ResponseParameters::quality), in powers of two.
inline int most_substeps(double quality) {
  int most = tolerance::most_substeps;
  for (; quality >= 4; quality /= 4) most *= 2;
  for (; quality <= 0.25 && most > 1; quality *= 4) most /= 2;
  return most;
}

/// The choice of the number of substeps. With few contacts it follows the deepest overlap that a substep left
/// to the position correction. In a heap that overlap is an extreme of many, most of which the correction
/// removes. There the number follows the overlaps that are left at the end of steps. They are measured at
/// every eighth step, and only while a substep leaves deep ones to the correction (docs/decisions/0055).
class SubstepCount {
 public:
  explicit SubstepCount(double quality = 1) : quality_(quality) {}

  int next() const { return next_; }

  /// Chooses the number after a step of `taken` substeps with few contacts, whose deepest overlap before
  /// position correction was `deepest` (of the smaller smallest_size).
  void judge(int taken, double deepest) {
    if (deepest > tolerance::substep_overlap / quality_) {
      refine(taken);
    } else if (deepest < tolerance::coarser_overlap / quality_ ||
               ++shallow_steps_ >= tolerance::wedged_steps) {
      coarsen(taken);
    }
  }

  /// Chooses the number after a step with a heap. `measure()` returns the OverlapsLeft at the end of the
  /// step.
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
    if (left.exceed(2 * mean, far_too_deep * worst)) return refine(taken);
    seen_.mean += left.mean / looks_together;
    seen_.worst = std::max(seen_.worst, std::min(left.worst, deepest_seen_));
    deepest_seen_ = std::max(deepest_seen_, left.worst);
    if (++looks_ % looks_together != 0) return;
    const OverlapsLeft seen = seen_;
    seen_ = {};
    deepest_seen_ = 0;
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
    archive("deepest_seen", deepest_seen_);
  }

 private:
  // Steps between two measurements (looks), and looks that are judged together. Larger: the number follows
  // later, and single looks matter less.
  static constexpr int steps_a_look = 8, looks_together = 4;
  // Multiple of the bound on the worst overlap over which a single look decides. Of looks that are judged
  // together, the one with the deepest overlap is left out: among millions of contacts a single one is deep
  // now and then, for a step or two, and to avoid it all bodies would have to take more substeps.
  static constexpr double far_too_deep = 5;
  // Half as many substeps are tried if the overlaps are under this share of the bounds, after `looks_to_try_`
  // looks, which are at most this many.
  static constexpr double tried_from = 0.75;
  static constexpr int most_looks = 64;

  void refine(int taken) {
    // If fewer substeps were tried and left too much overlap, they are tried less often from now on.
    if (is_tried_) looks_to_try_ = std::min(2 * looks_to_try_, most_looks);
    use(std::min(2 * taken, most_substeps(quality_)));
  }
  void coarsen(int taken) { use(std::max(taken / 2, 1)); }
  void use(int substeps) {
    next_ = substeps;
    shallow_steps_ = steps_ = looks_ = 0;
    seen_ = {};
    deepest_seen_ = 0;
    is_tried_ = false;
  }

  double quality_;
  int next_ = 1;
  int shallow_steps_ = 0;  // steps since the number was last chosen that needed neither more nor fewer
  // For a heap, since the number was last chosen:
  int steps_ = 0, looks_ = 0;
  // Of the looks that are judged together, as far as they were taken:
  OverlapsLeft seen_;  // sum of their shares of the mean, and the second largest of their worst overlaps
  double deepest_seen_ = 0;            // the largest of their worst overlaps
  int looks_to_try_ = looks_together;  // looks before fewer substeps are tried
  bool is_tried_ = false;              // whether the present number is a try of fewer substeps
};

}  // namespace scree
