// The kernels for a processor of an architecture that scree does not know: only the baseline.
#include "sim/laws/simd/simd.hpp"

namespace scree::simd {

std::vector<NamedKernels> supported_kernels() { return {{"baseline", &baseline::kernels}}; }

}  // namespace scree::simd
