// Contacts and their response with everything in one space: slots, contacts, sweeps, totals, correction.
#pragma once

#include "core/archive.hpp"
#include "core/array.hpp"
#include "core/bodies.hpp"
#include "sim/contacts/contact_accounts.hpp"
#include "sim/contacts/contact_finder.hpp"
#include "sim/contacts/contact_store.hpp"
#include "sim/contacts/rolling_visits.hpp"
#include "sim/contacts/slots.hpp"
#include "sim/contacts/sweeps.hpp"
#include "sim/contacts/visit_kernels.hpp"
#include "sim/laws/response_parameters.hpp"
#include "sim/observe/observation.hpp"
#include "sim/response/accuracy.hpp"
#include "sim/response/bodies.hpp"
#include "sim/response/contact_inspection.hpp"
#include "sim/response/contact_sums.hpp"
#include "sim/response/contacts_on_host.hpp"
#include "sim/response/direct.hpp"
#include "sim/response/direct_contact.hpp"
#include "sim/response/flights.hpp"
#include "sim/response/hubs.hpp"
#include "sim/response/island_sums.hpp"
#include "sim/response/rolling.hpp"
#include "sim/response/sweep_count.hpp"
#include "sim/response/sweep_plan.hpp"
#include "sim/response/wall_sums.hpp"

#include <cstdint>
#include <vector>

namespace scree::solver {

/// How often overlaps are swept: until the deepest and their mean are no more than this (of the smaller
/// smallest_size), but no more than `usual` times, unless the deepest is more than `too_deep` then.
struct CorrectionPlan {
  int least, usual, most;
  double deepest, mean, too_deep;
};

/// The bodies are the caller's: at the midpoint for find() and solve(), at the end of the substep for
/// correct().
template <class Space, class Real>
class ContactSolver {
 public:
  /// The candidates have been made anew; impulses are remembered, and couples if anything rolls.
  /// `before`: Slots::look_up() of them. The bodies in guides stay where they are until the next call.
  void take_candidates(ConstView<Pair> candidates, ConstView<std::int64_t> before,
                       const ConstBodyView& bodies, const ResponseParameters& parameters);

  /// Others of the bodies are free now; new candidates follow.
  void change_bodies() { slots_.forget_colors(); }
  /// What the next substep starts from, kept for a substep that is taken again in parts: after the candidates
  /// are taken and before find().
  void keep_memory();
  /// Back to it.
  void recall_memory();
  /// What the next substep starts from; the contacts of the last are not among it.
  void archive(Archive& archive, const ConstBodyView& bodies, const ResponseParameters& parameters);

  /// Contacts that may close by the next midpoint: gaps of at most the sum of the two margins (m). Impulses
  /// start from what they were, `scale` times.
  /// `flight`: the bodies after the impacts of the first half; `any_late_impact`: one came after the
  /// midpoint. `libccd`: to be asked as well, or instead; null: not at all.
  void find(ConstView<double> margin, double scale, const FlightStage& flight, bool any_late_impact,
            LibccdContacts* libccd);

  /// Impulses with e = 0, by sweeps; the bodies get their velocities, and those that were struck late their
  /// places. `share`: of the step that the substep is. Returns what was moved.
  Ledger solve(const FlightStage& flight, bool any_late_impact, double share, Counters& counters);

  /// Impacts after the response have changed velocities.
  void take_velocities(const ConstBodyView& bodies);

  /// Parts what would overlap, velocities stay. Returns what that moved.
  Ledger correct(const FlightStage& flight, bool any_late_impact);
  /// Deepest overlap that the last correct() has found (of the smaller smallest_size).
  double overlap() const { return overlap_; }
  /// Whether the contacts of the last find() are a heap.
  bool has_heap() const { return is_heap(counts_.points); }

  /// Of the last solve().
  const ContactTotals& totals() const { return totals_; }
  /// When the first contact that slid came to stick, as a share of the last substep; 1 if none did. For the
  /// accurate mode, and not for heaps, in which something always does.
  double slip_end() const { return slip_end_; }
  /// For each candidate a bit for each part that is loaded.
  ConstView<LoadedParts> loads() const {
    static_assert(sizeof(LoadedParts) == 1);
    return {reinterpret_cast<const LoadedParts*>(loads_.data()), slots_.candidates().size()};
  }
  /// The same of pairs whose Slots::look_up() is given.
  void loads_of(ConstView<std::int64_t> index, Array<LoadedParts, Space>& loads) const;
  const Slots<Space, Real>& slots() const { return slots_; }

