#include "sim/contacts/contact_finder.hpp"

namespace scree::solver {

template <class Space, class Real>
FoundPlaces ContactFinder<Space, Real>::search(const FindStage<Real>& stage, Slots<Space, Real>& slots,
                                               ConstView<LoadedParts> loads) {
  search_balls(stage, slots);
  search_points(stage, slots, loads);
  return {found_balls_.all(), found_points_.all(), slots.ball_places()};
}

template <class Space, class Real>
void ContactFinder<Space, Real>::make(const FindStage<Real>& stage, Slots<Space, Real>& slots,
                                      ConstView<LoadedParts> loads, View<BodyRecord<Real>> solver,
                                      ContactStore<Space, Real>& store) {
  make_balls(stage, slots, solver, store);
  make_points(stage, slots, loads, store);
}

#define SCREE_INSTANTIATE_FOR(Space, Real)                                                             \
  template FoundPlaces ContactFinder<Space, Real>::search(const FindStage<Real>&, Slots<Space, Real>&, \
                                                          ConstView<LoadedParts>);                     \
  template void ContactFinder<Space, Real>::make(const FindStage<Real>&, Slots<Space, Real>&,          \
                                                 ConstView<LoadedParts>, View<BodyRecord<Real>>,       \
                                                 ContactStore<Space, Real>&);
#define SCREE_INSTANTIATE(Space)       \
  SCREE_INSTANTIATE_FOR(Space, double) \
  SCREE_INSTANTIATE_FOR(Space, float)
SCREE_FOR_EACH_SPACE(SCREE_INSTANTIATE)

}  // namespace scree::solver
