// Work on the contacts of a substep on Host, island by island: islands on which sweeps converge slowly go to
// the direct solver, and the impulses of islands that would gain energy are scaled down.
#pragma once

#include "sim/laws/contact_row.hpp"
#include "sim/laws/response_parameters.hpp"
#include "sim/response/contact_inspection.hpp"
#include "sim/response/direct.hpp"

#include <cstdint>
#include <vector>

namespace scree::solver {

/// Velocities of j relative to i at a point of a contact: before the substep's forces, with these but without
/// contacts, and with the impulses found (m/s).
struct VelocitiesAt {
  Vec3 before, free, after;
};

template <class Real>
class ContactsOnHost {
 public:
  /// Copies the contacts as the sweeps have left them. They are sorted by the numbers of their bodies, so
  /// that the result does not depend on the places of the bodies. `guides` name their bodies by place.
  ContactsOnHost(Inspection<Real>& seen, const std::vector<Guide>& guides);

  /// Solves the islands whose natural residual is beyond the tolerance. Adds the numbers of successes and
  /// failures to `solved` and `failed`. Returns true if no island is left to the sweeps. An unsolved island
  /// with couples always is, since Newton's method here does not include couples. If `before` is given, which
  /// holds for each body of the solver its velocities before the substep's forces, so is an island whose
  /// bodies move on one another: the next substep has other contacts and cannot start from the solution.
  bool solve(double tolerance, const DirectLimits& limits, const std::vector<BodyRecord<Real>>* before,
             std::int64_t& solved, std::int64_t& failed);
  /// Scales down the impulses of each island that gains energy, until it gains none. Returns the number of
  /// such islands. `before`: as in solve().
  int keep_from_gaining(const std::vector<BodyRecord<Real>>& before);
  /// Writes the impulses and couples back to the contacts of the inspection.
  void put_back() const;

 private:
  bool rolls(std::int64_t island) const;
  bool moves(std::int64_t island, const std::vector<BodyRecord<Real>>& before) const;
  VelocitiesAt velocities_at(const ContactRow& row, const Contact& contact,
                             const std::vector<BodyRecord<Real>>& before) const;
  std::vector<BodyRecord<Real>> by_index(const std::vector<BodyRecord<Real>>& by_place) const;
  ImpulseChange residual_of(const IslandProblem& problem) const;
  void take_bodies(const std::vector<Guide>& guides);
  std::vector<std::int64_t> sort_contacts();
  void take_contacts(const std::vector<std::int64_t>& to);
  void set_velocities();
  std::int32_t index(std::int32_t body) const { return index_[static_cast<std::size_t>(body)]; }

  Inspection<Real>& seen_;
  std::vector<std::int32_t> index_;  // index of each body of the solver in the arrays below
  std::vector<std::int64_t> place_;  // place of each contact in its store
  Array<Contact, Host> contacts_;
  Array<ContactRow, Host> rows_;
  std::vector<Vec3> couples_;  // couple of each contact (N m s)
  Array<SolverBody, Host> bodies_;
  Array<Vec3, Host> velocity_, spin_;  // velocities without contacts
  Array<Guide, Host> guides_;
  Islands islands_;
};

}  // namespace scree::solver
