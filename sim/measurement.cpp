#include "sim/measurement.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace scree {

void EnergyBaseline::start(const Energies& energies, double least_scale) {
  first_potential_ = energies.potential;
  first_total_ = energies.kinetic() + energies.potential;
  scale_ = least_scale;
  extend(energies, 0);
}

void EnergyBaseline::extend(const Energies& energies, double explained) {
  unexplained_before_ = unexplained_;
  unexplained_ = energies.kinetic() + energies.potential - first_total_ - explained;
  scale_ = std::max(scale_, energies.kinetic() + std::abs(energies.potential - first_potential_));
}

void EnergyBaseline::archive(Archive& archive) {
  archive("first_total", first_total_);
  archive("first_potential", first_potential_);
  archive("unexplained", unexplained_);
  archive("scale", scale_);
}

double explained_energy(const Ledger& ledger, const Exchange& exchange) {
  return exchange.energy + ledger.work + ledger.integration - ledger.restitution - ledger.friction -
         ledger.correction;
}

void measure_totals(const Totals& totals, const EnergyBaseline& baseline, const Vec3& gravity,
                    const Vec3& reference, Observation& out) {
  out.kinetic_linear = totals.kinetic_linear;
  out.kinetic_angular = totals.kinetic_angular;
  out.potential = totals.potential - totals.mass * gravity.dot(reference);
  out.momentum = totals.momentum;
  out.angular_momentum = totals.angular_momentum;
  const auto count = static_cast<double>(totals.count);
  out.centre = reference + totals.first_moment / totals.mass;
  out.speed_rms = totals.count > 0 ? std::sqrt(totals.speed_squared / count) : 0.0;
  out.speed_kurtosis = count * totals.speed_fourth / (totals.speed_squared * totals.speed_squared);
  out.energy_scale = baseline.scale();
  const double change = totals.kinetic() + totals.potential - baseline.first_total();
  const double explained = explained_energy(out.ledger, out.exchange);
  out.unexplained = out.energy_scale > 0 ? std::abs(change - explained) / out.energy_scale : 0.0;
  out.exchange.energy -= out.exchange.mass * gravity.dot(reference);
}

void measure_regions(const std::vector<Region>& regions, const std::vector<RegionContents>& now,
                     const std::vector<RegionContents>& before, const std::vector<Removed>& removed,
                     double step, std::vector<RegionState>& out) {
  out.clear();
  for (std::size_t r = 0; r < regions.size(); ++r) {
    const double flux = step > 0 ? (now[r].mass - before[r].mass) / step : 0.0;
    out.push_back({now[r].count, now[r].volume / (regions[r].to - regions[r].from).prod(), flux, removed[r]});
  }
}

void measure_contacts(const ContactSet& contacts, std::int64_t free_bodies, Observation& out) {
  out.contacts = 0;
  double gaps = 0;
  std::int64_t ends = 0;
  for (std::int64_t c = 0; c < contacts.contacts.size(); ++c) {
    const Contact& contact = contacts.contacts.view()[c];
    bool loaded = false;
    for (int k = 0; k < contact.count; ++k) {
      const ContactRow& row = contacts.rows.view()[contact.first_row + k];
      if (row.impulse.isZero(0)) continue;
      ++out.contacts;
      gaps += std::abs(row.gap);
      loaded = true;
    }
    if (loaded) ends += contact.free_ends;
  }
  out.gap_mean = out.contacts > 0 ? gaps / static_cast<double>(out.contacts) : 0.0;
  out.coordination_mean =
      free_bodies > 0 ? static_cast<double>(ends) / static_cast<double>(free_bodies) : 0.0;
}

void measure_penetration(const Manifolds& manifolds, const ConstBodyView& bodies, Penetration& out) {
  out = {};
  std::vector<double> depths;
  double sum = 0;
  double relative_sum = 0;
  const ManifoldHeader* const end = manifolds.headers.end();
  for (const ManifoldHeader* m = manifolds.headers.begin(); m != end;) {
    const std::int32_t i = m->i;
    const std::int32_t j = m->j;
    double depth = 0;
    for (; m != end && m->i == i && m->j == j; ++m) {
      for (int k = 0; k < m->count; ++k) depth = std::max(depth, -manifolds.points_of(*m)[k].gap);
    }
    if (depth <= 0) continue;
    const double relative = depth / std::min(smallest_size(bodies.shape[i], bodies.size[i]),
                                             smallest_size(bodies.shape[j], bodies.size[j]));
    depths.push_back(depth);
    sum += depth;
    relative_sum += relative;
    if (relative <= out.relative_max) continue;
    out.relative_max = relative;
    out.deepest = {static_cast<std::int32_t>(bodies.id[i]), static_cast<std::int32_t>(bodies.id[j])};
  }
  if (depths.empty()) return;
  const auto n = static_cast<double>(depths.size());
  // The smallest depth that at least 99 % of the pairs do not exceed.
  const auto rank = static_cast<std::ptrdiff_t>(std::ceil(0.99 * n)) - 1;
  std::nth_element(depths.begin(), depths.begin() + rank, depths.end());
  out.p99 = depths[static_cast<std::size_t>(rank)];
  out.max = *std::max_element(depths.begin(), depths.end());
  out.mean = sum / n;
  out.relative_mean = relative_sum / n;
}

}  // namespace scree
