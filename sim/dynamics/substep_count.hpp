// How many substeps the next step is taken in, where the scene leaves it open.
#pragma once

#include "core/archive.hpp"
#include "core/tolerances.hpp"

#include <algorithm>

namespace scree {

class SubstepCount {
 public:
  int next() const { return next_; }

  /// After a step of `taken` substeps, the deepest overlap of which was `overlap` (of the smaller
  /// smallest_size).
  void judge(int taken, double overlap) {
    if (overlap > tolerance::substep_overlap) {
      next_ = std::min(2 * taken, tolerance::most_substeps);
      shallow_steps_ = 0;
    } else if (overlap < tolerance::coarser_overlap || ++shallow_steps_ >= tolerance::wedged_steps) {
      next_ = std::max(taken / 2, 1);
      shallow_steps_ = 0;
    }
  }

  void archive(Archive& archive) {
    archive("next", next_);
    archive("shallow_steps", shallow_steps_);
  }

 private:
  int next_ = 1;
  int shallow_steps_ = 0;  // since it was last chosen
};

}  // namespace scree
