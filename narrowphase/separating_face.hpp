// The search for a plane along a face of one of two convex bodies in motion that separates them, in either
// space.
#pragma once

#include "narrowphase/any_contacts.hpp"

namespace scree {

/// The states of something at three instants: at the beginning of a motion, when a contact is seen, and at
/// the end.
template <class T>
struct Instants {
  T begin, seen, end;
};

/// The plane along a face of one of two bodies, which separates them.
struct SeparatingFace {
  Vec3 normal = Vec3::Zero();  ///< unit vector from i to j, at the instant when the contact is seen
  double separation = 0;       ///< separation at that instant (m)
  double approach = HUGE_VAL;  ///< decrease of the separation (m); infinite: there is no such plane

  SCREE_HD bool exists() const { return approach < HUGE_VAL; }
};

namespace detail {

/// A sphere or a box in place, with the functions of ConvexBody that the search for a separating face needs.
/// Positions are relative to an origin near the pair (m).
class BallOrBox {
 public:
  SCREE_HD BallOrBox(const ShapedSolid& body, const Vec3& origin)
      : is_box_(body.shape == Shape::box),
        centre_(body.solid.position - origin),
        axes_(body.solid.orientation.toRotationMatrix()),
        size_(body.solid.size) {}

  SCREE_HD int faces() const { return is_box_ ? 6 : 0; }
  SCREE_HD Vec3 normal(int face) const { return (face % 2 == 0 ? 1.0 : -1.0) * axes_.col(face / 2); }
  /// Returns how far the body reaches along a unit direction.
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

/// Replaces `best` by the best face of the first body, if that is better.
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

/// Finds the face as find_separating_face() does, for any convex shapes, on Host.
SeparatingFace find_general_separating_face(const Instants<ShapedSolid>& i, const Instants<ShapedSolid>& j,
                                            const PairShapes& shapes, double slack, const Vec3& crossing);

}  // namespace detail

/// Finds a plane along a face of one of two convex bodies that separates them. It must separate them by at
/// least -slack (m) at the beginning of their motion, and they must approach it after that by no more than
/// slack plus the component of `crossing` (m) along its normal. Of these planes, the one that they approach
/// least is returned.
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
