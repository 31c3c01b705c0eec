// What the narrow phase counts.
#pragma once

#include <array>
#include <cstdint>

namespace scree {

/// Disagreements of two methods by their size, which is relative to the smaller body's smallest_size.
struct Disagreements {
  /// Decade k counts sizes from least * 10^k to 10 times as much; the last one also all that is larger.
  static constexpr int decades = 7;
  static constexpr double least = 1e-6;  ///< smaller ones are none

  std::array<std::int64_t, decades> count{};

  void note(double size) {
    if (!(size >= least)) return;
    int decade = 0;
    for (double bound = 10 * least; size >= bound && decade + 1 < decades; bound *= 10) ++decade;
    ++count[static_cast<std::size_t>(decade)];
  }
  std::int64_t total() const {
    std::int64_t sum = 0;
    for (const std::int64_t n : count) sum += n;
    return sum;
  }
  Disagreements& operator+=(const Disagreements& other) {
    for (std::size_t k = 0; k < count.size(); ++k) count[k] += other.count[k];
    return *this;
  }
};

/// The search along axes against libccd, for the pairs that `narrowphase.crosscheck` chose.
struct CrosscheckStats {
  std::int64_t asked = 0;       ///< pairs
  Disagreements touching;       ///< only one of the two sees an overlap: the depth or the distance by axes
  Disagreements ccd_deeper;     ///< overlap along libccd's direction beyond the least known: libccd's error
  Disagreements ccd_shallower;  ///< overlap short of the least known: the error of the axes

  CrosscheckStats& operator+=(const CrosscheckStats& other) {
    asked += other.asked;
    touching += other.touching;
    ccd_deeper += other.ccd_deeper;
    ccd_shallower += other.ccd_shallower;
    return *this;
  }
};

struct NarrowPhaseStats {
  std::int64_t tested = 0;        ///< pairs tested, planes included
  std::int64_t ccd_calls = 0;     ///< pairs given to libccd
  std::int64_t ccd_rejected = 0;  ///< of these, answers that the certificate refused (axes then decided)
  std::int64_t ccd_stopped = 0;   ///< of these, searches that used up their budget of support points
  CrosscheckStats crosscheck;

  NarrowPhaseStats& operator+=(const NarrowPhaseStats& other) {
    tested += other.tested;
    ccd_calls += other.ccd_calls;
    ccd_rejected += other.ccd_rejected;
    ccd_stopped += other.ccd_stopped;
    crosscheck += other.crosscheck;
    return *this;
  }
};

}  // namespace scree
