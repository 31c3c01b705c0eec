// What threads of one parallel call say to each other, in either space.
#pragma once

#include "core/space.hpp"

#include <atomic>

namespace scree {

/// Puts `value` in its place and returns what was there, at one stroke. All that a thread has written before
/// can be read by the thread that gets its value.
template <class T>
SCREE_HD T exchange(T* place, T value) {
#if defined(__CUDA_ARCH__)
  __threadfence();
  const T before = atomicExch(place, value);
  __threadfence();
  return before;
#else
  return std::atomic_ref<T>(*place).exchange(value, std::memory_order_acq_rel);
#endif
}

}  // namespace scree
