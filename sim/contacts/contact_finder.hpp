// From slots to the contacts of a substep.
#pragma once

#include "core/array.hpp"
#include "sim/contacts/ball_blocks.hpp"
#include "sim/contacts/contact_colors.hpp"
#include "sim/contacts/contact_store.hpp"
#include "sim/contacts/find_stage.hpp"
#include "sim/contacts/found_slots.hpp"
#include "sim/contacts/slots.hpp"

#include <cstdint>

namespace scree::solver {

template <class Space, class Real>
class ContactFinder {
 public:
  /// Fills the store. Slots without a contact forget their impulses, and bodies of the solver that are points
  /// of walls get their velocities. `loads`: of the candidates.
  void find(const FindStage<Real>& stage, Slots<Space, Real>& slots, ConstView<LoadedParts> loads,
            View<BodyRecord<Real>> solver, ContactStore<Space, Real>& store);
  /// The slots are others, or remember something else.
  void forget_slots() {
    ball_colors_.forget();
    point_colors_.forget();
  }
  /// What the next substep starts from.
  void archive(Archive& archive) {
    archive.part("ball_colors", ball_colors_);
    archive.part("point_colors", point_colors_);
  }

 private:
  void find_balls(const FindStage<Real>& stage, Slots<Space, Real>& slots, View<BodyRecord<Real>> solver,
                  ContactStore<Space, Real>& store);
  void find_points(const FindStage<Real>& stage, Slots<Space, Real>& slots, ConstView<LoadedParts> loads,
                   ContactStore<Space, Real>& store);
  ApproachList clear_approaching(std::int64_t contacts);
  template <class Judge>
  void judge(const ApproachList& approaching, const Judge& judge);

  FoundSlots<Space> found_;
  ContactColors<Space> ball_colors_, point_colors_;
  Array<FoundManifold, Space> manifolds_;  // of slots
  Array<Reach, Host> reach_;  // of padding_body, and of each body; where the kernels find contacts
  Array<std::int32_t, Space> approaching_;
  Array<std::uint64_t, Space> approaching_count_;
};

}  // namespace scree::solver
