// Records that are read and written as a whole, in either space.
#pragma once

#include "core/space.hpp"
#include "core/space_unroll.hpp"

#include <cstddef>
#include <cstdint>

namespace scree {

#if defined(__CUDACC__)

namespace detail {

/// 16 bytes of any types: the most that a thread of a GPU reads or writes at once.
struct [[gnu::may_alias]] alignas(16) SixteenBytes {
  std::uint32_t words[4];
};

template <class T>
SCREE_HD void copy_record(T& to, const T& from) {
  static_assert(alignof(T) % sizeof(SixteenBytes) == 0);
  auto* const t = reinterpret_cast<SixteenBytes*>(&to);
  const auto* const f = reinterpret_cast<const SixteenBytes*>(&from);
  SCREE_UNROLL for (std::size_t k = 0; k < sizeof(T) / sizeof(SixteenBytes); ++k) t[k] = f[k];
}

}  // namespace detail

#endif

/// Reads a record from memory. On a GPU this takes one access for 16 bytes. The compiler would read number by
/// number, and where each thread of a warp reads a record of its own, each access takes as long.
template <class T>
SCREE_HD T load_whole(const T& from) {
#if defined(__CUDA_ARCH__)
  T record;
  detail::copy_record(record, from);
  return record;
#else
  return from;
#endif
}

/// Writes a record to memory, as load_whole() reads it.
template <class T>
SCREE_HD void store_whole(T& to, const T& record) {
#if defined(__CUDA_ARCH__)
  detail::copy_record(to, record);
#else
  to = record;
#endif
}

}  // namespace scree
