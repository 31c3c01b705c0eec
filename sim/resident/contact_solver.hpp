// Contacts and their response with everything in one space: slots, contacts, sweeps, books, correction.
#pragma once

#include "core/array.hpp"
#include "core/bodies.hpp"
#include "sim/dynamics/contact_set.hpp"
#include "sim/dynamics/state.hpp"
#include "sim/dynamics/sweeps.hpp"
#include "sim/resident/bodies.hpp"
#include "sim/resident/books.hpp"
#include "sim/resident/find_contacts.hpp"
#include "sim/resident/slots.hpp"

#include <cstdint>

namespace scree::resident {

/// The bodies are the caller's: at the midpoint for find() and solve(), at the end of the substep for
/// correct().
template <class Space, class Real>
class ContactSolver {
 public:
  /// `laws`: of materials x materials.
  explicit ContactSolver(ConstView<PairLaw> laws, std::int64_t materials)
      : laws_(laws), materials_(materials) {}

  /// The candidates have been made anew; impulses are remembered.
  void take_candidates(ConstView<Pair> candidates, const ConstBodyView& bodies);
  void forget();

  /// Contacts that may close by the next midpoint: gaps of at most the sum of the two margins (m). Impulses
  /// start from what they were, `scale` times.
  void find(const ConstBodyView& bodies, ConstView<double> margin, double step, double scale,
            const ResponseParameters& parameters);

  /// Impulses with e = 0, by sweeps; the bodies get their velocities. Returns what was moved.
  Ledger solve(const BodyView& bodies, const ResponseParameters& parameters, Counters& counters);

  /// Parts what would overlap, velocities stay. Returns what that moved.
  Ledger correct(const BodyView& bodies, const ResponseParameters& parameters);
  /// Deepest overlap that the last correct() has found (of the smaller smallest_size).
  double overlap() const { return overlap_; }

  /// Of the last solve().
  const Books& books() const { return books_; }
  const ContactCounts& counts() const { return counts_; }
  /// For each candidate a bit for each part that is loaded.
  ConstView<std::uint8_t> loads() const {
    return {reinterpret_cast<const std::uint8_t*>(loads_.data()), slots_.candidates()};
  }
  const Slots<Space, Real>& slots() const { return slots_; }
  BallContacts<Real> balls();
  PointContacts<Real> points();

 private:
  void load_bodies(const ConstBodyView& bodies, ConstView<double> margin,
                   const ResponseParameters& parameters);
  void count();
  template <class Work>
  void for_each_color(const char* label, const ColorTiles& tiles, std::int64_t first, Work work);
  void sweep(const SweepPlan& plan);
  template <class Record>
  void join_parts(Array<Record, Space>& bodies);
  SweepState sweeps_done() const;

  ConstView<PairLaw> laws_;
  std::int64_t materials_;
  Slots<Space, Real> slots_;
  double step_ = 0;

  Array<MidBody<Real>, Space> mid_;
  Array<BodyRecord<Real>, Space> solver_, free_, last_;
  Array<InertiaRecord<Real>, Space> inertia_;
  Array<CentreRecord<Real>, Space> displacement_, turn_;
  Array<PartsSum, Space> parts_;

  Array<std::int32_t, Space> found_;  // of each tile; those of balls first
  Array<Ends, Space> ends_;
  Array<std::uint8_t, Space> slot_, flags_;
  Array<Real, Space> ball_fields_, contact_fields_, point_fields_;
  Array<std::int32_t, Space> points_;

  ContactCounts counts_;
  Books books_;
  double overlap_ = 0;
  Array<std::uint32_t, Space> loads_, next_loads_;

  Array<SweepChange, Space> change_;  // of each tile
  Array<SweepState, Space> state_;
  Array<SweepChange, Space> total_;
  Array<Deepest, Space> deepest_;
  Array<PartState, Space> part_state_;
  Array<Deepest, Space> deepest_of_all_;
  Array<Books, Space> book_sums_;
  Array<Books, Space> book_total_;
  Array<SweepChange, Space> change_scratch_;
  Array<Deepest, Space> deepest_scratch_;
};

}  // namespace scree::resident
