// The counts of the narrow phase.
#pragma once

#include <array>
#include <cstdint>

namespace scree {

/// Counts of the disagreements of two methods by their size, which is relative to the smaller body's
/// smallest_size.
struct Disagreements {
  /// Decade k counts sizes from least * 10^k to 10 times as much; the last decade also counts all larger
  /// sizes.
  static constexpr int decades = 7;
  static constexpr double least = 1e-6;  ///< smaller differences are not counted

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

/// The comparison of the search along axes with libccd, for the pairs that `narrowphase.crosscheck` chose.
struct CrosscheckStats {
  std::int64_t asked = 0;       ///< number of pairs compared
  Disagreements touching;       ///< overlap found by only one method; size: depth or distance by axes
  Disagreements ccd_deeper;     ///< overlap along libccd's direction beyond the least known: libccd's error
  Disagreements ccd_shallower;  ///< overlap along libccd's direction short of the least known: error of axes

  CrosscheckStats& operator+=(const CrosscheckStats& other) {
    asked += other.asked;
    touching += other.touching;
    ccd_deeper += other.ccd_deeper;
    ccd_shallower += other.ccd_shallower;
    return *this;
  }
};

struct NarrowPhaseStats {
  std::int64_t tested = 0;        ///< number of pairs tested, planes included
  std::int64_t ccd_calls = 0;     ///< number of pairs given to libccd
  std::int64_t ccd_rejected = 0;  ///< answers of libccd that the certificate refused (the axes then decided)
  std::int64_t ccd_stopped = 0;   ///< searches of libccd that used up their budget of support points
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
