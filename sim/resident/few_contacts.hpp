// The contacts of a substep on Host, where they are few: those on which sweeps creep are for the direct
// solver there.
#pragma once

#include "sim/dynamics/direct.hpp"
#include "sim/resident/inspection.hpp"

#include <cstdint>
#include <vector>

namespace scree::resident {

/// Places and bodies that are worth their way to Host and back.
inline constexpr std::int64_t few_places = 1 << 16;
inline constexpr std::int64_t few_bodies = 1 << 14;

template <class Real>
class FewContacts {
 public:
  /// As sweeps have left them.
  explicit FewContacts(Inspection<Real>& seen);

  /// Solves the islands whose natural residual is beyond the tolerance. Adds to `solved` and `failed`; true
  /// if none is left to the sweeps.
  bool solve(double tolerance, const DirectLimits& limits, std::int64_t& solved, std::int64_t& failed);
  /// Puts the impulses back among the contacts that were seen, and returns the bodies of the solver with
  /// them.
  std::vector<BodyRecord<Real>> put_back();

 private:
  Inspection<Real>& seen_;
  std::vector<std::int64_t> place_;  // of each contact
  Array<Contact, Host> contacts_;
  Array<ContactRow, Host> rows_;
  Array<SolverBody, Host> bodies_;
  Array<Vec3, Host> velocity_, spin_;  // without contacts
  Islands islands_;
};

}  // namespace scree::resident
