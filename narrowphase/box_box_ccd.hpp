// Two boxes by way of libccd: it chooses the direction, a certificate judges it, and the contact points come
// from the same clipping as without it. Host only.
#pragma once

#include "narrowphase/box_box.hpp"
#include "narrowphase/ccd.hpp"
#include "narrowphase/stats.hpp"

#include <optional>

namespace scree {

namespace detail {

/// The answer of libccd, its direction in the world.
inline ccd::Answer ask_ccd(const BoxPair& pair, ccd::Method method) {
  const double unit = fmin(pair.half[0].maxCoeff(), pair.half[1].maxCoeff());
  ccd::Answer answer = ccd::parting_direction(
      {{pair.half[0] / unit, pair.half[1] / unit}, pair.axes[0].transpose() * pair.offset / unit, pair.turn},
      method);
  if (answer.direction) answer.direction = pair.axes[0] * *answer.direction;
  return answer;
}

/// The direction of libccd (world), certified: no direction has less overlap than the best of the 15 axes, so
/// one that has no more than it is right. None if libccd has none or it fails.
inline std::optional<Vec3> certified_direction(const BoxPair& pair, const BoxAxes& axes, ccd::Method method,
                                               NarrowPhaseStats& stats) {
  const ccd::Answer answer = ask_ccd(pair, method);
  const bool certified = answer.direction && axes.separation - pair.separation_along(*answer.direction) <=
                                                 tolerance::ccd_excess * pair.smallest;
  ++stats.ccd_calls;
  stats.ccd_stopped += answer.supports > ccd::support_budget;
  stats.ccd_rejected += !certified;
  return certified ? answer.direction : std::nullopt;
}

/// The face whose normal is nearest to a direction, the first body's if several are.
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

/// As box_box(). Boxes that are apart stay with the 15 axes: libccd has no distance query. So do those whose
/// answer by libccd the certificate refuses, which `stats` counts.
inline bool box_box_ccd(const Solid& a, const Solid& b, double margin, ccd::Method method, Manifold& out,
                        NarrowPhaseStats& stats) {
  const BoxPair pair(a, b);
  const BoxAxes axes = separating_axes(pair, margin);
  if (axes.separation > margin) return false;
  BoxAxis face = preferred_face(pair, axes);
  if (axes.separation < 0.0) {
    if (const std::optional<Vec3> direction = detail::certified_direction(pair, axes, method, stats)) {
      // Where a vertex touches, many directions are right, and the nearest face may not be among them.
      const BoxAxis named = detail::face_along(pair, *direction);
      if (!clearly_better(face.separation, named.separation, pair.smallest)) face = named;
    }
  }
  return contact_along(pair, axes, face, margin, out);
}

}  // namespace scree
