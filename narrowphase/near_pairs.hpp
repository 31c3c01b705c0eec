// Early-out tests that decide, without the bodies' shapes, whether two bodies are near enough for a contact.
#pragma once

#include "broadphase/bounds.hpp"
#include "core/array.hpp"
#include "core/bodies.hpp"
#include "narrowphase/far_apart.hpp"

#include <cmath>
#include <cstdint>

namespace scree {

/// The bodies, the margin of each within which it has contacts (m), and the paths along which they are looked
/// at. Two bodies are near if they are at some time on their paths.
struct NearPairs {
  ConstBodyView bodies;
  ConstView<double> margin;
  BodyPaths paths = {};

  /// Returns whether two bodies are of kinds that may be in contact: at least one is free, and both are
  /// present.
  SCREE_HD bool may_be_pair(std::int32_t i, std::int32_t j) const {
    return (is_free(i) || is_free(j)) && is_present(i) && is_present(j);
  }
  /// Returns whether two bodies may have a gap of no more than the sum of their margins, judged from the
  /// spheres around them (for a tube, from its wall and its caps). A sphere fills half of the volume of its
  /// box: in a packing this test removes two of five pairs.
  SCREE_HD bool spheres_are_near(std::int32_t i, std::int32_t j) const {
    if (is_plane(i)) return is_near_plane(i, j);
    if (is_plane(j)) return is_near_plane(j, i);
    if (is_boundary(bodies.shape[i])) return !is_within(i, j, reach(j) + margin[i]);
    if (is_boundary(bodies.shape[j])) return !is_within(j, i, reach(i) + margin[j]);
    return !are_far_apart(least_offset(i, j), reach(i) + reach(j));
  }
  /// Returns whether two bodies may have a gap of no more than the sum of their margins, judged from the
  /// boxes around their paths along the world's axes. Boxes are too coarse for planes: they are near a plane
  /// everywhere.
  SCREE_HD bool boxes_are_near(std::int32_t i, std::int32_t j) const {
    if (is_plane(i) || is_plane(j)) return true;
    const Vec3 centres = offset(i, j) + paths.middle() * (velocity(j) - velocity(i));
    const Vec3 apart = centres.cwiseAbs() - half_extent(i) - half_extent(j);
    return apart.maxCoeff() <= margin[i] + margin[j];
  }
  /// Returns the radius of a sphere around the path of a body and its margin (m); infinite for a boundary.
  SCREE_HD double sphere_around(std::int32_t k) const {
    return is_boundary(bodies.shape[k]) ? HUGE_VAL
                                        : reach(k) + fmax(-paths.from, paths.until) * velocity(k).norm();
  }
  SCREE_HD bool is_plane(std::int32_t k) const { return bodies.shape[k] == Shape::plane; }
  SCREE_HD bool is_free(std::int32_t k) const { return bodies.mobility[k] == Mobility::free; }

 private:
  SCREE_HD bool is_present(std::int32_t k) const { return bodies.mobility[k] != Mobility::absent; }
  SCREE_HD Vec3 offset(std::int32_t i, std::int32_t j) const {
    return bodies.period.nearest(bodies.position[j] - bodies.position[i]);
  }
  SCREE_HD Vec3 velocity(std::int32_t k) const { return paths.velocity_of(bodies.mobility[k], k); }
  /// Returns the offset of two bodies when they are nearest to each other on their paths (m).
  SCREE_HD Vec3 least_offset(std::int32_t i, std::int32_t j) const {
    const Vec3 apart = offset(i, j);
    const Vec3 separating = velocity(j) - velocity(i);
    const double squared = separating.squaredNorm();
    if (squared == 0) return apart;
    return apart + paths.within(-apart.dot(separating) / squared) * separating;
  }
  SCREE_HD double reach(std::int32_t k) const {
    return bounding_radius(bodies.shape[k], bodies.size[k]) + margin[k];
  }
  SCREE_HD Vec3 half_extent(std::int32_t k) const {
    return half_extent_of({bodies.shape[k], bodies.position[k], bodies.orientation[k], bodies.size[k]}) +
           (0.5 * paths.length() * velocity(k)).cwiseAbs();
  }
  SCREE_HD bool is_near_plane(std::int32_t plane, std::int32_t body) const {
    const Vec3 up = bodies.orientation[plane] * Vec3::UnitZ();
    const double height = up.dot(bodies.position[body] - bodies.position[plane]);
    const double climbing = up.dot(velocity(body));
    return height + fmin(paths.from * climbing, paths.until * climbing) <= reach(body) + margin[plane];
  }
  /// Returns whether a body is inside a tube and farther than `reach` (m) from its wall and its caps. This
  /// part of a tube is convex, so that a path is inside if both of its ends are.
  SCREE_HD bool is_within(std::int32_t tube, std::int32_t body, double reach) const {
    const Vec3 from = bodies.position[body] - bodies.position[tube];
    const Vec3 along = velocity(body);
    return is_point_within(tube, from + paths.from * along, reach) &&
           is_point_within(tube, from + paths.until * along, reach);
  }
  SCREE_HD bool is_point_within(std::int32_t tube, const Vec3& from, double reach) const {
    const Vec3 up = bodies.orientation[tube] * Vec3::UnitZ();
    const double along = up.dot(from);
    const double across = (from - along * up).norm();
    const Vec3& size = bodies.size[tube];
    const double rounding = tolerance::far_rounding * (size.x() + size.z());
    return across + reach + rounding < size.x() && fabs(along) + reach + rounding < size.z();
  }
};

}  // namespace scree
