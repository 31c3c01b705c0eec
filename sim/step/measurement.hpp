// From the state to the quantities of an Observation.
#pragma once

#include "core/archive.hpp"
#include "core/bodies.hpp"
#include "sim/bodies/motion.hpp"
#include "sim/bodies/region.hpp"
#include "sim/observe/observation.hpp"

#include <cmath>
#include <vector>

namespace scree {

/// What the energies of a run are compared with: their values at t = 0, and the largest K + |U - U0| since
/// (U0 is the potential energy that the bodies which are there had when they appeared), but at least what
/// lifts every free body by its own size. A scene in which nothing moves would else be measured against the
/// rounding of its potential energy.
class EnergyBaseline {
 public:
  void start(const Energies& energies, double least_scale);
  /// A step was taken, or bodies have come or gone. `explained`: by ledger and exchange since t = 0 (J).
  void extend(const Energies& energies, double explained);
  /// Bodies came or went whose potential energy when they appeared was so much in sum (J).
  void exchange(double first_potential) { first_potential_ += first_potential; }
  /// What came or went unexplained between the last two states, by the scale; NaN if it is no number.
  double unexplained_change() const {
    return std::abs(unexplained_ - unexplained_before_) / (scale_ > 0 ? scale_ : 1);
  }
  double scale() const { return scale_; }
  double first_total() const { return first_total_; }
  void archive(Archive& archive);

 private:
  double first_total_ = 0;
  double first_potential_ = 0;
  double unexplained_ = 0, unexplained_before_ = 0;  // since t = 0
  double scale_ = 0;
};

/// What the total energy should have changed by since t = 0 (J).
double explained_energy(const Ledger& ledger, const Exchange& exchange);

/// Energies, momenta, speeds, and what ledger and exchange (already in `out`) do not explain. `totals` and
/// the exchange are about `reference`; the potential energy and the exchange reported are about the origin.
void measure_totals(const Totals& totals, const EnergyBaseline& baseline, const Vec3& gravity,
                    const Vec3& reference, Observation& out);

/// Of each region, from what it holds now and held one step before, and what it has taken out; `step` is its
/// length (s), 0 at t = 0.
void measure_regions(const std::vector<Region>& regions, const std::vector<RegionContents>& now,
                     const std::vector<RegionContents>& before, const std::vector<Removed>& removed,
                     double step, std::vector<RegionState>& out);

}  // namespace scree
