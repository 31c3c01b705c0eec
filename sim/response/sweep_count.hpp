// The adaptive number of sweeps of a heap. It follows what the sweeps of the last substeps left residual.
#pragma once

#include "core/archive.hpp"

#include <algorithm>

namespace scree::solver {

/// A sweep changes little in the slow modes of a heap of many layers, so the change of the impulses does not
/// show whether these modes have converged. The residual power does: it is the power of the normal impulses
/// on the relative velocities that they leave, and it is compared with the power of all impulses on all that
/// they change (docs/decisions/0024, 0029). Where bodies slide on one another some power is always residual:
/// a few hundredths of what is dissipated. In a slow mode it is a third and more (0046).
class SweepCount {
 public:
  /// The least number of sweeps of the next substep. `usual` is the number of plan_sweeps(), `shared` says
  /// that bodies share several contact points, and `share` is the length of the substep in steps.
  int sweeps(int usual, bool shared, double share);

  /// Is called after each substep, with the residual power, the power of all impulses and the dissipated
  /// power, each times the length of the substep (J).
  void judge(double residual, double kicked, double dissipated);

  /// Is called after the position correction of each substep. `mean`: mean overlap that the substep has left
  /// to the correction, over the contacts that overlap, as a share of the smaller body's size. What the
  /// correction leaves shows less of the error of the impulses, the better the correction is.
  void judge_overlap(double mean) { overlap_ = std::max(overlap_, mean); }

  /// Whether bodies slide on others in places, or land on them without bouncing off: contacts dissipate more
  /// than tolerance::moving_power of the power of their impulses.
  bool moves() const { return moves_; }
  /// Whether the heap flows: it dissipates more than tolerance::flowing_power of the power of its impulses.
  bool flows() const { return flows_; }
  /// The tolerance of the sweeps: they end when one changes the impulses by no more than this share of their
  /// size. It is larger while the heap flows and hardly overlaps before it is corrected.
  double change() const;
  /// Whether the slow modes have converged, so that the least number of sweeps will do.
  bool needs_least_sweeps() const { return degree_ == 0; }

  void archive(Archive& archive) {
    archive("degree", degree_);
    archive("residual", residual_);
    archive("kicked", kicked_);
    archive("dissipated", dissipated_);
    archive("moves", moves_);
    archive("flows", flows_);
    archive("judged", judged_);
    archive("tolerance_exponent", tolerance_exponent_);
    archive("overlap", overlap_);
  }

 private:
  int next_tolerance_exponent() const;

  int degree_ = 2;  // degrees 0, 1, 2, 3... are 2, 3, 6, 12... sweeps for balls
  bool moves_ = false, flows_ = false;
  double residual_ = 0, kicked_ = 0, dissipated_ = 0;
  int judged_ = 0;              // substeps since the sums were last reset
  double overlap_ = 0;          // largest mean overlap in these substeps
  int tolerance_exponent_ = 0;  // change() is 2^tolerance_exponent_ times that at rest
};

}  // namespace scree::solver
