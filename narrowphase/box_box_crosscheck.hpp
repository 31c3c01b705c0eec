// The 15 axes against libccd, while a scene runs. Host only.
#pragma once

#include "narrowphase/box_box_ccd.hpp"
#include "narrowphase/crosscheck.hpp"

namespace scree {

/// Asks libccd's MPR, which fails less often than its EPA, and counts in what its answer differs from that
/// of the 15 axes.
inline void crosscheck(const Solid& a, const Solid& b, CrosscheckStats& stats) {
  const BoxPair pair(a, b);
  const double separation = separating_axes(pair, HUGE_VAL).separation;
  const std::optional<Vec3> direction = detail::ask_ccd(pair, ccd::Method::mpr).direction;
  std::optional<double> by_ccd;
  if (direction) by_ccd = pair.separation_along(*direction);
  note_difference(separation, by_ccd, pair.smallest, stats);
}

}  // namespace scree
