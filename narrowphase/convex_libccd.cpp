#include "narrowphase/convex_libccd.hpp"

#include "core/tolerances.hpp"
#include "narrowphase/box_pair.hpp"
#include "narrowphase/convex_manifold.hpp"
#include "narrowphase/crosscheck.hpp"

#include <algorithm>
#include <cmath>

namespace scree {

namespace detail {

namespace {

/// A body in the form in which libccd gets it: in units of the pair and in the frame of its first body, as
/// boxes are. Features that are aligned with the first body are then aligned exactly: answers about cylinders
/// and hulls are refused a quarter less often.
struct Shown {
  const ConvexBody& body;
  const Mat3& frame;
  double unit;

  static Vec3 support(const void* self, const Vec3& along) {
    const auto& [body, frame, unit] = *static_cast<const Shown*>(self);
    const Vec3 direction = frame * along;
    Vec3 at = body.corner(direction);
    const double length = direction.norm();
    if (body.radius() > 0 && length > 0) at += body.radius() / length * direction;
    return frame.transpose() * at / unit;
  }
  libccd::Convex to_libccd() const { return {this, frame.transpose() * body.centre() / unit, support}; }
};

bool is_round(const ConvexBody& body) { return body.radius() > 0 || body.is_cylinder(); }

}  // namespace

int support_budget_of(const ConvexBody& a, const ConvexBody& b) {
  return is_round(a) || is_round(b) ? libccd::round_support_budget : libccd::support_budget;
}

libccd::Answer ask_libccd(const ConvexBody& a, const ConvexBody& b, libccd::Method method, int budget) {
  const double unit = std::min(a.extent(), b.extent());
  const Shown first{a, a.axes(), unit}, second{b, a.axes(), unit};
  libccd::Answer answer = libccd::separating_direction(first.to_libccd(), second.to_libccd(), method, budget);
  if (answer.direction) answer.direction = a.axes() * *answer.direction;
  return answer;
}

std::optional<ConvexAxis> certified_axis(const ConvexBody& a, const ConvexBody& b, const ConvexAxes& axes,
                                         double size, libccd::Method method, NarrowPhaseStats& stats) {
  const int budget = support_budget_of(a, b);
  const libccd::Answer answer = ask_libccd(a, b, method, budget);
  std::optional<ConvexAxis> axis;
  if (answer.direction) axis = {*answer.direction, separation_along(a, b, *answer.direction)};
  if (axis && !(axes.best.separation - axis->separation <= tolerance::libccd_excess * size)) axis.reset();
  ++stats.ccd_calls;
  stats.ccd_stopped += answer.supports > budget;
  stats.ccd_rejected += !axis;
  return axis;
}

namespace {

/// Returns the face whose normal is nearest to a direction. If several are equally near, the first body's
/// face is taken. The owner is -1 if there are no faces.
ConvexAxis face_along(const ConvexBody& a, const ConvexBody& b, const Vec3& direction) {
  ConvexAxis best;
  double best_cosine = -1.0;
  const auto take = [&](const ConvexAxis& face) {
    const double cosine = face.normal.dot(direction);
    if (cosine > best_cosine + tolerance::same_feature) {
      best_cosine = cosine;
      best = face;
    }
    return true;
  };
  visit_faces(a, b, take);
  return best;
}

/// Replaces the best axis by libccd's, and takes the face whose normal is nearest to it.
void take_axis(const ConvexBody& a, const ConvexBody& b, const ConvexAxis& axis, double size,
               ConvexAxes& axes) {
  axes.best = axis;
  // Where a vertex touches, many directions are right, and the face nearest to the given one may not be among
  // them.
  const ConvexAxis named = face_along(a, b, axis.normal);
  if (named.owner >= 0 && !clearly_better(axes.face.separation, named.separation, size)) axes.face = named;
}

}  // namespace

}  // namespace detail

int find_contacts_by_libccd(const ShapedSolid& a, const ShapedSolid& b, const PairShapes& shapes,
                            double margin, libccd::Method method, Manifold* out, NarrowPhaseStats& stats) {
  if (a.shape > b.shape) {
    const int count = find_contacts_by_libccd(b, a, {shapes.b, shapes.a}, margin, method, out, stats);
    if (count > 0) out->normal = -out->normal;
    return count;
  }
  const Vec3& origin = a.solid.position;
  const ConvexBody first(a, shapes.a, origin), second(b, shapes.b, origin);
  const double size = std::min(first.size(), second.size());
  ConvexAxes axes;
  if (!best_axes(first, second, margin, size, axes)) return 0;
  if (axes.best.separation < 0.0)
    if (const auto axis = detail::certified_axis(first, second, axes, size, method, stats))
      detail::take_axis(first, second, *axis, size, axes);
  return contact_along(first, second, axes, margin, size, origin, *out) ? 1 : 0;
}

void crosscheck(const ShapedSolid& a, const ShapedSolid& b, const PairShapes& shapes,
                CrosscheckStats& stats) {
  const Vec3& origin = a.solid.position;
  const ConvexBody first(a, shapes.a, origin), second(b, shapes.b, origin);
  const double size = std::min(first.size(), second.size());
  ConvexAxes axes;
  best_axes(first, second, HUGE_VAL, size, axes);
  const int budget = detail::support_budget_of(first, second);
  const auto direction = detail::ask_libccd(first, second, libccd::Method::gjk, budget).direction;
  std::optional<double> by_libccd;
  if (direction) by_libccd = separation_along(first, second, *direction);
  note_difference(axes.best.separation, by_libccd, size, stats);
}

}  // namespace scree
