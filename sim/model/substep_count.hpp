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
      measurements_to_try_ = measured_together;
      return;
    }
    if (++steps_ % steps_between_measurements != 0) return;
    const double mean = tolerance::mean_overlap_left / quality_;
    const double worst = tolerance::worst_overlap_left / quality_;
    const OverlapsLeft left = measure();
    if (left.exceed(2 * mean, far_too_deep * worst)) return refine(taken);
    measured_.mean += left.mean / measured_together;
    measured_.worst = std::max(measured_.worst, std::min(left.worst, deepest_measured_));
    deepest_measured_ = std::max(deepest_measured_, left.worst);
    if (++measurements_ % measured_together != 0) return;
    const OverlapsLeft all = measured_;
    measured_ = {};
    deepest_measured_ = 0;
    if (all.exceed(mean, worst)) return refine(taken);
    if (taken == 1 || all.exceed(tried_from * mean, tried_from * worst) ||
        measurements_ < measurements_to_try_)
      return;
    coarsen(taken);
    is_tried_ = true;
  }

  void archive(Archive& archive) {
    archive("next", next_);
    archive("shallow_steps", shallow_steps_);
    archive("steps", steps_);
    archive("measurements", measurements_);
    archive("measurements_to_try", measurements_to_try_);
    archive("is_tried", is_tried_);
    archive("mean_measured", measured_.mean);
    archive("worst_measured", measured_.worst);
    archive("deepest_measured", deepest_measured_);
  }

 private:
  // Steps between two measurements, and measurements that are judged together. Larger: the number follows
  // later, and single measurements matter less.
  static constexpr int steps_between_measurements = 8, measured_together = 4;
  // Multiple of the bound on the worst overlap over which a single measurement decides. Of those judged
  // together, the one with the deepest overlap is left out: among millions of contacts a single one is deep
  // now and then, for a step or two, and to avoid it all bodies would have to take more substeps.
  static constexpr double far_too_deep = 5;
  // Half as many substeps are tried if the overlaps are under this share of the bounds, after
  // `measurements_to_try_` measurements, which are at most this many.
  static constexpr double tried_from = 0.75;
  static constexpr int most_measurements = 64;

  void refine(int taken) {
    // If fewer substeps were tried and left too much overlap, they are tried less often from now on.
    if (is_tried_) measurements_to_try_ = std::min(2 * measurements_to_try_, most_measurements);
    use(std::min(2 * taken, most_substeps(quality_)));
  }
  void coarsen(int taken) { use(std::max(taken / 2, 1)); }
  void use(int substeps) {
    next_ = substeps;
    shallow_steps_ = steps_ = measurements_ = 0;
    measured_ = {};
    deepest_measured_ = 0;
    is_tried_ = false;
  }

  double quality_;
  int next_ = 1;
  int shallow_steps_ = 0;  // steps since the number was last chosen that needed neither more nor fewer
  // For a heap, since the number was last chosen:
  int steps_ = 0, measurements_ = 0;
  // Of the measurements that are judged together, as far as they were taken:
  OverlapsLeft measured_;  // sum of their shares of the mean, and the second largest of their worst overlaps
  double deepest_measured_ = 0;                  // the largest of their worst overlaps
  int measurements_to_try_ = measured_together;  // measurements before fewer substeps are tried
  bool is_tried_ = false;                        // whether the present number is a try of fewer substeps
};

}  // namespace scree
