// The 15 axes against libccd, while a scene runs. Host only.
#pragma once

#include "core/rng.hpp"
#include "narrowphase/box_box_ccd.hpp"

#include <cmath>
#include <cstdint>

namespace scree {

/// Whether a share of all pairs holds this one in this search. It hangs on the numbers of the two bodies and
/// of the search alone, so that neither order nor threads change the choice, and every step has another one.
inline bool is_crosschecked(double share, std::uint64_t search, std::int32_t i, std::int32_t j) {
  if (share <= 0.0) return false;
  const auto pair = static_cast<std::uint64_t>(static_cast<std::uint32_t>(i)) << 32;
  return Random(search, pair | static_cast<std::uint32_t>(j)).uniform() < share;
}

/// Asks libccd's MPR, which fails less often than its EPA, and counts in what its answer differs from that
/// of the 15 axes. The overlap along any direction is at least the penetration depth: where libccd's is the
/// smaller one, the 15 axes are wrong.
inline void crosscheck(const Solid& a, const Solid& b, CrosscheckStats& stats) {
  const BoxPair pair(a, b);
  const double separation = separating_axes(pair, HUGE_VAL).separation;
  const std::optional<Vec3> direction = detail::ask_ccd(pair, ccd::Method::mpr).direction;
  ++stats.asked;
  if (direction.has_value() != (separation < 0.0)) {
    stats.touching.note(std::fabs(separation) / pair.smallest);
  } else if (direction) {
    const double excess = (separation - pair.separation_along(*direction)) / pair.smallest;
    stats.ccd_deeper.note(excess);
    stats.ccd_shallower.note(-excess);
  }
}

}  // namespace scree
