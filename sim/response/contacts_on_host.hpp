// The contacts of a substep on Host, island by island: those on which sweeps creep are for the direct solver,
// and islands that would gain energy are scaled down.
#pragma once

#include "sim/laws/contact_row.hpp"
#include "sim/laws/response_parameters.hpp"
#include "sim/response/contact_inspection.hpp"
#include "sim/response/direct.hpp"

#include <cstdint>
#include <vector>

namespace scree::solver {

template <class Real>
class ContactsOnHost {
 public:
  /// As sweeps have left them; in the order of the bodies' numbers, so that what is found does not hang on
  /// where bodies lie. `guides`: of bodies by place.
  ContactsOnHost(Inspection<Real>& seen, const std::vector<Guide>& guides);

  /// Solves the islands whose natural residual is beyond the tolerance. Adds to `solved` and `failed`; true
  /// if none is left to the sweeps, as those are with couples, which Newton's method does not know.
  bool solve(double tolerance, const DirectLimits& limits, std::int64_t& solved, std::int64_t& failed);
  /// Scales down the impulses of each island that gains energy, to where it gains none. How many did.
  /// `before`: of each body of the solver, the velocities before the substep's forces.
  int keep_from_gaining(const std::vector<BodyRecord<Real>>& before);
  /// Puts the impulses back among the contacts that were seen.
  void put_back() const;

 private:
  bool rolls(std::int64_t island) const;
  ImpulseChange residual_of(const IslandProblem& problem) const;
  void set_velocities();

  Inspection<Real>& seen_;
  std::vector<std::int32_t> index_;  // of each body of the solver in what follows
  std::vector<std::int64_t> place_;  // of each contact
  Array<Contact, Host> contacts_;
  Array<ContactRow, Host> rows_;
  std::vector<Vec3> couples_;  // of each contact
  Array<SolverBody, Host> bodies_;
  Array<Vec3, Host> velocity_, spin_;  // without contacts
  Array<Guide, Host> guides_;
  Islands islands_;
};

}  // namespace scree::solver