  /// Of the last substep.
  Inspection<Real> inspect(const ConstBodyView& bodies);
  /// Adds up what the contacts of the last solve() gave to bodies that are not free.
  void add_wall_impulses(const FlightStage& flight);
  /// Of the step.
  WallSums<Space>& wall_sums() { return wall_sums_; }

 private:
  void forget_contacts();
  void pad();
  void load_bodies(const ConstBodyView& bodies, ConstView<double> margin,
                   const ResponseParameters& parameters);
  template <class F>
  void for_balls(const char* label, const F& f);
  template <class F>
  void for_points(const char* label, const F& f);
  template <class Sum, class OfBalls, class OfPoints>
  Sum sum_over_contacts(const char* label, const OfBalls& of_balls, const OfPoints& of_points);
  template <class Record>
  JoinHubs<Record> join_hubs(Array<Record, Space>& bodies);
  void list_guided(ConstView<Guide> guides);
  bool fits_on_host() const;
  void find_impulses(const ConstBodyView& bodies, const ResponseParameters& parameters, double share,
                     Counters& counters);
  bool sweep(const SweepPlan& plan, Counters& counters);
  bool solve_islands(const ConstBodyView& bodies, const SweepPlan& plan, bool accurate, Counters& counters);
  void set_velocities();
  void put_back(Inspection<Real>& seen, const ContactsOnHost<Real>& contacts);
  LoadSpread spread_of_loads();
  template <class Sum, class OfBalls, class OfPoints>
  IslandSums<Space, Sum> sum_by_island(const OfBalls& of_balls, const OfPoints& of_points);
  Residual<Real, BallContacts<Real>, TurnBalls> residual_of_balls();
  Residual<Real, PointContacts<Real>, TurnPoints> residual_of_points();
  bool are_solved(double tolerance);
  double residual();
  double find_slip_end(const AccountStage<Real>& stage);
  int keep_from_gaining(const AccountStage<Real>& stage);
  bool no_island_gains(AccountStage<Real> stage);
  void scale_impulses(double by);
  template <bool only_balls>
  SweepState run_impulse_phases(const SweepPlan& plan);
  void start_rolling(const FindStage<Real>& stage);
  bool rolls() const { return ball_rolling_.size() + point_rolling_.size() > 0; }
  RollingFields<Real> rolling_of_balls() {
    return {decltype(RollingFields<Real>::fields)(ball_rolling_.data())};
  }
  RollingFields<Real> rolling_of_points() {
    return {decltype(RollingFields<Real>::fields)(point_rolling_.data())};
  }
  CorrectionPlan plan_correction(double quality) const;
  template <bool only_balls>
  double run_correction_phases(const CorrectionPlan& plan);
  AccountStage<Real> account_stage(const ConstBodyView& bodies, const ResponseParameters& parameters);
  void account(const AccountStage<Real>& stage);
  AccountBalls<Real> account_balls(const AccountStage<Real>& stage);
  AccountPoints<Real> account_points(const AccountStage<Real>& stage);
  AccountRolling<Real, BallContacts<Real>> account_rolling_balls(const AccountStage<Real>& stage);
  AccountRolling<Real, PointContacts<Real>> account_rolling_points(const AccountStage<Real>& stage);
  ContactTotals account_ball_blocks(const AccountStage<Real>& stage) requires(visit_width<Space, Real> > 1);
  ReloadBody<Real> reload(const ConstBodyView& bodies, const Array<BodyRecord<Real>, Space>& from,
                          Array<BodyRecord<Real>, Space>& to);
  void fly_on_with_changes();
  Ledger shift_after_late_impacts(const FlightStage& flight);
  void predict_late_gaps(const FlightStage& flight);

  Slots<Space, Real> slots_;
  double step_ = 0;

  Array<MidBody<Real>, Space> mid_;
  Array<BodyRecord<Real>, Space> solver_, free_, last_, before_;
  Array<Guide, Space> guided_;  // bodies of the solver that are in guides
  std::vector<Guide> guides_;   // by place
  Array<CentreRecord<Real>, Space> displacement_, turn_;
  Array<PartsSum, Space> parts_sums_;

  ContactStore<Space, Real> store_;
  Array<Real, Space> ball_rolling_, point_rolling_;  // RollingFields; empty if nothing rolls
  ContactFinder<Space, Real> finder_;

  ContactCounts counts_;
  ContactTotals totals_;
  double overlap_ = 0;
  double slip_end_ = 1;
  SweepCount sweep_count_, kept_sweep_count_;
  Array<std::uint32_t, Space> loads_, next_loads_;

  Array<ContactTotals, Space> totals_scratch_, kind_totals_;
  WallSums<Space> wall_sums_;
  Array<Ledger, Space> ledger_scratch_;
};

}  // namespace scree::solver
