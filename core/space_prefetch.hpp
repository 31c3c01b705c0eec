// Loads ahead of their use, for work that runs in either space.
#pragma once

#include "core/space.hpp"

namespace scree {

/// Starts to load memory that is read soon. On Host this helps where the processor cannot predict the
/// address. On a GPU it helps a thread whose loads stand behind branches: it would wait for memory once for
/// each of them, and after the prefetches it waits once for all.
#if defined(__CUDACC__)
#pragma nv_exec_check_disable
#endif
SCREE_HD inline void prefetch(const void* at) {
#if defined(__CUDA_ARCH__)
  asm volatile("prefetch.global.L1 [%0];" ::"l"(at));
#else
  __builtin_prefetch(at);
#endif
}

/// On a GPU, loads numbers (float or double) at this place in the code. The compiler would put their loads
/// off until behind the next branch, and the thread would wait for memory once more.
template <class... Numbers>
SCREE_HD void load_here(Numbers&... numbers) {
#if defined(__CUDA_ARCH__)
  const auto load = [](auto& number) {
    if constexpr (sizeof(number) == sizeof(float)) {
      asm volatile("" : "+f"(number));
    } else {
      asm volatile("" : "+d"(number));
    }
  };
  (load(numbers), ...);
#else
  (static_cast<void>(numbers), ...);
#endif
}

/// Prefetches a whole element of an array: if its size is no power of 2, it may lie in two lines of a cache.
template <class T>
SCREE_HD void prefetch_whole(const T& element) {
  prefetch(&element);
  if constexpr ((sizeof(T) & (sizeof(T) - 1)) != 0)
    prefetch(reinterpret_cast<const char*>(&element) + sizeof(T) - 1);
}

}  // namespace scree
