// For processors that scree knows nothing of.
#include "sim/contacts/visit_kernels.hpp"

namespace scree::solver {

const VisitKernels& visit_kernels(const char*) { return baseline::visit_kernels; }

}  // namespace scree::solver
