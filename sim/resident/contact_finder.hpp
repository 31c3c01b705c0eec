// From slots to the contacts of a substep.
#pragma once

#include "core/array.hpp"
#include "sim/resident/ball_blocks.hpp"
#include "sim/resident/contact_store.hpp"
#include "sim/resident/find_stage.hpp"
#include "sim/resident/slots.hpp"

#include <cstdint>

namespace scree::resident {

template <class Space, class Real>
class ContactFinder {
 public:
  /// Fills the store, which has room for the slots. Slots without a contact forget their impulses, and bodies
  /// of the solver that are points of walls get their velocities. `loads`: of the candidates.
  void find(const FindStage<Real>& stage, Slots<Space, Real>& slots, ConstView<LoadedParts> loads,
            View<BodyRecord<Real>> solver, ContactStore<Space, Real>& store);

 private:
  void find_balls(const FindStage<Real>& stage, Slots<Space, Real>& slots, View<BodyRecord<Real>> solver,
                  ContactStore<Space, Real>& store);
  void find_points(const FindStage<Real>& stage, Slots<Space, Real>& slots, ConstView<LoadedParts> loads,
                   ContactStore<Space, Real>& store);
  PassingList clear_passing(std::int64_t places);
  template <class Judge>
  void judge(const PassingList& passing, const Judge& judge);

  Array<Reach, Host> reach_;  // of nobody, and of each body; where the kernels find contacts
  Array<std::int32_t, Space> passing_;
  Array<std::uint64_t, Space> passing_count_;
};

}  // namespace scree::resident
