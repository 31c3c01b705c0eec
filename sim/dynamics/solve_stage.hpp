// The contact problem of one substep, as all parts of the response see it.
#pragma once

#include "core/array.hpp"
#include "core/bodies.hpp"
#include "narrowphase/contact.hpp"
#include "sim/dynamics/contact_set.hpp"
#include "sim/dynamics/state.hpp"

#include <cstdint>

namespace scree {

/// What the conjugate direction needs of a body.
struct BodyAcceleration {
  Vec3 last_velocity, last_spin;
  Vec3 velocity_direction, spin_direction;
};

struct SolveStage {
  ConstView<Manifold> manifolds;
  BodyView bodies;
  View<SolverBody> solver;
  View<Contact> contacts;
  View<ContactRow> rows;
  View<RowCoupling> couplings;
  View<ImpulseChange> change;
  View<BodyAcceleration> acceleration;
  View<Vec3> free_velocity;  ///< of each body without contacts
  View<Vec3> free_spin;
  double step;

  /// A body with its velocities before the kick; those of bodies that are not free do not change.
  SCREE_HD SolverBody before_kick(std::int32_t body) const {
    SolverBody state = solver[body];
    state.velocity = bodies.velocity[body];
    state.spin = bodies.spin[body];
    return state;
  }
  SCREE_HD SolverBody without_contacts(std::int32_t body) const {
    SolverBody state = solver[body];
    state.velocity = free_velocity[body];
    state.spin = free_spin[body];
    return state;
  }
  SCREE_HD ContactRow* rows_of(std::int64_t c) const { return &rows[contacts[c].first_row]; }
  SCREE_HD void store(std::int32_t body, const SolverBody& state) const {
    if (!state.is_free()) return;
    solver[body].velocity = state.velocity;
    solver[body].spin = state.spin;
  }
};

}  // namespace scree
