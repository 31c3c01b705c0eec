// Loops over the contacts of a ContactSolver, as its sources share them. For parallel sources alone.
#pragma once

#include "core/parallel.hpp"
#include "core/space_tiles.hpp"
#include "sim/response/contact_solver.hpp"

#include <cstdint>

namespace scree::solver {

/// Calls f(c) for each contact of balls; for_points() does so for each of the others.
template <class Space, class Real>
template <class F>
void ContactSolver<Space, Real>::for_balls(const char* label, const F& f) {
  const BallContacts<Real> balls = store_.balls();
  parallel::for_each<Space>(label, balls.slot.size(), on_contacts(balls, f));
}
template <class Space, class Real>
template <class F>
void ContactSolver<Space, Real>::for_points(const char* label, const F& f) {
  const PointContacts<Real> points = store_.points();
  parallel::for_each<Space>(label, points.slot.size(), on_contacts(points, f));
}

/// Returns the sum over all contacts of the values that `of_balls` and `of_points` compute for them.
template <class Space, class Real>
template <class Sum, class OfBalls, class OfPoints>
Sum ContactSolver<Space, Real>::sum_over_contacts(const char* label, const OfBalls& of_balls,
                                                  const OfPoints& of_points) {
  const auto sum = [label](const auto& contacts, const auto& of) {
    return parallel::sum_by_tiles<Sum, Space>(label, contacts.slot.size(), on_contacts(contacts, of));
  };
  return sum(store_.balls(), of_balls) + sum(store_.points(), of_points);
}

template <class Space, class Real>
template <class Record>
JoinHubs<Record> ContactSolver<Space, Real>::join_hubs(Array<Record, Space>& bodies) {
  const ConstView<std::int32_t> hub_of = slots_.solver_bodies().hub_of_parts();
  parts_sums_.resize(hub_of.size());
  Record* const records = bodies.empty() ? nullptr : bodies.data();
  return {slots_.solver_bodies().hubs(),       hub_of,  slots_.solver_bodies().share_of_parts(),
          slots_.solver_bodies().first_part(), records, parts_sums_.data()};
}

}  // namespace scree::solver
