// Slots: where contacts may arise while the candidates stay, and what each remembers.
#pragma once

#include "broadphase/broad_phase.hpp"
#include "core/archive.hpp"
#include "core/array.hpp"
#include "core/bodies.hpp"
#include "sim/contacts/layout.hpp"
#include "sim/contacts/solver_bodies.hpp"

#include <cstdint>

namespace scree::solver {

/// Candidates in their order, and which place each body had when they were listed, by its place of now; none
/// where the places are the same.
struct ListedPairs {
  ConstView<Pair> pairs;
  ConstView<std::int32_t> place_before;

  /// The index of a pair; -1 if it is not there.
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
  /// Slots for the candidates (in their order, each with a free body); those that were there before keep
  /// what they remember. Places are given in tiles of parallel::tile: first those of balls, then the others,
  /// each in the order of the candidates. The result does not depend on the order of threads.
  /// `before`: look_up() of the candidates. `rolls`: couples are remembered, too.
  void build(ConstView<Pair> candidates, ConstView<std::int64_t> before, const ConstBodyView& bodies,
             bool rolls);
  /// The index of each pair among the present candidates; -1: it is none. `place_before`: where each body lay
  /// at the last build(), by its place, if bodies have changed places since.
  void look_up(ConstView<Pair> pairs, ConstView<std::int32_t> place_before,
               Array<std::int64_t, Space>& index) const;
  /// Others of the bodies are free now: colours are not to be kept.
  void forget_colors();
  /// Keeps what the slots remember, for recall_memory(), which puts it back. No build() between.
  void keep_memory();
  void recall_memory();
  /// `bodies`: as they are saved.
  void archive(Archive& archive, const ConstBodyView& bodies);

  ConstView<Slot> places() const { return places_.view(); }
  /// Of those of balls.
  std::int64_t ball_tiles() const { return ball_tiles_; }
  std::int64_t ball_places() const;
  /// Of the others.
  std::int64_t other_tiles() const;
  ConstView<Slot> places_of_balls() const { return {places_.data(), ball_places()}; }
  ConstView<Slot> places_of_others() const {
    return {places_.data() + ball_places(), places_.size() - ball_places()};
  }
  View<BallMemory<Real>> ball_memory() { return ball_memory_.view(); }
  View<PointMemory<Real>> point_memory() { return point_memory_.view(); }
  /// Against rolling (N m s), of all places; empty if nothing rolls.
  View<V3<Real>> couples() { return couples_.view(); }
  /// Of their last contacts (ContactColors).
  View<std::uint8_t> ball_colors() { return {color_.data(), ball_places()}; }
  View<std::uint8_t> other_colors() { return {color_.data() + ball_places(), color_.size() - ball_places()}; }

  /// Which the ends of slots are.
  const SolverBodies<Space>& solver_bodies() const { return solver_bodies_; }
  ConstView<Pair> candidates() const { return pairs_.view(); }

 private:
  void list_slots(const ConstBodyView& bodies);
  void place_slots(const ConstBodyView& bodies);
  void put_slots(std::int64_t places);
  void recall(ConstView<std::int64_t> before, const ConstBodyView& bodies, bool rolls);

  Array<Pair, Space> pairs_;                      // the candidates
  Array<std::int64_t, Space> first_, old_first_;  // slot of each; one more than candidates
  Array<Slot, Space> slots_;                      // in the order of the candidates
  Array<Slot, Space> places_;                     // the same slots, tile by tile
  Array<std::int64_t, Space> place_, old_place_;  // of each slot
  std::int64_t ball_tiles_ = 0;
  Array<BallMemory<Real>, Space> ball_memory_, old_ball_memory_;     // of each place
  Array<PointMemory<Real>, Space> point_memory_, old_point_memory_;  // of each place after those of balls
  Array<V3<Real>, Space> couples_, old_couples_;                     // of each place, if anything rolls
  Array<std::uint8_t, Space> color_, old_color_;                     // of each place
  Array<BallMemory<Real>, Space> kept_ball_memory_;
  Array<PointMemory<Real>, Space> kept_point_memory_;
  Array<V3<Real>, Space> kept_couples_;
  Array<std::uint8_t, Space> kept_color_;
  std::int64_t old_ball_places_ = 0;
  SolverBodies<Space> solver_bodies_;
};

}  // namespace scree::solver
