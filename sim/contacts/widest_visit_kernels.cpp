#include "sim/contacts/visit_kernels.hpp"
#include "sim/laws/simd/simd.hpp"

namespace scree::solver {

const ContactKernels& contact_kernels() {
  static const ContactKernels& widest = contact_kernels(simd::supported_kernels().back().name);
  return widest;
}

}  // namespace scree::solver
