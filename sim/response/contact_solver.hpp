// The contact solver of a substep: slots, contacts, sweeps, sums over contacts and position correction, with
// all data in one space.
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
#include "sim/laws/heap.hpp"
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

/// Number of sweeps of the position correction. After `least` sweeps it ends when the deepest overlap is at
/// most `deepest` and the mean at most `mean` (relative to the smaller smallest_size); after `usual` sweeps,
/// when the deepest is at most `too_deep`, or hardly changes any more while the mean is at most `mean`; and
/// in any case after `most`.
struct CorrectionPlan {
  int least, usual, most;
  double deepest, mean, too_deep;
  int first_with_momentum;  ///< first sweep with momentum, counted from 0
};

/// Finds the contacts of a substep, their impulses and the position correction. The bodies belong to the
/// caller: they must be at the midpoint for find() and solve(), and at the end of the substep for correct().
template <class Space, class Real>
class ContactSolver {
 public:
  /// Takes new candidate pairs. The slots of pairs that were candidates before keep their impulses, and their
  /// couples if anything rolls. `before` is the result of Slots::look_up() for the candidates. Bodies in
  /// guides must keep their places until the next call.
  void take_candidates(ConstView<Pair> candidates, ConstView<std::int64_t> before,
                       const ConstBodyView& bodies, const ResponseParameters& parameters);

  /// Must be called when other bodies have become free or not free; new candidates follow.
  void change_bodies() { slots_.forget_colors(); }
  /// Keeps the state from which the next substep starts, for a substep that is taken again in parts. It is
  /// called after the candidates are taken and before find().
  void keep_memory();
  /// Restores the state that keep_memory() has kept.
  void recall_memory();
  /// Saves or loads the state from which the next substep starts. It does not include the last contacts.
  void archive(Archive& archive, const ConstBodyView& bodies, const ResponseParameters& parameters);

  /// Finds the contacts that may close by the next midpoint: those whose gap is at most the sum of the two
  /// bodies' margins (m). The impulses start from `scale` times those of the last substep.
  /// `flight` has the bodies after the impacts of the first half; `any_late_impact` says that one came after
  /// the midpoint. `libccd` finds contacts too, or instead; if null, it is not used.
  void find(ConstView<double> margin, double scale, const FlightStage& flight, bool any_late_impact,
            LibccdContacts* libccd);

  /// Finds the impulses with e = 0. Sets the velocities of the bodies, and the positions of those with a late
  /// impact. `share` is the length of the substep in steps. Returns the energy and momentum that were moved.
  Ledger solve(const FlightStage& flight, bool any_late_impact, double share, Counters& counters);

  /// Takes the velocities that impacts after the response have changed, and predicts the gaps anew. `flight`
  /// has the bodies after these impacts.
  void take_velocities(const FlightStage& flight);

  /// Moves bodies apart that would overlap; the velocities stay. Returns what that adds to the ledger.
  Ledger correct(const FlightStage& flight, bool any_late_impact);
  /// Returns the deepest overlap before the last correct(), relative to the smaller smallest_size.
  double overlap() const { return overlap_; }
  /// Returns whether the contacts of the last find() are a heap.
  bool has_heap() const { return is_heap(counts_.points); }

  /// Returns the sums over all contacts of the last solve().
  const ContactTotals& totals() const { return totals_; }
  /// Returns when the first sliding contact came to stick, as a share of the last substep; 1 if none did. It
  /// is found in the accurate mode only, and not for heaps, in which some contact always comes to stick.
  double slip_end() const { return slip_end_; }
  /// Returns for each candidate a byte, with a bit for each part that is loaded.
  ConstView<LoadedParts> loads() const {
    static_assert(sizeof(LoadedParts) == 1);
    return {reinterpret_cast<const LoadedParts*>(loads_.data()), slots_.candidates().size()};
  }
  /// Finds the loaded parts of any pairs. `index` is the result of Slots::look_up() for them.
  void loads_of(ConstView<std::int64_t> index, Array<LoadedParts, Space>& loads) const;
  const Slots<Space, Real>& slots() const { return slots_; }

  /// Returns the contacts of the last substep on Host.
  Inspection<Real> inspect(const ConstBodyView& bodies);
  /// Adds the impulses of the last solve() on bodies that are not free to the wall sums.
  void add_wall_impulses(const FlightStage& flight);
  /// Returns the impulses on bodies that are not free, summed over the step.
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
  bool find_impulses(const ConstBodyView& bodies, const ResponseParameters& parameters, double share,
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
  std::vector<BodyRecord<Real>> velocities_before(const ConstBodyView& bodies);
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
  ContactTotals account_ball_blocks(const AccountStage<Real>& stage) requires(has_ball_kernels<Space, Real>);
  ReloadBody<Real> reload(const ConstBodyView& bodies, const Array<BodyRecord<Real>, Space>& from,
                          Array<BodyRecord<Real>, Space>& to);
  void fly_on_with_changes(bool rotations_are_applied);
  Ledger shift_after_late_impacts(const FlightStage& flight);
  void find_end_gaps(const ConstBodyView& bodies);

  Slots<Space, Real> slots_;
  double step_ = 0;

  Array<MidBody<Real>, Space> mid_;
  Array<BodyRecord<Real>, Space> solver_, free_, last_, before_;
  Array<Guide, Space> guided_;  // guides of bodies of the solver, hub parts included
  std::vector<Guide> guides_;   // guides with bodies by place
  Array<CentreRecord<Real>, Space> displacement_, turn_, last_displacement_, last_turn_;
  Array<PartsSum, Space> parts_sums_;

  ContactStore<Space, Real> store_;
  Array<Real, Space> ball_rolling_, point_rolling_;  // data of RollingFields; empty if nothing rolls
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
