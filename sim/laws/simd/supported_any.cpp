// Which kernels a processor can run that scree knows nothing of.
#include "sim/laws/simd/simd.hpp"

namespace scree::simd {

std::vector<NamedKernels> supported_kernels() { return {{"baseline", &baseline::kernels}}; }

}  // namespace scree::simd
