#include "sim/step/measurement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
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
  const double fourth_of_equal = totals.speed_squared * totals.speed_squared;
  // 0 / 0 is a NaN with a sign on some processors, which metrics.csv would show.
  out.speed_kurtosis = fourth_of_equal > 0 ? count * totals.speed_fourth / fourth_of_equal
                                           : std::numeric_limits<double>::quiet_NaN();
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

}  // namespace scree
