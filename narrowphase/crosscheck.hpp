// The crosscheck of the search along axes against libccd while a scene runs: which pairs it takes, and what
// it counts.
#pragma once

#include "core/rng.hpp"
#include "narrowphase/stats.hpp"

#include <cmath>
#include <cstdint>
#include <optional>

namespace scree {

/// Returns whether a pair is in the given share of all pairs in this search. The choice depends only on the
/// numbers of the two bodies and of the search, so that neither order nor threads change it and every step
/// has another one.
inline bool is_crosschecked(double share, std::uint64_t search, std::int32_t i, std::int32_t j) {
  if (share <= 0.0) return false;
  const auto pair = static_cast<std::uint64_t>(static_cast<std::uint32_t>(i)) << 32;
  return Random(search, pair | static_cast<std::uint32_t>(j)).uniform() < share;
}

/// Counts the difference between the separation along libccd's direction (none: libccd finds no overlap) and
/// the largest separation that the axes have. The overlap along any direction is at least the penetration
/// depth: if libccd's overlap is the smaller one, the axes are wrong. `size` is the size of the smaller body
/// (m).
inline void note_difference(double separation, const std::optional<double>& by_libccd, double size,
                            CrosscheckStats& stats) {
  ++stats.asked;
  if (by_libccd.has_value() != (separation < 0.0)) {
    stats.touching.note(std::fabs(separation) / size);
  } else if (by_libccd) {
    const double excess = (separation - *by_libccd) / size;
    stats.ccd_deeper.note(excess);
    stats.ccd_shallower.note(-excess);
  }
}

}  // namespace scree
