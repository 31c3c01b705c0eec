// Which pairs libccd is asked about beside the search along axes, while a scene runs, and what is counted.
#pragma once

#include "core/rng.hpp"
#include "narrowphase/stats.hpp"

#include <cmath>
#include <cstdint>
#include <optional>

namespace scree {

/// Whether a share of all pairs holds this one in this search. It hangs on the numbers of the two bodies and
/// of the search alone, so that neither order nor threads change the choice, and every step has another one.
inline bool is_crosschecked(double share, std::uint64_t search, std::int32_t i, std::int32_t j) {
  if (share <= 0.0) return false;
  const auto pair = static_cast<std::uint64_t>(static_cast<std::uint32_t>(i)) << 32;
  return Random(search, pair | static_cast<std::uint32_t>(j)).uniform() < share;
}

/// Counts in what a separation along libccd's direction (none: it sees no overlap) differs from the largest
/// that the axes have. The overlap along any direction is at least the penetration depth: where libccd's is
/// the smaller one, the axes are wrong. `size`: of the smaller body (m).
inline void note_difference(double separation, const std::optional<double>& by_ccd, double size,
                            CrosscheckStats& stats) {
  ++stats.asked;
  if (by_ccd.has_value() != (separation < 0.0)) {
    stats.touching.note(std::fabs(separation) / size);
  } else if (by_ccd) {
    const double excess = (separation - *by_ccd) / size;
    stats.ccd_deeper.note(excess);
    stats.ccd_shallower.note(-excess);
  }
}

}  // namespace scree
