// The contacts of one pair of shapes with closed forms or boxes, for code in either space that finds contacts
// at instants of its own.
#pragma once

#include "core/bodies.hpp"
#include "narrowphase/box_box.hpp"
#include "narrowphase/box_plane.hpp"
#include "narrowphase/box_tube.hpp"
#include "narrowphase/sphere_box.hpp"
#include "narrowphase/sphere_plane.hpp"
#include "narrowphase/sphere_sphere.hpp"
#include "narrowphase/sphere_tube.hpp"

namespace scree {

namespace detail {

/// Returns the number of manifolds of a test that has at most one.
SCREE_HD inline int single(bool found, Manifold& out) {
  out.part = 0;
  return found ? 1 : 0;
}

/// Reverses the result of a test that was made with the bodies in the other order.
SCREE_HD inline int swapped(int count, Manifold* out) {
  for (int m = 0; m < count; ++m) out[m].normal = -out[m].normal;
  return count;
}

constexpr int kind_of(Shape a, Shape b) { return 8 * static_cast<int>(a) + static_cast<int>(b); }

/// Finds the contacts of two shapes that are in the order of Shape.
SCREE_HD inline int find_ordered_contacts(Shape shape_a, const Solid& a, Shape shape_b, const Solid& b,
                                          double margin, Manifold* out) {
  switch (kind_of(shape_a, shape_b)) {
    case kind_of(Shape::sphere, Shape::sphere):
      return single(sphere_sphere(a, b, margin, *out), *out);
    case kind_of(Shape::sphere, Shape::box):
      return single(sphere_box(a, b, margin, *out), *out);
    case kind_of(Shape::sphere, Shape::plane):
      return single(sphere_plane(a, b, margin, *out), *out);
    case kind_of(Shape::sphere, Shape::tube):
      return sphere_tube(a, b, margin, out);
    case kind_of(Shape::box, Shape::box):
      return single(box_box(a, b, margin, *out), *out);
    case kind_of(Shape::box, Shape::plane):
      return single(box_plane(a, b, margin, *out), *out);
    case kind_of(Shape::box, Shape::tube):
      return box_tube(a, b, margin, out);
    default:
      return 0;
  }
}

}  // namespace detail

/// Finds the contacts of one pair by the closed forms and the 15 axes, with gaps of at most `margin` (m), or
/// of boxes that just touch, of tolerance::touching_gap. It sets everything of the pair's manifolds except i
/// and j, and returns their number, at most max_pair_manifolds. Boundaries (planes and tubes) make no contact
/// with each other.
SCREE_HD inline int find_pair_contacts(Shape shape_a, const Solid& a, Shape shape_b, const Solid& b,
                                       double margin, Manifold* out) {
  const bool ordered = shape_a <= shape_b;
  const int count = detail::find_ordered_contacts(ordered ? shape_a : shape_b, ordered ? a : b,
                                                  ordered ? shape_b : shape_a, ordered ? b : a, margin, out);
  return ordered ? count : detail::swapped(count, out);
}

}  // namespace scree
