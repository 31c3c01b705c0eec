#include "sim/contacts/contact_finder_points.hpp"

namespace scree::solver {

#define SCREE_INSTANTIATE(Space)                                                                          \
  template void ContactFinder<Space, float>::search_points(const FindStage<float>&, Slots<Space, float>&, \
                                                           ConstView<LoadedParts>);                       \
  template void ContactFinder<Space, float>::make_points(                                                 \
      const FindStage<float>&, Slots<Space, float>&, ConstView<LoadedParts>, ContactStore<Space, float>&);
SCREE_FOR_EACH_SPACE(SCREE_INSTANTIATE)

}  // namespace scree::solver
