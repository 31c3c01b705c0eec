// Small snapshots for the tests of drawing.
#pragma once

#include "core/rng.hpp"
#include "core/snapshot.hpp"

namespace scree::render {

inline void add_body(Snapshot& snapshot, Shape shape, const Vec3& position, const Vec3& size,
                     Mobility mobility = Mobility::free, const Quat& orientation = Quat::Identity()) {
  BodyTable& bodies = snapshot.bodies;
  const double inverse = mobility == Mobility::free ? 1 : 0;
  bodies.id.push_back(BodyNumber{static_cast<std::int32_t>(bodies.id.size())});
  bodies.position.push_back(position);
  bodies.orientation.push_back(orientation);
  bodies.velocity.push_back(Vec3::Zero());
  bodies.spin.push_back(Vec3::Zero());
  bodies.size.push_back(size);
  bodies.inverse_mass.push_back(inverse);
  bodies.inverse_inertia.push_back(Vec3::Constant(inverse));
  bodies.shape.push_back(shape);
  bodies.mobility.push_back(mobility);
  bodies.material.push_back(0);
}

inline void add_sphere(Snapshot& snapshot, const Vec3& position, double radius) {
  add_body(snapshot, Shape::sphere, position, Vec3::Constant(radius));
}

/// Adds the half space `normal`.x <= offset.
inline void add_plane(Snapshot& snapshot, const Vec3& normal, double offset) {
  add_body(snapshot, Shape::plane, offset * normal, Vec3::Zero(), Mobility::fixed,
           Quat::FromTwoVectors(Vec3::UnitZ(), normal));
}

/// Returns spheres and boxes above a ground, between walls.
inline Snapshot small_pile() {
  Snapshot snapshot;
  add_plane(snapshot, Vec3::UnitZ(), 0);
  add_plane(snapshot, Vec3::UnitX(), -2);
  add_plane(snapshot, -Vec3::UnitY(), -2);
  Random random(1, 1);
  for (int k = 0; k < 60; ++k) {
    const Vec3 place(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(0.2, 1.5));
    const Shape shape = k % 2 == 0 ? Shape::sphere : Shape::box;
    add_body(snapshot, shape, place, Vec3(0.2, 0.2, 0.1), Mobility::free, rotation_of(3 * place));
  }
  return snapshot;
}

/// Returns a tube with its axis along y, turned about that axis by an angle (rad).
inline Snapshot drum(double turn) {
  Snapshot snapshot;
  const Quat lying = Quat::FromTwoVectors(Vec3::UnitZ(), Vec3::UnitY());
  add_body(snapshot, Shape::tube, Vec3::Zero(), {1, 1, 0.4}, Mobility::prescribed,
           lying * Quat(Eigen::AngleAxisd(turn, Vec3::UnitZ())));
  return snapshot;
}

}  // namespace scree::render
