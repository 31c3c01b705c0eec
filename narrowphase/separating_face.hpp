// Planes along the faces of two convex bodies in motion that separate them, in either space.
#pragma once

#include "narrowphase/any_contacts.hpp"

namespace scree {

/// Something at the beginning of a motion, when a contact is seen, and at the end.
template <class T>
struct Instants {
  T begin, seen, end;
};

/// The plane along a face of one of two bodies, which separates them.
struct SeparatingFace {
  Vec3 normal = Vec3::Zero();  ///< unit, from i to j, when the contact is seen
  double separation = 0;       ///< then (m)
  double approach = HUGE_VAL;  ///< by how much the bodies come closer along it (m); infinite: there is none

  SCREE_HD bool exists() const { return approach < HUGE_VAL; }
};

namespace detail {

/// A sphere or a box in place, with what the search for a separating face asks of a ConvexBody. Places are
/// relative to an origin near the pair (m).
class BallOrBox {
 public:
  SCREE_HD BallOrBox(const ShapedSolid& body, const Vec3& origin)
      : is_box_(body.shape == Shape::box),
        centre_(body.solid.position - origin),
        axes_(body.solid.orientation.toRotationMatrix()),
        size_(body.solid.size) {}

  SCREE_HD int faces() const { return is_box_ ? 6 : 0; }
  SCREE_HD Vec3 normal(int face) const { return (face % 2 == 0 ? 1.0 : -1.0) * axes_.col(face / 2); }
  /// How far along a unit direction the body reaches.
  SCREE_HD double reach(const Vec3& along) const {
    const double extent = is_box_ ? (axes_.transpose() * along).cwiseAbs().dot(size_) : size_.x();
    return centre_.dot(along) + extent;
  }

 private:
  bool is_box_;
  Vec3 centre_;
  Mat3 axes_;
  Vec3 size_;
};

/// Takes the best of the faces of the first body, if it is better than `best`.
template <class Body>
SCREE_HD void look_at_faces(const Instants<Body>& first, const Instants<Body>& second, double slack,
                            const Vec3& crossing, SeparatingFace& best) {
  const auto separation = [](const Body& a, const Body& b, const Vec3& n) {
    return -b.reach(-n) - a.reach(n);
  };
  for (int face = 0; face < first.begin.faces(); ++face) {
    const Vec3 from = first.begin.normal(face);
    const double at_begin = separation(first.begin, second.begin, from);
    if (at_begin < -slack) continue;
    const Vec3 normal = first.seen.normal(face);
    const double when_seen = separation(first.seen, second.seen, normal);
    const double at_end = separation(first.end, second.end, first.end.normal(face));
    const double approach = at_begin - fmin(when_seen, at_end);
    if (approach > slack + fabs(from.dot(crossing)) || approach >= best.approach) continue;
    best = {normal, when_seen, approach};
  }
}

template <class Body>
SCREE_HD SeparatingFace best_face(const Instants<Body>& i, const Instants<Body>& j, double slack,
                                  const Vec3& crossing) {
  SeparatingFace of_i, of_j;
  look_at_faces(i, j, slack, crossing, of_i);
  of_j.approach = of_i.approach;
  look_at_faces(j, i, slack, crossing, of_j);
  if (!(of_j.approach < of_i.approach)) return of_i;
  of_j.normal = -of_j.normal;
  return of_j;
}

/// As find_separating_face(), of any convex shapes, on Host.
SeparatingFace find_general_separating_face(const Instants<ShapedSolid>& i, const Instants<ShapedSolid>& j,
                                            const PairShapes& shapes, double slack, const Vec3& crossing);

}  // namespace detail

/// Of the planes along the faces of two convex bodies that separate them by at least -slack (m) at the
/// beginning of their motion, and that they approach after that by no more than slack and their normal's part
/// of `crossing` (m), the one that they approach least.
SCREE_HD inline SeparatingFace find_separating_face(const Instants<ShapedSolid>& i,
                                                    const Instants<ShapedSolid>& j, const PairShapes& shapes,
                                                    double slack, const Vec3& crossing) {
  SCREE_ON_HOST(
      if (is_general(i.begin.shape) || is_general(j.begin.shape)) return detail::find_general_separating_face(
          i, j, shapes, slack, crossing);)
  const Vec3 origin = i.begin.solid.position;
  const auto placed = [&origin](const Instants<ShapedSolid>& body) {
    return Instants<detail::BallOrBox>{{body.begin, origin}, {body.seen, origin}, {body.end, origin}};
  };
  return detail::best_face(placed(i), placed(j), slack, crossing);
}

}  // namespace scree
