// Slots: the places where contacts may arise while the candidates stay, and what each slot remembers.
#pragma once

#include "broadphase/broad_phase.hpp"
#include "core/archive.hpp"
#include "core/array.hpp"
#include "core/bodies.hpp"
#include "sim/contacts/layout.hpp"
#include "sim/contacts/solver_bodies.hpp"

#include <cstdint>

namespace scree::solver {

/// The candidates in their order. `place_before` is the place that each body had when they were listed, by
/// its present place; it is empty if no body has changed its place.
struct ListedPairs {
  ConstView<Pair> pairs;
  ConstView<std::int32_t> place_before;

  /// Returns the index of a pair; -1 if the pair is not listed.
  SCREE_HD std::int64_t find(const Pair& pair) const {
    const Pair wanted =
        ordered(place_before.size() > 0 ? Pair{place_before[pair.i], place_before[pair.j]} : pair);
    std::int64_t low = 0, high = pairs.size();
    while (low < high) {
      const std::int64_t middle = (low + high) / 2;
      const Pair at = ordered(pairs[middle]);
      if (at.i < wanted.i || (at.i == wanted.i && at.j < wanted.j)) {
        low = middle + 1;
      } else {
        high = middle;
      }
    }
    if (low == pairs.size()) return -1;
    const Pair found = ordered(pairs[low]);
    return found.i == wanted.i && found.j == wanted.j ? low : -1;
  }

 private:
  SCREE_HD static Pair ordered(const Pair& pair) { return pair.i < pair.j ? pair : Pair{pair.j, pair.i}; }
};

template <class Space, class Real>
class Slots {
 public:
  /// Makes the slots of the candidates (in their order; each has a free body). Slots that were there before
  /// keep what they remember. Places are assigned in tiles of parallel::tile: first those of balls, then the
  /// others, each kind in the order of the candidates. The result does not depend on the order of threads.
  /// `before`: the result of look_up() for the candidates. `rolls`: whether couples are remembered, too.
  void build(ConstView<Pair> candidates, ConstView<std::int64_t> before, const ConstBodyView& bodies,
             bool rolls);
  /// Finds the index of each pair among the present candidates; -1 if it is none. `place_before`: the place
  /// of each body at the last build(), by its present place, if bodies have changed places since.
  void look_up(ConstView<Pair> pairs, ConstView<std::int32_t> place_before,
               Array<std::int64_t, Space>& index) const;
  /// Splits the bodies that have many of the contacts at the places `found` (SolverBodies::split_hubs), and
  /// forgets the colours of contacts on their parts, since the contacts are then dealt to the parts anew.
  /// Returns whether the bodies of the solver may have changed.
  bool split_hubs(const ConstBodyView& bodies, const FoundPlaces& found);
  /// Forgets all colours, as is necessary when other bodies than before are free.
  void forget_colors();
  /// Keeps a copy of what the slots remember. recall_memory() puts it back; no build() may come between the
  /// two.
  void keep_memory();
  void recall_memory();
  /// Saves or loads the slots. `bodies`: the bodies as they are saved.
  void archive(Archive& archive, const ConstBodyView& bodies);

  ConstView<Slot> places() const { return places_.view(); }
  /// Returns the number of tiles with slots of balls.
  std::int64_t ball_tiles() const { return ball_tiles_; }
  std::int64_t ball_places() const;
  /// Returns the number of tiles with other slots.
  std::int64_t other_tiles() const;
  ConstView<Slot> places_of_balls() const { return {places_.data(), ball_places()}; }
  ConstView<Slot> places_of_others() const {
    return {places_.data() + ball_places(), places_.size() - ball_places()};
  }
  /// Whether any slot of balls is_rare().
  bool has_rare_balls() const { return has_rare_balls_; }
  /// Whether the slot of each candidate is at the candidate's own place: each has one slot, of balls.
  bool are_candidates() const { return slots_.size() == pairs_.size() && other_tiles() == 0; }
  View<BallMemory<Real>> ball_memory() { return ball_memory_.view(); }
  View<PointMemory<Real>> point_memory() { return point_memory_.view(); }
  /// Returns the couples against rolling (N m s) of all places; empty if nothing rolls.
  View<V3<Real>> couples() { return couples_.view(); }
  /// Returns the colours of the last contacts of the slots of balls (see ContactColors).
  View<std::uint8_t> ball_colors() { return {color_.data(), ball_places()}; }
  View<std::uint8_t> other_colors() { return {color_.data() + ball_places(), color_.size() - ball_places()}; }

  /// Returns the bodies of the solver, which are the ends of the slots.
  const SolverBodies<Space>& solver_bodies() const { return solver_bodies_; }
  ConstView<Pair> candidates() const { return pairs_.view(); }

 private:
  void list_slots(const ConstBodyView& bodies);
  void place_slots(const ConstBodyView& bodies);
  void put_slots(const ConstBodyView& bodies, std::int64_t places);
  void recall(ConstView<std::int64_t> before, bool rolls);

  Array<Pair, Space> pairs_;                      // the candidates
  Array<std::int64_t, Space> first_, old_first_;  // first slot of each candidate, and the number of all slots
  Array<Slot, Space> slots_;                      // in the order of the candidates
  Array<Slot, Space> places_;                     // the same slots, tile by tile
  Array<std::int64_t, Space> place_, old_place_;  // place of each slot
  std::int64_t ball_tiles_ = 0;
  bool has_rare_balls_ = false;
  Array<BallMemory<Real>, Space> ball_memory_, old_ball_memory_;     // for each place of balls
  Array<PointMemory<Real>, Space> point_memory_, old_point_memory_;  // for each other place
  Array<V3<Real>, Space> couples_, old_couples_;                     // for each place, if anything rolls
  Array<std::uint8_t, Space> color_, old_color_;                     // for each place
  Array<BallMemory<Real>, Space> kept_ball_memory_;
  Array<PointMemory<Real>, Space> kept_point_memory_;
  Array<V3<Real>, Space> kept_couples_;
  Array<std::uint8_t, Space> kept_color_;
  std::int64_t old_ball_places_ = 0;
  SolverBodies<Space> solver_bodies_;
};

}  // namespace scree::solver
