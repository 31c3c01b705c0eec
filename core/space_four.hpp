// Vectors of four numbers on Host: comparisons, and their results as bits. g++ and clang have such vectors
// for every processor, but no portable function for the last step.
#pragma once

#include <cstdint>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace scree {

using FourFloats [[gnu::vector_size(16), gnu::may_alias]] = float;
using FourInts [[gnu::vector_size(16), gnu::may_alias]] = std::int32_t;

/// Returns an array of four, aligned to 16 bytes, as a vector.
inline const FourFloats& four(const float (&numbers)[4]) {
  return reinterpret_cast<const FourFloats&>(numbers);
}
inline const FourInts& four(const std::int32_t (&numbers)[4]) {
  return reinterpret_cast<const FourInts&>(numbers);
}

/// Returns bits of which bit j is set if lane j is negative, as a lane is in which a comparison holds.
inline std::uint32_t negative_lanes(FourInts four) {
#if defined(__SSE2__)
  return static_cast<std::uint32_t>(_mm_movemask_ps(reinterpret_cast<__m128>(four)));
#else
  std::uint32_t bits = 0;
  for (int j = 0; j < 4; ++j) bits |= four[j] < 0 ? 1u << j : 0;
  return bits;
#endif
}

}  // namespace scree
