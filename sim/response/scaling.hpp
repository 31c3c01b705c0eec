// Scaling of all impulses of a substep by one factor, and of the velocity changes that they cause.
#pragma once

#include "sim/contacts/layout.hpp"
#include "sim/contacts/rolling_visits.hpp"

#include <cstdint>

namespace scree::solver {

template <class Real>
struct ScaleBalls {
  BallContacts<Real> contacts;
  Real by;
  SCREE_HD void operator()(std::int64_t c) const {
    using C = BallContacts<Real>;
    contacts.fields.set(C::impulse, c, by * contacts.fields.vector(C::impulse, c));
  }
};

template <class Real>
struct ScalePoints {
  PointContacts<Real> contacts;
  Real by;
  SCREE_HD void operator()(std::int64_t c) const {
    using C = PointContacts<Real>;
    for (int k = 0; k < contacts.points[c]; ++k) {
      const int at = C::at_point(k, C::impulse);
      contacts.point_fields.set(at, c, by * contacts.point_fields.vector(at, c));
    }
  }
};

/// Scales the couple of rolling friction of a contact.
template <class Real>
struct ScaleRolling {
  RollingFields<Real> rolling;
  Real by;
  SCREE_HD void operator()(std::int64_t c) const {
    using R = RollingFields<Real>;
    rolling.fields.set(R::couple, c, by * rolling.fields.vector(R::couple, c));
  }
};

/// Scales the velocity change of a body, which is linear in the impulses.
template <class Real>
struct ScaleVelocities {
  ConstView<BodyRecord<Real>> free;  ///< bodies of the solver without contacts
  View<BodyRecord<Real>> solver;
  Real by;
  SCREE_HD void operator()(std::int64_t k) const {
    solver[k].velocity = free[k].velocity + by * (solver[k].velocity - free[k].velocity);
    solver[k].spin = free[k].spin + by * (solver[k].spin - free[k].spin);
  }
};

}  // namespace scree::solver
