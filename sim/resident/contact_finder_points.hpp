// The part of ContactFinder for slots that are not of balls, by precision: contact_finder_double.cpp and
// contact_finder_float.cpp.
#pragma once

#include "sim/resident/contact_finder_passing.hpp"
#include "sim/resident/find_points.hpp"

namespace scree::resident {

template <class Space, class Real>
void ContactFinder<Space, Real>::find_points(const FindStage<Real>& stage, Slots<Space, Real>& slots,
                                             ConstView<LoadedParts> loads, ContactStore<Space, Real>& store) {
  const std::int64_t tiles = slots.others().tiles();
  if (tiles == 0) return;
  const PassingList passing = clear_passing(tiles * parallel::tile);
  const PointContacts<Real> contacts = store.points();
  const std::int64_t first = store.ball_places();
  const FindPoints<Real> find{stage, first, contacts, slots.point_memory(), loads, passing};
  parallel::compact_tiles<Space>("contacts.find points", tiles, find, store.point_tiles().data());
  judge(passing, JudgePoints<Real>{stage, first, contacts});
}

}  // namespace scree::resident
