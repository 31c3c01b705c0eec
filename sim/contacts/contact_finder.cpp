#include "sim/contacts/contact_finder.hpp"

namespace scree::solver {

template <class Space, class Real>
void ContactFinder<Space, Real>::find(const FindStage<Real>& stage, Slots<Space, Real>& slots,
                                      ConstView<LoadedParts> loads, View<BodyRecord<Real>> solver,
                                      ContactStore<Space, Real>& store) {
  find_balls(stage, slots, solver, store);
  find_points(stage, slots, loads, store);
}

#define SCREE_INSTANTIATE(Space)                                                                     \
  template void ContactFinder<Space, double>::find(const FindStage<double>&, Slots<Space, double>&,  \
                                                   ConstView<LoadedParts>, View<BodyRecord<double>>, \
                                                   ContactStore<Space, double>&);                    \
  template void ContactFinder<Space, float>::find(const FindStage<float>&, Slots<Space, float>&,     \
                                                  ConstView<LoadedParts>, View<BodyRecord<float>>,   \
                                                  ContactStore<Space, float>&);
SCREE_FOR_EACH_SPACE(SCREE_INSTANTIATE)

}  // namespace scree::solver
