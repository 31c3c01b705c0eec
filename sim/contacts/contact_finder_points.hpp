// The part of ContactFinder for slots that are not of balls. It is instantiated for each precision in a file
// of its own: contact_finder_double.cpp and contact_finder_float.cpp.
#pragma once

#include "sim/contacts/contact_finder_approach.hpp"
#include "sim/contacts/find_points.hpp"

#include <utility>

namespace scree::solver {

template <class Space, class Real>
void ContactFinder<Space, Real>::search_points(const FindStage<Real>& stage, Slots<Space, Real>& slots,
                                               ConstView<LoadedParts> loads) {
  const std::int64_t tiles = slots.other_tiles();
  found_points_.start(tiles);
  if (tiles == 0) return;
  manifolds_.resize(tiles * parallel::tile);
  const FindPoints<Real> find{stage, slots.ball_places(), {}, slots.point_memory(), loads,
                              {},    manifolds_.view()};
  parallel::compact_tiles<Space>("contacts.find points", tiles,
                                 FindSlots<FindPoints<Real>>{find, found_points_.places()},
                                 found_points_.counts());
  found_points_.join();
}

template <class Space, class Real>
void ContactFinder<Space, Real>::make_points(const FindStage<Real>& stage, Slots<Space, Real>& slots,
                                             ConstView<LoadedParts> loads, ContactStore<Space, Real>& store) {
  if (slots.other_tiles() == 0) return store.take_points({});
  point_colors_.find(found_points_.all(), slots.places_of_others(), stage.bodies,
                     slots.solver_bodies().count(), slots.other_colors());
  if (!point_colors_.are_same()) store.take_points(point_colors_.ranges());
  const std::int64_t first = slots.ball_places();
  FindPoints<Real> find{stage, first, store.points(), slots.point_memory(), loads, {}, manifolds_.view()};
  if (!point_colors_.are_same()) point_colors_.place(find.contacts.slot);
  const std::int64_t contacts = find.contacts.slot.size();
  find.approaching = clear_approaching(contacts);
  parallel::for_each<Space>("contacts.make points", contacts, MakeContacts<FindPoints<Real>>{find});
  judge(find.approaching, JudgePoints<Real>{stage, first, find.contacts, std::as_const(manifolds_).view()});
}

}  // namespace scree::solver
