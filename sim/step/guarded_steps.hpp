// Steps whose outcome is judged: a step that has failed is taken again in smaller substeps, and given up only
// if it fails again.
#pragma once

#include "core/archive.hpp"
#include "sim/model/substep_count.hpp"
#include "sim/scene/scene.hpp"
#include "sim/step/measurement.hpp"
#include "sim/step/stepper.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace scree {

class StepFailure;

class GuardedSteps {
 public:
  /// `scene` must outlive this object. Potential energies are relative to the point `origin`.
  GuardedSteps(const Scene& scene, const Vec3& origin)
      : scene_(scene), origin_(origin), substeps_(scene.response.quality) {}
  void start(const Stepper& stepper, double least_scale);

  /// Takes the step that starts at `time` and is `length` long (s). `exchange`: what bodies have brought and
  /// taken so far. Throws StepFailure if a body's state stops being finite, if energy comes or goes that the
  /// ledger does not explain, if a body leaves the world and the scene says to stop, or if the stepper
  /// throws; std::bad_alloc alone is passed on as it is. Whatever is thrown, the state and the energy
  /// accounts are then as they were.
  void take(std::int64_t step, double time, double length, const Exchange& exchange, Stepper& stepper);
  /// Must be called when bodies have come or gone between two steps. `first_potential`: the sum of the
  /// potential energies that the bodies which came had when they appeared, less that of the bodies which went
  /// (J); `exchange`: as for take().
  void change_bodies(double first_potential, const Exchange& exchange, const Stepper& stepper);

  const EnergyBaseline& baseline() const { return baseline_; }
  void archive(Archive& archive);

 private:
  /// The data that a step changes besides the state.
  struct StepStart {
    EnergyBaseline baseline;
    Counters counters;
  };

  void take_once_or_twice(std::int64_t step, double time, double length, const Exchange& exchange,
                          const StepStart& before, Stepper& stepper);
  void take_in(int substeps, std::int64_t step, double length, const Exchange& exchange, Stepper& stepper);
  void judge(const Exchange& exchange, const Stepper& stepper);
  void choose_substeps(int taken, double deepest, const Stepper& stepper);
  [[noreturn]] void fail(const std::vector<std::int32_t>& bodies, const std::string& how) const;
  void extend_baseline(const Energies& energies, const Exchange& exchange, const Stepper& stepper);
  void undo(const StepStart& before, Stepper& stepper);

  const Scene& scene_;
  Vec3 origin_;
  SubstepCount substeps_;
  EnergyBaseline baseline_;
};

}  // namespace scree
