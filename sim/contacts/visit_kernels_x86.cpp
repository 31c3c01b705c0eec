// The choice of kernels by instruction set on x86-64 processors.
#include "sim/contacts/visit_kernels.hpp"

#include <string_view>

namespace scree::solver {

const VisitKernels& visit_kernels(const char* instruction_set) {
  const std::string_view name = instruction_set;
  if (name == "avx512") return avx512::visit_kernels;
  return name == "avx2" ? avx2::visit_kernels : baseline::visit_kernels;
}

}  // namespace scree::solver
