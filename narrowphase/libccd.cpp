// The calls of libccd 2.1. Its faults, which this file keeps from its callers, are described where each is
// met.
#include "narrowphase/libccd.hpp"

#include <ccd/ccd.h>

namespace scree::libccd {

namespace {

Vec3 vector_of(const ccd_vec3_t& v) { return Vec3(v.v[0], v.v[1], v.v[2]); }
void set(ccd_vec3_t* to, const Vec3& v) { ccdVec3Set(to, v.x(), v.y(), v.z()); }

struct Box {
  Vec3 centre;
  Mat3 axes;
  Vec3 half;
  int* supports_left;

  /// Returns the vertex farthest along a direction. A component that is exactly 0 picks the positive side:
  /// the middle of a face is no vertex, and would make EPA return NaN for aligned boxes.
  Vec3 support(const Vec3& along) const {
    const Vec3 local = axes.transpose() * along;
    const Vec3 vertex = (local.array() < 0.0).select(-half, half);
    return centre + axes * vertex;
  }
};

struct Body {
  Convex convex;
  Vec3 centre;
  int* supports_left;

  Vec3 support(const Vec3& along) const { return convex.support(convex.body, along); }
};

template <class Shape>
void centre(const void* object, ccd_vec3_t* out) {
  set(out, static_cast<const Shape*>(object)->centre);
}

/// Gives libccd the vertex farthest along a direction.
///
/// When the budget is spent, the answer is a point behind the origin instead. Every loop of libccd 2.1 takes
/// a support that is behind its direction as the sign that nothing is left to find, and ends. Leaving by
/// exception or longjmp would leak the polytope.
template <class Shape>
void support(const void* object, const ccd_vec3_t* direction, ccd_vec3_t* out) {
  const Shape& shape = *static_cast<const Shape*>(object);
  const Vec3 along = vector_of(*direction);
  if (--*shape.supports_left < 0) {
    set(out, -along);
    return;
  }
  set(out, shape.support(along));
}

// EPA compares these tolerances with squared lengths, so they are 1e-5 and 1e-7 of a length. On a round body
// EPA ends when its polytope is that near to the surface; with box_tolerance, half of the directions would
// have more overlap than the best one by more than libccd_excess.
constexpr double box_tolerance = 1e-10, convex_tolerance = 1e-14;

template <class Shape>
Answer search(const Shape& a, const Shape& b, Method method, double tolerance, int budget,
              int& supports_left) {
  ccd_t ccd;
  CCD_INIT(&ccd);
  ccd.support1 = ccd.support2 = support<Shape>;
  ccd.center1 = ccd.center2 = centre<Shape>;
  ccd.max_iterations = 100;
  ccd.epa_tolerance = tolerance;
  ccd.mpr_tolerance = 1e-10;

  ccd_real_t depth;
  ccd_vec3_t direction{},
      position;  // EPA leaves the direction as it is if it finds none, and reports success
  const auto penetration = method == Method::gjk ? ccdGJKPenetration : ccdMPRPenetration;
  const bool overlap = penetration(&a, &b, &ccd, &depth, &direction, &position) == 0;
  Answer answer{{}, (2 * budget - supports_left) / 2};
  // Touching boxes make libccd normalise a zero vector: the result is NaN, with the return code of success.
  const double length = vector_of(direction).norm();
  if (overlap && length > 0.5 && length < 2.0) answer.direction = vector_of(direction) / length;
  return answer;
}

}  // namespace

Answer separating_direction(const Boxes& boxes, Method method, int budget) {
  int supports_left = 2 * budget;  // each support point is asked of both bodies
  const Box a{Vec3::Zero(), Mat3::Identity(), boxes.half[0], &supports_left};
  const Box b{boxes.offset, boxes.turn, boxes.half[1], &supports_left};
  return search(a, b, method, box_tolerance, budget, supports_left);
}

Answer separating_direction(const Convex& a, const Convex& b, Method method, int budget) {
  int supports_left = 2 * budget;
  const Body body_a{a, a.centre, &supports_left}, body_b{b, b.centre, &supports_left};
  return search(body_a, body_b, method, convex_tolerance, budget, supports_left);
}

}  // namespace scree::libccd
