#include "sim/contacts/contact_finder_points.hpp"

namespace scree::solver {

#define SCREE_INSTANTIATE(Space)                                                                             \
  template void ContactFinder<Space, double>::search_points(const FindStage<double>&, Slots<Space, double>&, \
                                                            ConstView<LoadedParts>);                         \
  template void ContactFinder<Space, double>::make_points(const FindStage<double>&, Slots<Space, double>&,   \
                                                          ConstView<LoadedParts>,                            \
                                                          ContactStore<Space, double>&);
SCREE_FOR_EACH_SPACE(SCREE_INSTANTIATE)

}  // namespace scree::solver
