// For processors that scree knows nothing of.
#include "sim/resident/visit_kernels.hpp"

namespace scree::resident {

const VisitKernels& visit_kernels(const char*) { return baseline::visit_kernels; }

}  // namespace scree::resident
