// The contacts of a substep as they are shown: on Host, body by body.
#pragma once

#include "core/bodies.hpp"
#include "sim/inspection.hpp"
#include "sim/resident/contact_store.hpp"

#include <vector>

namespace scree::resident {

/// Contacts, where they have been brought to Host.
template <class Real>
struct Inspection {
  std::vector<Slot> places;
  std::vector<BodyRecord<Real>> free;  ///< bodies of the solver as they would be without contacts
  ContactStore<Host, Real> contacts;
  double step = 0;  ///< length of the substep (s)
};

template <class Real>
ContactProblem problem_of(Inspection<Real>& seen, const BodyTable& bodies);

/// Of those that carried a force.
template <class Real>
std::vector<ContactForce> forces_of(Inspection<Real>& seen, const BodyTable& bodies);

}  // namespace scree::resident
