// libccd behind a wall: the direction in which two overlapping bodies part, if libccd finds one.
#pragma once

#include "core/math.hpp"

#include <optional>

namespace scree::ccd {

enum class Method {
  gjk,  ///< Gilbert-Johnson-Keerthi, then the expanding polytope
  mpr,  ///< Minkowski portal refinement
};

/// Two boxes in the frame of the first one: the second has centre `offset` and axes the columns of `turn`.
/// All lengths are in units of the smaller box's largest half extent: libccd compares with absolute lengths.
struct Boxes {
  Vec3 half[2];
  Vec3 offset;
  Mat3 turn;
};

/// Any convex body: a point inside, and its farthest points. The frame is the caller's; the unit of length is
/// to be of the smaller body's size, as for boxes.
struct Convex {
  const void* body;
  Vec3 centre;
  /// Farthest along a direction of any length, which may be 0; where many are, one that lies between no
  /// others.
  Vec3 (*support)(const void* body, const Vec3& along);
};

/// Support points that libccd may ask for. The loops of EPA and of the portal have no bound of their own and
/// are known to run for ever on nearly flat polytopes. The Minkowski difference of two boxes has at most 64
/// vertices, and an honest search meets a part of them.
inline constexpr int support_budget = 64;
/// The same where one of the bodies is round, and the difference has no vertices to run out of.
inline constexpr int round_support_budget = 128;

struct Answer {
  /// Unit; moving the second body along it parts them soonest, as libccd sees it. None if it sees no overlap
  /// or has no usable answer.
  std::optional<Vec3> direction;
  int supports = 0;  ///< points of the Minkowski difference that it asked for: over the budget if stopped
};

/// Bounded in time, never NaN; whether the answer is right is for the caller to check, for it often is not.
Answer parting_direction(const Boxes& boxes, Method method, int budget = support_budget);
Answer parting_direction(const Convex& a, const Convex& b, Method method, int budget);

}  // namespace scree::ccd
