// An interface to libccd that hides its faults: it finds the direction that separates two overlapping bodies,
// if libccd finds one.
#pragma once

#include "core/math.hpp"

#include <optional>

namespace scree::libccd {

enum class Method {
  gjk,  ///< Gilbert-Johnson-Keerthi, then the expanding polytope
  mpr,  ///< Minkowski portal refinement
};

/// Two boxes in the frame of the first one: the second has its centre at `offset`, and its axes are the
/// columns of `turn`. All lengths are in units of the smaller box's largest half extent, because libccd
/// compares with absolute lengths.
struct Boxes {
  Vec3 half[2];
  Vec3 offset;
  Mat3 turn;
};

/// Any convex body, given by a point inside and by its support function. The caller chooses the frame; the
/// unit of length should be the size of the smaller body, as for boxes.
struct Convex {
  const void* body;
  Vec3 centre;
  /// Returns the point farthest along a direction of any length, which may be 0. If many points are farthest,
  /// it returns one that does not lie between others.
  Vec3 (*support)(const void* body, const Vec3& along);
};

/// Number of support points that libccd may ask for. The loops of EPA and of the portal refinement have no
/// bound of their own and are known to run for ever on nearly flat polytopes. The Minkowski difference of two
/// boxes has at most 64 vertices, and a search that works needs only a part of them.
inline constexpr int support_budget = 64;
/// Number of support points if one of the bodies is round: the difference then has no finite set of vertices.
inline constexpr int round_support_budget = 128;

struct Answer {
  /// The unit vector along which moving the second body separates the bodies soonest, as libccd finds it. It
  /// is empty if libccd finds no overlap or has no usable answer.
  std::optional<Vec3> direction;
  int supports = 0;  ///< points of the Minkowski difference that libccd asked for; over the budget if the
                     ///< search was stopped
};

/// Returns libccd's answer for two bodies. The search is bounded in time and the answer is never NaN. The
/// caller must check whether it is right, because it often is not.
Answer separating_direction(const Boxes& boxes, Method method, int budget = support_budget);
Answer separating_direction(const Convex& a, const Convex& b, Method method, int budget);

}  // namespace scree::libccd
