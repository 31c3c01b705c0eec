// Work on each body within a substep: loading it for contacts and sweeps, and storing the velocities and
// displacements that they have found.
#pragma once

#include "core/bodies.hpp"
#include "core/space_record.hpp"
#include "sim/contacts/layout.hpp"
#include "sim/contacts/slots.hpp"
#include "sim/contacts/sweeps.hpp"
#include "sim/laws/displace.hpp"
#include "sim/laws/response_parameters.hpp"
#include "sim/laws/rotation.hpp"
#include "sim/observe/observation.hpp"

#include <cstdint>

namespace scree::solver {

inline ConstBodyView read_only(const BodyView& bodies) {
  ConstBodyView views;
  for_each_field([](const char*, auto& to, const auto& from) { to = from; }, views, bodies);
  views.period = bodies.period;
  views.place_of = bodies.place_of;
  return views;
}

/// Loads a body at the midpoint, and its velocities after the kick.
template <class Real>
struct LoadBody {
  ConstBodyView bodies;
  ConstView<double> margin;
  ResponseParameters parameters;
  double step;
  View<MidBody<Real>> mid;
  View<BodyRecord<Real>> solver;

  SCREE_HD void operator()(std::int64_t k) const {
    const Vec3& v = bodies.velocity[k];
    const bool free = bodies.mobility[k] == Mobility::free;
    const auto real = [](double value) { return static_cast<Real>(value); };
    const MidBody<Real> at{.position = bodies.position[k],
                           .size = smallest_size(bodies.shape[k], bodies.size[k]),
                           .velocity = v3<Real>(v),
                           .margin = real(margin[k]),
                           .inverse_mass = real(bodies.inverse_mass[k]),
                           .inverse_inertia = real(bodies.inverse_inertia[k].x()),
                           .material = bodies.material[k],
                           .shape = bodies.shape[k],
                           .mobility = bodies.mobility[k]};
    store_whole(mid[k], at);
    Vec3 spin = bodies.spin[k];
    if (free && parameters.torque.size() > 0) {
      const Mat3 world = world_inverse_inertia(bodies.orientation[k], bodies.inverse_inertia[k]);
      spin += step * (world * parameters.torque[k]).eval();
    }
    BodyRecord<Real> body;
    body.velocity = v3<Real>(free ? Vec3(v + step * parameters.acceleration_of(k)) : v);
    body.inverse_mass = real(bodies.inverse_mass[k]);
    body.spin = v3<Real>(spin);
    body.inverse_inertia = real(bodies.inverse_inertia[k].x());
    store_whole(solver[k], body);
  }
};

/// Loads a part of a hub: it gets its share of the hub's mass, and the hub's velocities.
template <class Real>
struct LoadPart {
  ConstView<Hub> hubs;
  ConstView<std::int32_t> hub_of;
  ConstView<double> share;
  std::int64_t first_part;
  View<BodyRecord<Real>> solver;
  SCREE_HD void operator()(std::int64_t p) const {
    const Hub& hub = hubs[hub_of[p]];
    const auto lighter = static_cast<Real>(1 / share[p]);
    BodyRecord<Real> part = solver[hub.body];
    part.inverse_mass *= lighter;
    part.inverse_inertia *= lighter;
    solver[first_part + p] = part;
  }
};

/// Clears bodies of the solver that are not free: the padding body and points of walls. The search for
/// contacts sets the velocities of the wall points in contact.
template <class Real>
struct ClearNotFree {
  std::int64_t first;
  View<BodyRecord<Real>> solver;
  SCREE_HD void operator()(std::int64_t k) const { solver[first + k] = {}; }
};

/// Stores the velocities that the contacts have changed, with the kick.
template <class Real>
struct StoreVelocities {
  ConstView<BodyRecord<Real>> free;  ///< bodies of the solver without contacts
  ConstView<BodyRecord<Real>> solver;
  ResponseParameters parameters;
  double step;
  BodyView bodies;
  SCREE_HD void operator()(std::int64_t k) const {
    if (bodies.mobility[k] != Mobility::free) return;
    // Changes are added, so that velocities of bodies without contact are not rounded.
    const BodyRecord<Real> before = load_whole(free[k]);
    const BodyRecord<Real> after = load_whole(solver[k]);
    bodies.velocity[k] += step * parameters.acceleration_of(k) + vec3(after.velocity - before.velocity);
    bodies.spin[k] += vec3(after.spin - before.spin);
    if (parameters.torque.size() > 0) {
      const Mat3 world = world_inverse_inertia(bodies.orientation[k], bodies.inverse_inertia[k]);
      bodies.spin[k] += step * (world * parameters.torque[k]);
    }
  }
};

/// Computes the work of the torque on a body (J) from the mean of its spins before and after, as the work of
/// impulses is computed. It must run before the velocities are stored.
template <class Real>
struct WorkOfTorque {
  ConstBodyView bodies;
  ConstView<BodyRecord<Real>> solver;
  ConstView<Vec3> torque;
  double step;
  SCREE_HD double operator()(std::int64_t k) const {
    if (bodies.mobility[k] != Mobility::free) return 0;
    return 0.5 * step * torque[k].dot(bodies.spin[k] + vec3(solver[k].spin));
  }
};

/// Sets the displacement and the turn of a body to zero.
template <class Real>
struct ResetDisplacement {
  ConstView<BodyRecord<Real>> solver;
  View<CentreRecord<Real>> displacement;
  View<CentreRecord<Real>> turn;  ///< empty if all contacts are of balls
  SCREE_HD void operator()(std::int64_t k) const {
    displacement[k].velocity = {};
    displacement[k].inverse_mass = solver[k].inverse_mass;
    if (turn.size() == 0) return;
    turn[k].velocity = {};
    turn[k].inverse_mass = solver[k].inverse_inertia;
  }
};

/// Moves a body at constant velocities, and returns what that adds to the ledger.
template <class Real>
struct Displace {
  ConstView<CentreRecord<Real>> displacement;
  ConstView<CentreRecord<Real>> turn;
  ResponseParameters parameters;
  BodyView bodies;

  SCREE_HD Ledger operator()(std::int64_t k) const {
    if (bodies.mobility[k] != Mobility::free) return {};
    const Vec3 by = vec3(displacement[k].velocity);
    const Vec3 angle = turn.size() > 0 ? vec3(turn[k].velocity) : Vec3(Vec3::Zero());
    return displace(bodies, k, by, angle, parameters.gravity, parameters.rotation);
  }
};

}  // namespace scree::solver
