#include "bench/peers/judge.hpp"

#include "narrowphase/any_contacts.hpp"

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

/// Returns the sums of m v^2 / 2 + w.I w / 2 and of -m g.x over the free bodies.
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

/// The overlap of a pair at its deepest point (m).
struct Overlap {
  std::int32_t i, j;
  double depth;
};

Solid solid_of(const ConstBodyView& bodies, std::int32_t k) {
  return {bodies.position[k], bodies.orientation[k], bodies.size[k]};
}

Penetration penetration_of(const std::vector<Overlap>& overlaps, const ConstBodyView& bodies) {
  Penetration out;
  if (overlaps.empty()) return out;
  std::vector<double> depths;
  const auto n = static_cast<double>(overlaps.size());
  for (const auto& [i, j, depth] : overlaps) {
    const double relative = depth / std::min(smallest_size(bodies.shape[i], bodies.size[i]),
                                             smallest_size(bodies.shape[j], bodies.size[j]));
    depths.push_back(depth);
    out.max = std::max(out.max, depth);
    out.mean += depth / n;
    out.relative_mean += relative / n;
    if (relative <= out.relative_max) continue;
    out.relative_max = relative;
    out.deepest = {static_cast<std::int32_t>(bodies.id[i]), static_cast<std::int32_t>(bodies.id[j])};
  }
  // p99 is the smallest depth that at least 99 % of the pairs do not exceed.
  const auto rank = static_cast<std::ptrdiff_t>(std::ceil(0.99 * n)) - 1;
  std::nth_element(depths.begin(), depths.begin() + rank, depths.end());
  out.p99 = depths[static_cast<std::size_t>(rank)];
  return out;
}

}  // namespace

Judge::Judge(const Scene& scene)
    : gravity_(scene.gravity),
      first_place_(scene.bodies.position.back()),
      pair_finder_(make_pair_finder<Host>({}, false, Vec3::Zero())) {
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
  copy(margin, std::vector<double>(state.position.size(), 0.0));  // pairs that do not overlap are not needed
  const ConstBodyView views = view_of(std::as_const(bodies));
  const ConstView<Pair> pairs =
      candidates_.list({views, std::as_const(margin).view()}, pair_finder_->find(bodies, margin, {}));
  findings_.squared_penetration = 0;
  std::vector<Overlap> overlaps;
  for (const auto& [i, j] : pairs) {
    Manifold found[max_pair_manifolds];
    const int count = find_any_contacts({views.shape[i], solid_of(views, i)},
                                        {views.shape[j], solid_of(views, j)}, {}, {.margin = 0}, found);
    double depth = 0;
    for (int m = 0; m < count; ++m) {
      for (int k = 0; k < found[m].count; ++k) {
        const double overlap = std::max(-found[m].points[k].gap, 0.0);
        depth = std::max(depth, overlap);
        findings_.squared_penetration += overlap * overlap;
      }
    }
    if (depth > 0) overlaps.push_back({i, j, depth});
  }
  findings_.penetration = penetration_of(overlaps, views);
  findings_.worst_penetration = std::max(findings_.worst_penetration, findings_.penetration.max);
}

}  // namespace scree::bench
