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

/// The smaller of the two stays. Exact, in whatever order threads come. T is unsigned.
template <class T>
SCREE_HD void lower(T* place, T value) {
#if defined(__CUDA_ARCH__)
  if constexpr (sizeof(T) == sizeof(unsigned long long)) {
    atomicMin(reinterpret_cast<unsigned long long*>(place), static_cast<unsigned long long>(value));
  } else {
    atomicMin(place, value);
  }
#else
  std::atomic_ref<T> shared(*place);
  T now = shared.load(std::memory_order_relaxed);
  while (value < now && !shared.compare_exchange_weak(now, value, std::memory_order_relaxed)) {
  }
#endif
}

/// Adds to an integer; the sum does not hang on the order of threads.
template <class T>
SCREE_HD T add(T* place, T value) {
#if defined(__CUDA_ARCH__)
  return atomicAdd(place, value);
#else
  return std::atomic_ref<T>(*place).fetch_add(value, std::memory_order_relaxed);
#endif
}

/// Sets the bits of `value`.
template <class T>
SCREE_HD void set_bits(T* place, T value) {
#if defined(__CUDA_ARCH__)
  atomicOr(place, value);
#else
  std::atomic_ref<T>(*place).fetch_or(value, std::memory_order_relaxed);
#endif
}

}  // namespace scree
