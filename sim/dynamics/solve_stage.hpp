// The contact problem of one substep, as all parts of the response see it.
#pragma once

#include "core/array.hpp"
#include "core/bodies.hpp"
#include "narrowphase/contact.hpp"
#include "sim/dynamics/contact_set.hpp"
#include "sim/dynamics/rolling.hpp"
#include "sim/dynamics/state.hpp"

#include <cstdint>

namespace scree {

struct SolveStage {
  Manifolds manifolds;
  BodyView bodies;
  View<SolverBody> solver;
  View<Contact> contacts;
  View<ContactRow> rows;
  View<Vec3> couples = {};  ///< of each contact, if anything rolls
  bool rolls = false;
  View<ImpulseChange> change;  ///< of each contact, in the last sweep; empty if nobody asks
  View<Vec3> free_velocity;    ///< of each body without contacts
  View<Vec3> free_spin;
  double step;
  double noise = 0;                  ///< parting speeds that count as none (m/s)
  const BallPairs* balls = nullptr;  ///< whose contacts are made in the lanes; null: there are none
  lanes::BallSource pairs = {};      ///< of these
  double warm_start = 0;             ///< share of the impulses remembered that they start from
  ConstView<Guide> guides = {};      ///< have their say on velocities after each sweep over all contacts

  /// Relative velocity of a row of a contact: before the kick,
  SCREE_HD Vec3 velocity_before(const Contact& c, const ContactRow& row) const {
    return row.relative_velocity(bodies.velocity[c.i], bodies.spin[c.i], bodies.velocity[c.j],
                                 bodies.spin[c.j]);
  }
  /// after it without impulses,
  SCREE_HD Vec3 free_velocity_of(const Contact& c, const ContactRow& row) const {
    return row.relative_velocity(free_velocity[c.i], free_spin[c.i], free_velocity[c.j], free_spin[c.j]);
  }
  /// and with them.
  SCREE_HD Vec3 velocity_after(const Contact& c, const ContactRow& row) const {
    return row.relative_velocity(solver[c.i], solver[c.j]);
  }
  /// What the natural map changes in the couple of a contact, as it is.
  SCREE_HD ImpulseChange rolling_residual(std::int64_t c) const {
    const Contact& contact = contacts[c];
    if (!(contact.rolling_reach > 0)) return {};
    const SolverBody& i = solver[contact.i];
    const SolverBody& j = solver[contact.j];
    double pn = 0;
    for (int k = 0; k < contact.count; ++k) pn += rows_of(c)[k].impulse.dot(contact.normal);
    const double mass = rolling_mass(i, j, contact.normal);
    if (mass == 0) return {};
    const Vec3 couple =
        rolling_couple(couples[c], contact.normal, contact.rolling_reach * pn, mass, j.spin - i.spin);
    return {(couple - couples[c]).squaredNorm() / mass, couples[c].squaredNorm() / mass};
  }
  SCREE_HD ContactRow* rows_of(std::int64_t c) const { return &rows[contacts[c].first_row]; }
};

}  // namespace scree
