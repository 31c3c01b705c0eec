// The contact of two boxes by way of libccd: libccd chooses the direction, a certificate judges it, and the
// contact points come from the same clipping as without libccd. This file is for Host only.
#pragma once

#include "narrowphase/box_box.hpp"
#include "narrowphase/libccd.hpp"
#include "narrowphase/stats.hpp"

#include <optional>

namespace scree {

namespace detail {

/// Returns the answer of libccd, with its direction in world axes.
inline libccd::Answer ask_libccd(const BoxPair& pair, libccd::Method method) {
  const double unit = fmin(pair.half[0].maxCoeff(), pair.half[1].maxCoeff());
  libccd::Answer answer = libccd::separating_direction({{pair.half[0] / unit, pair.half[1] / unit},
                                                        pair.axes[0].transpose() * pair.offset / unit,
                                                        pair.rotation},
                                                       method);
  if (answer.direction) answer.direction = pair.axes[0] * *answer.direction;
  return answer;
}

/// Returns the direction of libccd (world axes) if it passes the certificate, else none. No direction has
/// less overlap than the best of the 15 axes, so a direction that has no more overlap than that axis is
/// right. There is none either if libccd finds no direction.
inline std::optional<Vec3> certified_direction(const BoxPair& pair, const BoxAxes& axes,
                                               libccd::Method method, NarrowPhaseStats& stats) {
  const libccd::Answer answer = ask_libccd(pair, method);
  const bool certified = answer.direction && axes.separation - pair.separation_along(*answer.direction) <=
                                                 tolerance::libccd_excess * pair.smallest;
  ++stats.ccd_calls;
  stats.ccd_stopped += answer.supports > libccd::support_budget;
  stats.ccd_rejected += !certified;
  return certified ? answer.direction : std::nullopt;
}

/// Returns the face whose normal is nearest to a direction. If several are equally near, the first body's
/// face is taken.
inline BoxAxis face_along(const BoxPair& pair, const Vec3& direction) {
  BoxAxis best{};
  double best_cosine = -1.0;
  for (int box = 0; box < 2; ++box) {
    for (int k = 0; k < 3; ++k) {
      const double cosine = fabs(pair.axes[box].col(k).dot(direction));
      if (cosine <= best_cosine + tolerance::same_feature) continue;
      best_cosine = cosine;
      best = {box, {k, k}, pair.separation_along(pair.axes[box].col(k))};
    }
  }
  return best;
}

}  // namespace detail

/// Finds the contact as box_box() does, with the direction of libccd. Boxes that are apart stay with the 15
/// axes, because libccd has no distance query. So do boxes for which the certificate refuses libccd's answer;
/// `stats` counts these.
inline bool box_box_libccd(const Solid& a, const Solid& b, double margin, libccd::Method method,
                           Manifold& out, NarrowPhaseStats& stats) {
  const BoxPair pair(a, b);
  const BoxAxes axes = separating_axes(pair, margin);
  if (axes.separation > margin) return false;
  BoxAxis face = preferred_face(pair, axes);
  if (axes.separation < 0.0) {
    if (const std::optional<Vec3> direction = detail::certified_direction(pair, axes, method, stats)) {
      // Where a vertex touches, many directions are right, and the face nearest to the given one may not be
      // among them.
      const BoxAxis named = detail::face_along(pair, *direction);
      if (!clearly_better(face.separation, named.separation, pair.smallest)) face = named;
    }
  }
  return contact_along(pair, axes, face, margin, out);
}

}  // namespace scree
