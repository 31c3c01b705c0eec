// ContactSolver::correct(): the position correction of a substep.
#include "core/parallel.hpp"
#include "core/space_phases.hpp"
#include "core/space_tiles.hpp"
#include "core/tolerances.hpp"
#include "sim/response/contact_solver.hpp"
#include "sim/response/contact_solver_loops.hpp"
#include "sim/response/sweep_loop.hpp"

namespace scree::solver {

template <class Space, class Real>
void ContactSolver<Space, Real>::find_end_gaps(const ConstBodyView& bodies) {
  for_balls("gaps.end", FindEndGapsOfBalls<Real>{store_.balls(), slots_.places(), bodies});
  for_points("gaps.end", FindEndGapsOfPoints<Real>{store_.points(), slots_.places_of_others(), bodies});
}

template <class Space, class Real>
Ledger ContactSolver<Space, Real>::correct(const FlightStage& flight, bool any_late_impact) {
  loads_.swap(next_loads_);
  overlap_ = tolerance::correction_cap * totals_.deepest;
  if (counts_.contacts == 0) return {};
  if (overlap_ == 0 && !any_late_impact) return {};
  find_end_gaps(read_only(flight.bodies));
  parallel::for_each<Space>("correction.start", displacement_.size(),
                            ResetDisplacement<Real>{solver_.view(), displacement_.view(), turn_.view()});
  const double quality = flight.parameters.quality;
  const CorrectionPlan plan = plan_correction(quality);
  const double left = store_.point_colors().colors() == 0 ? run_correction_phases<true>(plan)
                                                          : run_correction_phases<false>(plan);
  sweep_count_.judge_overlap(quality * left);
  const BodyView& bodies = flight.bodies;
  Array<Ledger, Space> total(1);
  parallel::sum_into<Ledger, Space>(
      "correction.apply", bodies.count(),
      Displace<Real>{displacement_.view(), turn_.view(), flight.parameters, bodies}, ledger_scratch_,
      total.data());
  Ledger ledger;
  copy_bytes<Host, Space>(&ledger, total.data(), sizeof(ledger));
  return ledger;
}

/// Returns the limits of the position correction. The deepest contact of a heap is one of many: sweeps over
/// all of them go on for its sake only as long as it is too deep to be left. The first sweeps of a heap are
/// plain, since these are cheaper and a heap at rest takes no others. With few contacts all are plain:
/// momentum may leave bodies further apart than they must be, and a stack with e = 1 then rests later.
template <class Space, class Real>
CorrectionPlan ContactSolver<Space, Real>::plan_correction(double quality) const {
  using namespace tolerance;
  constexpr int most = 100, most_of_heap = 60;
  if (!has_heap()) return {1, most, most, corrected_overlap, corrected_overlap, corrected_overlap, most};
  const bool shares = shares_loads(counts_.contacts, counts_.points);
  return {.least = shares || sweep_count_.needs_least_sweeps() ? 1 : 2,
          .usual = shares ? 24 : 12,
          .most = most_of_heap,
          .deepest = heap_overlap / quality,
          .mean = (shares ? shared_mean_overlap : heap_mean_overlap) / quality,
          .too_deep = worst_corrected_overlap / quality,
          .first_with_momentum = 2};
}

template <class Space, class Real>
template <bool only_balls>
double ContactSolver<Space, Real>::run_correction_phases(const CorrectionPlan& plan) {
  const CorrectionState done = parallel::run_in_phases<Space>(
      "correction",
      CorrectionPhases<Real, only_balls>{
          .ball_colors = ColorPhases(store_.ball_colors(), visit_width<Space>),
          .point_colors = ColorPhases(store_.point_colors(), visit_width<Space>),
          .balls = store_.balls(),
          .points = store_.points(),
          .displacements = {displacement_.data(), last_displacement_.data()},
          .turns = {turn_.data(), last_turn_.data()},
          .body_count = displacement_.size(),
          .shifted_hubs = join_hubs(displacement_),
          .turned_hubs = join_hubs(turn_),
          .guides = {guided_.view(), displacement_.data()},
          .share = static_cast<Real>(tolerance::correction_share),
          .first_with_momentum = plan.first_with_momentum,
          .least = plan.least,
          .usual = plan.usual,
          .most = plan.most,
          .deepest = static_cast<float>(plan.deepest / tolerance::correction_cap),
          .mean = static_cast<float>(plan.mean / tolerance::correction_cap),
          .too_deep = static_cast<float>(plan.too_deep / tolerance::correction_cap)},
      CorrectionState{});
  return tolerance::correction_cap * done.first;
}

#define SCREE_INSTANTIATE(Space)                                                   \
  template Ledger ContactSolver<Space, double>::correct(const FlightStage&, bool); \
  template Ledger ContactSolver<Space, float>::correct(const FlightStage&, bool);
SCREE_FOR_EACH_SPACE(SCREE_INSTANTIATE)

}  // namespace scree::solver
