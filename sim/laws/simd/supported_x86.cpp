// The kernels that an x86-64 processor can run.
#include "sim/laws/simd/simd.hpp"

namespace scree::simd {

std::vector<NamedKernels> supported_kernels() {
  std::vector<NamedKernels> all = {{"baseline", &baseline::kernels}};
  if (__builtin_cpu_supports("avx2")) all.push_back({"avx2", &avx2::kernels});
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512vl")) {
    all.push_back({"avx512", &avx512::kernels});
  }
  return all;
}

}  // namespace scree::simd
