#include "sim/scene/motion_bounds.hpp"

#include <algorithm>
#include <cmath>

namespace scree {

namespace {

Vec3 between_keys(const std::vector<GravityKey>& keys, double time) {
  const auto after = std::ranges::upper_bound(keys, time, {}, &GravityKey::at);
  if (after == keys.begin()) return keys.front().vector;
  if (after == keys.end()) return keys.back().vector;
  const GravityKey& before = *std::prev(after);
  const double share = (time - before.at) / (after->at - before.at);
  return before.vector + share * (after->vector - before.vector);
}

/// Bounds on a monotone cubic between two keys, from the distance and the time between them. Its ends are at
/// most three times as steep as its chord (Fritsch and Carlson 1980), so it is nowhere steeper, and its
/// second derivative is largest at the ends.
struct CubicBounds {
  double rate, acceleration;
  CubicBounds(double distance, double time)
      : rate(3 * distance / time), acceleration(12 * distance / (time * time)) {}
};

}  // namespace

Vec3 gravity_at(const GravityTurn& turn, const Vec3& at_start, double time) {
  return turn.spin ? rotation_of(time * *turn.spin) * at_start : between_keys(turn.keyframes, time);
}

double largest_gravity(const Scene& scene) {
  double largest = scene.gravity.norm();
  if (!scene.gravity_turn) return largest;
  for (const GravityKey& key : scene.gravity_turn->keyframes) largest = std::max(largest, key.vector.norm());
  return largest;
}

MotionBounds bounds_of(const Motion& motion) {
  MotionBounds bounds{.speed = motion.velocity.norm(), .spin = motion.spin.norm()};
  if (motion.oscillate) {
    const Oscillation& o = *motion.oscillate;
    bounds.speed += o.omega() * o.displacement.norm();
    bounds.spin += o.omega() * o.angle.norm();
    bounds.acceleration = o.omega() * o.omega() * o.displacement.norm();
    bounds.angular_acceleration = o.omega() * o.omega() * o.angle.norm();
  }
  for (std::size_t k = 1; k < motion.keyframes.size(); ++k) {
    const MotionKey& from = motion.keyframes[k - 1];
    const MotionKey& to = motion.keyframes[k];
    const CubicBounds way((to.position - from.position).norm(), to.at - from.at);
    bounds.speed = std::max(bounds.speed, way.rate);
    bounds.acceleration = std::max(bounds.acceleration, way.acceleration);
    if (!from.orientation) continue;
    const CubicBounds turn(from.orientation->angularDistance(*to.orientation), to.at - from.at);
    // The rotation consists of three turns, one after another (PathKey). Their angles are at most once, three
    // times and once the angle between the keys, and each turn also rotates the spin of those before it.
    bounds.spin = std::max(bounds.spin, 4 * turn.rate);
    bounds.angular_acceleration =
        std::max(bounds.angular_acceleration, 3 * turn.acceleration + 16 * turn.rate * turn.rate);
  }
  return bounds;
}

}  // namespace scree
