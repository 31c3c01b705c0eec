// The choice of kernels by instruction set on x86-64 processors.
#include "sim/contacts/visit_kernels.hpp"

#include <string_view>

namespace scree::solver {

const ContactKernels& contact_kernels(const char* instruction_set) {
  const std::string_view name = instruction_set;
  if (name == "avx512") return avx512::contact_kernels;
  return name == "avx2" ? avx2::contact_kernels : baseline::contact_kernels;
}

}  // namespace scree::solver
