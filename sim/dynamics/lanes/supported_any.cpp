// Which kernels a processor can run that scree knows nothing of.
#include "sim/dynamics/lanes/lanes.hpp"

namespace scree::lanes {

std::vector<NamedKernels> supported_kernels() { return {{"baseline", &baseline::kernels}}; }

}  // namespace scree::lanes
