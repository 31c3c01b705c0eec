// The class that makes the contacts of a substep from the slots.
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
  /// Finds the slots that have a contact, and returns their places. The other slots forget their impulses.
  /// `loads`: the loaded parts of each candidate. The views are valid until the next call.
  FoundPlaces search(const FindStage<Real>& stage, Slots<Space, Real>& slots, ConstView<LoadedParts> loads);
  /// Makes the contacts that the last search() has found, and fills the store. Bodies of the solver that are
  /// points of walls get their velocities.
  void make(const FindStage<Real>& stage, Slots<Space, Real>& slots, ConstView<LoadedParts> loads,
            View<BodyRecord<Real>> solver, ContactStore<Space, Real>& store);
  /// Forgets the contacts of the last find(). This is necessary when the slots, or what they remember, have
  /// changed.
  void forget_slots() {
    ball_colors_.forget();
    point_colors_.forget();
  }
  /// Saves or loads what the next substep starts from.
  void archive(Archive& archive) {
    archive.part("ball_colors", ball_colors_);
    archive.part("point_colors", point_colors_);
  }

 private:
  void search_balls(const FindStage<Real>& stage, Slots<Space, Real>& slots);
  void search_points(const FindStage<Real>& stage, Slots<Space, Real>& slots, ConstView<LoadedParts> loads);
  void make_balls(const FindStage<Real>& stage, Slots<Space, Real>& slots, View<BodyRecord<Real>> solver,
                  ContactStore<Space, Real>& store);
  void make_points(const FindStage<Real>& stage, Slots<Space, Real>& slots, ConstView<LoadedParts> loads,
                   ContactStore<Space, Real>& store);
  ApproachList clear_approaching(std::int64_t contacts);
  template <class Judge>
  void judge(const ApproachList& approaching, const Judge& judge);

  FoundSlots<Space> found_balls_, found_points_;
  ContactColors<Space> ball_colors_, point_colors_;
  Array<FoundManifold, Space> manifolds_;  // one for each slot that is not of balls
  Array<Reach, Host> reach_;               // reach of empty slots, then of each body; for kernels only
  Array<std::int32_t, Space> approaching_;
  Array<std::uint64_t, Space> approaching_count_;
};

}  // namespace scree::solver
