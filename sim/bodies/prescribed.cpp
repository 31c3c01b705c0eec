#include "sim/bodies/prescribed.hpp"

#include "core/parallel.hpp"
#include "sim/scene/motion_bounds.hpp"

#include <algorithm>

namespace scree {

namespace {

struct Place {
  ConstView<PrescribedPath> paths;
  ConstView<PathKey> keys;
  double time;
  BodyView bodies;
  SCREE_HD void operator()(std::int64_t k) const { paths[k].place(time, keys, bodies); }
};

/// Returns the rotation vector that turns one orientation to the other the short way (rad).
Vec3 turn_between(const Quat& from, const Quat& to) {
  Quat turn = to * from.conjugate();
  if (turn.w() < 0) turn.coeffs() = -turn.coeffs();
  const double sine = turn.vec().norm();
  return sine > 0 ? Vec3(2 * std::atan2(sine, turn.w()) / sine * turn.vec()) : Vec3(2 * turn.vec());
}

/// Returns the rate of each component at a key between two chords with the rates `before` and `after`, such
/// that the cubics between keys are monotone: a harmonic mean, weighted by the times that the chords take, or
/// 0 where the component turns round (Fritsch and Butland 1984, "A method for constructing local monotone
/// piecewise cubic interpolants").
Vec3 rate_between(const Vec3& before, double time_before, const Vec3& after, double time_after) {
  const double share = (time_before + 2 * time_after) / (3 * (time_before + time_after));
  Vec3 rate = Vec3::Zero();
  for (int c = 0; c < 3; ++c)
    if (before[c] * after[c] > 0)
      rate[c] = before[c] * after[c] / (share * after[c] + (1 - share) * before[c]);
  return rate;
}

/// Makes the keys of a path from a scene's keyframes, and the way between them. At the first and the last key
/// the body is at rest. `own`: the body's orientation, for keyframes without one.
std::vector<PathKey> path_keys(const std::vector<MotionKey>& keyframes, const Quat& own) {
  const std::size_t n = keyframes.size();
  std::vector<PathKey> keys;
  for (const MotionKey& key : keyframes)
    keys.push_back({.at = key.at,
                    .position = key.position,
                    .velocity = Vec3::Zero(),
                    .orientation = key.orientation.value_or(own)});
  std::vector<Vec3> spin(n, Vec3::Zero());
  for (std::size_t k = 1; k + 1 < n; ++k) {
    const PathKey& before = keys[k - 1];
    const PathKey& after = keys[k + 1];
    const double h0 = keys[k].at - before.at;
    const double h1 = after.at - keys[k].at;
    keys[k].velocity = rate_between((keys[k].position - before.position) / h0, h0,
                                    (after.position - keys[k].position) / h1, h1);
    spin[k] = rate_between(turn_between(before.orientation, keys[k].orientation) / h0, h0,
                           turn_between(keys[k].orientation, after.orientation) / h1, h1);
  }
  for (std::size_t k = 0; k + 1 < n; ++k) {
    const double third = (keys[k + 1].at - keys[k].at) / 3;
    Vec3* const turns = keys[k].turns;
    turns[0] = third * spin[k];
    turns[2] = third * spin[k + 1];
    turns[1] = turn_between(rotation_of(turns[0]) * keys[k].orientation,
                            rotation_of(-turns[2]) * keys[k + 1].orientation);
  }
  return keys;
}

}  // namespace

PathTable prescribed_paths(const Scene& scene) {
  PathTable table;
  for (const Motion& motion : scene.motions) {
    const auto k = static_cast<std::size_t>(motion.body);
    const Vec3& centre = scene.bodies.position[k];
    const Vec3 pivot = motion.about.value_or(centre);
    const Oscillation oscillation = motion.oscillate.value_or(Oscillation{});
    const std::vector<PathKey> keys = path_keys(motion.keyframes, scene.bodies.orientation[k]);
    table.paths.push_back({.body = BodyNumber{motion.body},
                           .pivot = pivot,
                           .arm = centre - pivot,
                           .orientation = scene.bodies.orientation[k],
                           .velocity = motion.velocity,
                           .spin = motion.spin,
                           .start = 0,
                           .displacement = oscillation.displacement,
                           .angle = oscillation.angle,
                           .omega = oscillation.omega(),
                           .phase = oscillation.phase,
                           .first_key = static_cast<std::int32_t>(table.keys.size()),
                           .key_count = static_cast<std::int32_t>(keys.size())});
    table.keys.insert(table.keys.end(), keys.begin(), keys.end());
  }
  return table;
}

double prescribed_acceleration(const Scene& scene) {
  double largest = 0;
  for (const Motion& motion : scene.motions) {
    const auto k = static_cast<std::size_t>(motion.body);
    const double radius = bounding_radius(scene.bodies.shape[k], scene.bodies.size[k]);
    const double arm = motion.about ? (scene.bodies.position[k] - *motion.about).norm() : 0.0;
    const MotionBounds bounds = bounds_of(motion);
    largest = std::max(largest, bounds.acceleration + bounds.angular_acceleration * (arm + radius));
  }
  return largest;
}

template <class Space>
void place_prescribed(const PrescribedPaths<Space>& paths, double time, Bodies<Space>& bodies) {
  parallel::for_each<Space>("motion.prescribed", paths.paths.size(),
                            Place{paths.paths.view(), paths.keys.view(), time, view_of(bodies)});
}

#define SCREE_INSTANTIATE(Space) \
  template void place_prescribed(const PrescribedPaths<Space>&, double, Bodies<Space>&);
SCREE_FOR_EACH_SPACE(SCREE_INSTANTIATE)
#undef SCREE_INSTANTIATE

}  // namespace scree
