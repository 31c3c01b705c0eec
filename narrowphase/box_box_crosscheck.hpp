// The comparison of the 15 axes with libccd while a scene runs. This file is for Host only.
#pragma once

#include "narrowphase/box_box_libccd.hpp"
#include "narrowphase/crosscheck.hpp"

namespace scree {

/// Compares the separation by the 15 axes with that along the direction of libccd's MPR, and counts the
/// difference. MPR is used because it fails less often than libccd's EPA.
inline void crosscheck(const Solid& a, const Solid& b, CrosscheckStats& stats) {
  const BoxPair pair(a, b);
  const double separation = separating_axes(pair, HUGE_VAL).separation;
  const std::optional<Vec3> direction = detail::ask_libccd(pair, libccd::Method::mpr).direction;
  std::optional<double> by_libccd;
  if (direction) by_libccd = pair.separation_along(*direction);
  note_difference(separation, by_libccd, pair.smallest, stats);
}

}  // namespace scree
