// Atomic operations, by which the threads of one parallel call communicate, in either space.
#pragma once

#include "core/space.hpp"

#include <atomic>
#include <cstdint>
#include <type_traits>

namespace scree {

namespace detail {

/// The type that CUDA's atomic functions take for integers of T's size; of the two 64-bit types they take
/// only one.
template <class T>
using CudaWord = std::conditional_t<sizeof(T) == 8, unsigned long long,
                                    std::conditional_t<std::is_unsigned_v<T>, unsigned, int>>;

}  // namespace detail

/// Stores `value` in a place and returns the previous value, atomically. The thread that gets the value can
/// read all that the thread which stored it has written before.
template <class T>
SCREE_HD T exchange(T* place, T value) {
#if defined(__CUDA_ARCH__)
  __threadfence();
  using Word = detail::CudaWord<T>;
  const auto before = static_cast<T>(atomicExch(reinterpret_cast<Word*>(place), static_cast<Word>(value)));
  __threadfence();
  return before;
#else
  return std::atomic_ref<T>(*place).exchange(value, std::memory_order_acq_rel);
#endif
}

/// Stores `value` in a place where several threads may store the same value.
template <class T>
SCREE_HD void put(T* place, T value) {
#if defined(__CUDA_ARCH__)
  *static_cast<volatile T*>(place) = value;
#else
  std::atomic_ref<T>(*place).store(value, std::memory_order_relaxed);
#endif
}

/// Lowers the value in a place to `value`, if that is smaller. The result is exact, whatever the order of the
/// threads. On a GPU no thread waits for it.
template <class T>
SCREE_HD void lower(T* place, T value) {
#if defined(__CUDA_ARCH__)
  using Word = detail::CudaWord<T>;
  atomicMin(reinterpret_cast<Word*>(place), static_cast<Word>(value));
#else
  const std::atomic_ref<T> shared(*place);
  T before = shared.load(std::memory_order_relaxed);
  while (value < before && !shared.compare_exchange_weak(before, value, std::memory_order_relaxed)) {
  }
#endif
}

/// Raises the value in a place to `value`, if that is larger. It reads the place first, since many threads
/// may raise the same place to the same value.
template <class T>
SCREE_HD void raise(T* place, T value) {
#if defined(__CUDA_ARCH__)
  using Word = detail::CudaWord<T>;
  auto* word = reinterpret_cast<Word*>(place);
  if (value > *static_cast<volatile Word*>(word)) atomicMax(word, static_cast<Word>(value));
#else
  const std::atomic_ref<T> shared(*place);
  T before = shared.load(std::memory_order_relaxed);
  while (value > before && !shared.compare_exchange_weak(before, value, std::memory_order_relaxed)) {
  }
#endif
}

/// Adds to an integer and returns its previous value; the sum does not depend on the order of threads.
template <class T>
SCREE_HD T add(T* place, T value) {
#if defined(__CUDA_ARCH__)
  using Word = detail::CudaWord<T>;
  return static_cast<T>(atomicAdd(reinterpret_cast<Word*>(place), static_cast<Word>(value)));
#else
  return std::atomic_ref<T>(*place).fetch_add(value, std::memory_order_relaxed);
#endif
}

/// Adds one to a count and returns its previous value: a place in a list, whose order depends on the threads.
SCREE_HD inline std::uint64_t count_up(std::uint64_t* count) { return add(count, std::uint64_t{1}); }

/// Does the same as count_up() for a list that grows fast: the active threads of a warp, which must all count
/// up the same count, share one atomic addition.
SCREE_HD inline std::uint64_t count_up_together(std::uint64_t* count) {
#if defined(__CUDA_ARCH__)
  const unsigned active = __activemask();
  const unsigned lane = threadIdx.x % 32;
  const int first = __ffs(static_cast<int>(active)) - 1;
  std::uint64_t before = 0;
  if (lane == static_cast<unsigned>(first)) before = add(count, static_cast<std::uint64_t>(__popc(active)));
  before = __shfl_sync(active, before, first);
  return before + static_cast<std::uint64_t>(__popc(active & ((1u << lane) - 1)));
#else
  return count_up(count);
#endif
}

/// Sets the bits of `value` in a place.
template <class T>
SCREE_HD void set_bits(T* place, T value) {
#if defined(__CUDA_ARCH__)
  using Word = detail::CudaWord<T>;
  atomicOr(reinterpret_cast<Word*>(place), static_cast<Word>(value));
#else
  std::atomic_ref<T>(*place).fetch_or(value, std::memory_order_relaxed);
#endif
}

/// Clears the bits of `value` in a place.
template <class T>
SCREE_HD void clear_bits(T* place, T value) {
#if defined(__CUDA_ARCH__)
  using Word = detail::CudaWord<T>;
  atomicAnd(reinterpret_cast<Word*>(place), static_cast<Word>(static_cast<T>(~value)));
#else
  std::atomic_ref<T>(*place).fetch_and(static_cast<T>(~value), std::memory_order_relaxed);
#endif
}

}  // namespace scree
