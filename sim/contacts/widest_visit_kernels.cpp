#include "sim/contacts/visit_kernels.hpp"
#include "sim/laws/simd/simd.hpp"

namespace scree::solver {

const VisitKernels& visit_kernels() {
  static const VisitKernels& widest = visit_kernels(simd::supported_kernels().back().name);
  return widest;
}

}  // namespace scree::solver
