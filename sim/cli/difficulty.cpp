#include "sim/cli/difficulty.hpp"

#include "sim/scene/motion_bounds.hpp"

#include <algorithm>
#include <cmath>

namespace scree::cli {

namespace {

/// The places at which a fall ends: the planes, and the lowest point of the bodies.
struct Ground {
  Vec3 up;
  double lowest = HUGE_VAL;  ///< lowest height of all bodies but surfaces, along `up` (m)
  std::vector<std::size_t> planes;

  Ground(const BodyTable& bodies, const Vec3& gravity) : up(-gravity.normalized()) {
    for (std::size_t k = 0; k < bodies.shape.size(); ++k) {
      if (bodies.shape[k] == Shape::plane) planes.push_back(k);
      if (!is_surface(bodies.shape[k]))
        lowest =
            std::min(lowest, up.dot(bodies.position[k]) - bounding_radius(bodies.shape[k], bodies.size[k]));
    }
  }

  /// Returns how far the body can fall until a plane stops it, or until it is as low as the lowest body was
  /// (m).
  double fall(const BodyTable& bodies, std::size_t k) const {
    const double radius = smallest_size(bodies.shape[k], bodies.size[k]);
    double way = HUGE_VAL;
    for (const std::size_t plane : planes) {
      const Vec3 normal = bodies.orientation[plane] * Vec3::UnitZ();
      const double steepness = normal.dot(up);
      const double gap = normal.dot(bodies.position[k] - bodies.position[plane]) - radius;
      if (steepness > 0 && gap > 0) way = std::min(way, gap / steepness);
    }
    return std::isfinite(way) ? way : std::max(up.dot(bodies.position[k]) - radius - lowest, 0.0);
  }
};

/// Returns the speed of the fastest point of the body (m/s).
double speed_of(const BodyTable& bodies, std::size_t k) {
  const double arm = bodies.shape[k] == Shape::sphere ? 0 : bounding_radius(bodies.shape[k], bodies.size[k]);
  return bodies.velocity[k].norm() + bodies.spin[k].norm() * arm;
}

}  // namespace

Difficulty difficulty_of(const Scene& scene) {
  const BodyTable& bodies = scene.bodies;
  const double g = largest_gravity(scene);
  const Ground ground(bodies, scene.gravity);
  Difficulty d{.smallest_size = HUGE_VAL, .least_size = HUGE_VAL};
  double heaviest = 0;
  double lightest = HUGE_VAL;
  for (std::size_t k = 0; k < bodies.shape.size(); ++k) {
    if (is_surface(bodies.shape[k])) continue;
    const double size = smallest_size(bodies.shape[k], bodies.size[k]);
    const double speed = speed_of(bodies, k);
    d.smallest_size = std::min(d.smallest_size, size);
    d.speed = std::max(d.speed, speed);
    if (bodies.mobility[k] != Mobility::free) continue;
    d.least_size = std::min(d.least_size, size);
    d.largest_size = std::max(d.largest_size, bounding_radius(bodies.shape[k], bodies.size[k]));
    heaviest = std::max(heaviest, 1 / bodies.inverse_mass[k]);
    lightest = std::min(lightest, 1 / bodies.inverse_mass[k]);
    if (g == 0) continue;
    // A body falls no longer than the run lasts.
    const double farthest = (speed + 0.5 * g * scene.time.end) * scene.time.end;
    const double fall = std::min(ground.fall(bodies, k), farthest);
    d.fall = std::max(d.fall, fall);
    d.speed = std::max(d.speed, std::sqrt(speed * speed + 2 * g * fall));
  }
  for (const Motion& motion : scene.motions) {
    const auto k = static_cast<std::size_t>(motion.body);
    const double arm = bodies.shape[k] == Shape::box ? bounding_radius(Shape::box, bodies.size[k]) : 0;
    const MotionBounds bounds = bounds_of(motion);
    if (motion.oscillate || !motion.keyframes.empty())
      d.speed = std::max(d.speed, bounds.speed + bounds.spin * arm);
  }
  if (!std::isfinite(d.smallest_size)) d.smallest_size = 0;
  if (!std::isfinite(d.least_size)) d.least_size = 0;
  if (heaviest > 0) d.mass_ratio = heaviest / lightest;
  return d;
}

}  // namespace scree::cli
