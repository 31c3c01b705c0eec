// SIMD lanes as vectors of the instruction set, and the transposition that gathers them from bodies side by
// side in memory. This file is a part of kernels.cpp and of sim/contacts/visit_kernels.cpp, and cannot be
// compiled by itself; neither can its neighbours.
#pragma once

#include "sim/laws/simd/free_turn.hpp"
#include "sim/laws/simd/simd.hpp"
#include "sim/laws/simd/wide_laws.hpp"

#include <cstddef>
#include <cstdint>

namespace scree::simd::SCREE_SIMD {

namespace {

/// Vectors of `width` numbers, and of half as many.
template <class Number>
struct VectorsOf;
template <>
struct VectorsOf<double> {
  using Whole [[gnu::vector_size(width * sizeof(double)), gnu::may_alias]] = double;
  using Half [[gnu::vector_size(width / 2 * sizeof(double)), gnu::may_alias]] = double;
};
template <>
struct VectorsOf<float> {
  using Whole [[gnu::vector_size(width * sizeof(float)), gnu::may_alias]] = float;
  using Half [[gnu::vector_size(width / 2 * sizeof(float)), gnu::may_alias]] = float;
};

template <class Number>
struct LanesOf {
  using V = typename VectorsOf<Number>::Whole;
  static V root(const V& a) {
    V r = a;
    for (int l = 0; l < width; ++l) {
      if constexpr (sizeof(Number) == sizeof(float)) {
        r[l] = __builtin_sqrtf(a[l]);
      } else {
        r[l] = __builtin_sqrt(a[l]);
      }
    }
    return r;
  }
  static bool any(const decltype(V{} > V{}) & condition) {
    const auto fours = condition | __builtin_shufflevector(condition, condition, 4, 5, 6, 7, 0, 1, 2, 3);
    const auto twos = fours | __builtin_shufflevector(fours, fours, 2, 3, 0, 1, 6, 7, 4, 5);
    return (twos[0] | twos[1]) != 0;
  }
};

struct Lanes : LanesOf<double> {
  static HalfTurn<Lanes> half_turn(const V& square) { return half_turn_series<Lanes>(square); }
};
using V = Lanes::V;
using V3 = simd::V3<Lanes>;
/// Transposes squares of `size` x `size` numbers that lie side by side: pairs, then fours, then halves change
/// places.
template <int size, class Rows>
[[gnu::always_inline]] inline void transpose(Rows* rows) {
  const auto exchange = [rows](int distance, auto low, auto high) {
    for (int k = 0; k < size; ++k) {
      if ((k & distance) != 0) continue;
      const Rows a = rows[k];
      const Rows b = rows[k + distance];
      rows[k] = low(a, b);
      rows[k + distance] = high(a, b);
    }
  };
  exchange(
      1, [](Rows a, Rows b) { return __builtin_shufflevector(a, b, 0, 8, 2, 10, 4, 12, 6, 14); },
      [](Rows a, Rows b) { return __builtin_shufflevector(a, b, 1, 9, 3, 11, 5, 13, 7, 15); });
  exchange(
      2, [](Rows a, Rows b) { return __builtin_shufflevector(a, b, 0, 1, 8, 9, 4, 5, 12, 13); },
      [](Rows a, Rows b) { return __builtin_shufflevector(a, b, 2, 3, 10, 11, 6, 7, 14, 15); });
  if constexpr (size > 4) {
    exchange(
        4, [](Rows a, Rows b) { return __builtin_shufflevector(a, b, 0, 1, 2, 3, 8, 9, 10, 11); },
        [](Rows a, Rows b) { return __builtin_shufflevector(a, b, 4, 5, 6, 7, 12, 13, 14, 15); });
  }
}

/// Returns one bit for each lane in which a condition holds.
[[gnu::always_inline]] inline std::uint32_t bits_of(const decltype(V{} > V{}) & condition) {
  std::uint32_t bits = 0;
  for (int l = 0; l < width; ++l) bits |= static_cast<std::uint32_t>(condition[l] & 1) << l;
  return bits;
}

constexpr int half = width / 2;
using Half = VectorsOf<double>::Half;

}  // namespace

}  // namespace scree::simd::SCREE_SIMD
