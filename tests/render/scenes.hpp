// Small snapshots to draw.
#pragma once

#include "core/snapshot.hpp"

namespace scree::render {

inline void add_body(Snapshot& snapshot, Shape shape, const Vec3& position, const Vec3& size,
                     Mobility mobility = Mobility::free, const Quat& orientation = Quat::Identity()) {
  BodyTable& bodies = snapshot.bodies;
  const double inverse = mobility == Mobility::free ? 1 : 0;
  bodies.id.push_back(static_cast<std::int32_t>(bodies.id.size()));
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

/// The half space under `normal`.x = offset.
inline void add_plane(Snapshot& snapshot, const Vec3& normal, double offset) {
  add_body(snapshot, Shape::plane, offset * normal, Vec3::Zero(), Mobility::fixed,
           Quat::FromTwoVectors(Vec3::UnitZ(), normal));
}

}  // namespace scree::render
