// The quantities of an Observation, as computed from the state.
#pragma once

#include "core/archive.hpp"
#include "core/bodies.hpp"
#include "sim/bodies/motion.hpp"
#include "sim/bodies/region.hpp"
#include "sim/observe/observation.hpp"

#include <cmath>
#include <vector>

namespace scree {

/// The values with which the energies of a run are compared: the energies at t = 0, and the scale, which is
/// the largest K + |U - U0| since then (U0 is the potential energy that the bodies which are there had when
/// they appeared). The scale is at least the energy that lifts every free body by its smallest_size: else a
/// scene in which nothing moves would be measured against the rounding of its potential energy.
class EnergyBaseline {
 public:
  void start(const Energies& energies, double least_scale);
  /// Must be called when a step was taken, or when bodies have come or gone. `explained`: the change since
  /// the start that ledger and exchange explain (J).
  void extend(const Energies& energies, double explained);
  /// Must be called when bodies came or went. `first_potential`: the sum of the potential energies of those
  /// that came, when they appeared, less that of those that went (J).
  void exchange(double first_potential) { first_potential_ += first_potential; }
  /// Returns the energy that came or went unexplained between the last two states, divided by the scale; NaN
  /// if an energy is not finite.
  double unexplained_change() const {
    return std::abs(unexplained_ - unexplained_before_) / (scale_ > 0 ? scale_ : 1);
  }
  double scale() const { return scale_; }
  double first_total() const { return first_total_; }
  void archive(Archive& archive);

 private:
  double first_total_ = 0;
  double first_potential_ = 0;
  double unexplained_ = 0, unexplained_before_ = 0;  // energy since t = 0 (J)
  double scale_ = 0;
};

/// Returns the change of the total energy since t = 0 that ledger and exchange explain (J).
double explained_energy(const Ledger& ledger, const Exchange& exchange);

/// Computes energies, momenta, speeds, and the energy that ledger and exchange (already in `out`) do not
/// explain. `totals` and the exchange are relative to the point `reference`; the potential energy and the
/// exchange reported are relative to the origin.
void measure_totals(const Totals& totals, const EnergyBaseline& baseline, const Vec3& gravity,
                    const Vec3& reference, Observation& out);

/// Computes the state of each region from its contents now and one step before, and from the bodies that it
/// has removed; `step` is the length of that step (s), 0 at t = 0.
void measure_regions(const std::vector<Region>& regions, const std::vector<RegionContents>& now,
                     const std::vector<RegionContents>& before, const std::vector<Removed>& removed,
                     double step, std::vector<RegionState>& out);

}  // namespace scree
