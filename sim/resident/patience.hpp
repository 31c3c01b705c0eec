// How often a heap is swept, by what its last substeps have left undone.
#pragma once

#include "core/archive.hpp"

#include <algorithm>

namespace scree::resident {

/// Sweeps see nothing of the slow modes of many layers. The power that normal impulses have on what they
/// leave undone does, beside that of all impulses on all they change (docs/decisions/0024, 0029). Where
/// bodies move on one another, some is always left undone, a few hundredths of what is dissipated; of a slow
/// mode it is a third and more (0046).
class Patience {
 public:
  /// Least sweeps of the next substep, which is a share of its step; `usual`: plan_sweeps()'s. `shared`:
  /// bodies share several points.
  int sweeps(int usual, bool shared, double share);

  /// After a substep: the powers (W), and what was dissipated.
  void judge(double undone, double kicked, double dissipated);

  /// And after its correction: what contacts then overlap by in the mean, of the smaller size.
  void see_overlap(double mean) { overlap_ = std::max(overlap_, mean); }

  /// The heap flows: what it dissipates is more than tolerance::flowing_power of the power of its impulses.
  bool flows() const { return flows_; }
  /// The change of the impulses by a sweep at which a heap's have converged, of their size. While it flows,
  /// and its contacts hardly overlap, that is more than at rest.
  double change() const;
  /// Nothing is left of slow modes.
  bool is_calm() const { return degree_ == 0; }

  void archive(Archive& archive) {
    archive("degree", degree_);
    archive("undone", undone_);
    archive("kicked", kicked_);
    archive("dissipated", dissipated_);
    archive("moves", moves_);
    archive("flows", flows_);
    archive("judged", judged_);
    archive("looseness", looseness_);
    archive("overlap", overlap_);
  }

 private:
  int next_looseness() const;

  int degree_ = 2;      // 0, 1, 2... are 2, 3, 6, 12... sweeps of balls
  bool moves_ = false;  // bodies slide on one another somewhere (tolerance::moving_power)
  bool flows_ = false;  // and nearly everywhere (tolerance::flowing_power)
  double undone_ = 0, kicked_ = 0, dissipated_ = 0;
  int judged_ = 0;      // substeps since it was last changed
  double overlap_ = 0;  // the largest mean overlap in these
  int looseness_ = 0;   // change() is 2^looseness times that at rest
};

}  // namespace scree::resident
