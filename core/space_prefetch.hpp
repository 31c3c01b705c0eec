// A prefetch hint to the processor's caches, for work that runs in either space.
#pragma once

#include "core/space.hpp"

namespace scree {

/// On Host, starts to load memory that is soon read from an address that the processor cannot predict.
#if defined(__CUDACC__)
#pragma nv_exec_check_disable
#endif
SCREE_HD inline void prefetch(const void* at) {
#if defined(__CUDA_ARCH__)
  static_cast<void>(at);
#else
  __builtin_prefetch(at);
#endif
}

}  // namespace scree
