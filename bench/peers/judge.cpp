#include "bench/peers/judge.hpp"

#include "sim/measurement.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace scree::bench {

namespace {

struct Energy {
  double linear = 0;
  double angular = 0;
  double potential = 0;
  double mass = 0;

  double total() const { return linear + angular + potential; }
};

/// sum of m v^2 / 2 + w.I w / 2 and of -m g.x over the free bodies.
Energy energy_of(const BodyTable& state, const Vec3& gravity) {
  Energy sum;
  for (std::size_t k = 0; k < state.position.size(); ++k) {
    if (state.mobility[k] != Mobility::free) continue;
    const double mass = 1 / state.inverse_mass[k];
    const Vec3 spin = state.orientation[k].conjugate() * state.spin[k];  // in the body's frame
    sum.linear += 0.5 * mass * state.velocity[k].squaredNorm();
    sum.angular += 0.5 * spin.cwiseProduct(spin).dot(state.inverse_inertia[k].cwiseInverse());
    sum.potential -= mass * gravity.dot(state.position[k]);
    sum.mass += mass;
  }
  return sum;
}

}  // namespace

Judge::Judge(const Scene& scene)
    : gravity_(scene.gravity),
      first_place_(scene.bodies.position.back()),
      pair_finder_(make_pair_finder<Host>({}, false, Vec3::Zero())),
      narrow_phase_(NarrowPhaseSettings{}) {
  first_energy_ = energy_of(scene.bodies, gravity_).total();
  see(scene.bodies, 0);
}

void Judge::see(const BodyTable& state, double time) {
  findings_.newest = state;
  findings_.time = time;
  measure_energy(state);
  measure_penetration_of(state);
  const Vec3 travel = state.position.back() - first_place_;
  const Vec3 down = gravity_.normalized();  // 0 without gravity
  findings_.worst_drift = std::max(findings_.worst_drift, (travel - travel.dot(down) * down).norm());
}

void Judge::measure_energy(const BodyTable& state) {
  const Energy energy = energy_of(state, gravity_);
  Findings& f = findings_;
  f.spin_energy = energy.angular;
  f.energy_change = energy.total() - first_energy_;
  f.worst_energy_change = std::max(f.worst_energy_change, std::abs(f.energy_change));
  f.rms_speed = std::sqrt(2 * (energy.linear + energy.angular) / energy.mass);
}

void Judge::measure_penetration_of(const BodyTable& state) {
  Bodies<Host> bodies;
  copy_bodies(bodies, state);
  Array<double, Host> margin;
  copy(margin, std::vector<double>(state.position.size(), 0.0));  // what does not overlap is not asked for
  const ConstBodyView views = view_of(std::as_const(bodies));
  const ConstView<Pair> pairs =
      candidates_.list(views, pair_finder_->find(bodies, margin), std::as_const(margin).view());
  const Manifolds found = narrow_phase_.find(views, pairs, margin.view());
  measure_penetration(found, views, findings_.penetration);
  findings_.squared_penetration = 0;
  for (const ContactPoint& point : found.points)
    findings_.squared_penetration += std::pow(std::min(point.gap, 0.0), 2);
  findings_.worst_penetration = std::max(findings_.worst_penetration, findings_.penetration.max);
}

}  // namespace scree::bench
