#include "sim/step/guarded_steps.hpp"

#include "core/tolerances.hpp"
#include "sim/step/step_failure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <new>
#include <utility>

namespace scree {

namespace {

BodyTable state_of(const Stepper& stepper) {
  BodyTable bodies;
  stepper.copy_state(bodies);
  return bodies;
}

double most_unexplained(const Scene& scene) {
  return scene.precision == Precision::mixed ? tolerance::unexplained_energy_mixed
                                             : tolerance::unexplained_energy;
}

}  // namespace

void GuardedSteps::start(const Stepper& stepper, double least_scale) {
  baseline_.start(stepper.energies(origin_), least_scale);
}

void GuardedSteps::take(std::int64_t step, double time, double length, const Exchange& exchange,
                        Stepper& stepper) {
  const StepStart before{baseline_, stepper.counters};
  try {
    take_once_or_twice(step, time, length, exchange, before, stepper);
  } catch (...) {
    undo(before, stepper);
    throw;
  }
}

void GuardedSteps::take_once_or_twice(std::int64_t step, double time, double length, const Exchange& exchange,
                                      const StepStart& before, Stepper& stepper) {
  const int n = scene_.time.substeps.value_or(substeps_.next());
  try {
    return take_in(n, step, length, exchange, stepper);
  } catch (const std::bad_alloc&) {
    throw;  // smaller substeps need as much memory
  } catch (const std::exception&) {
    undo(before, stepper);
  }
  ++stepper.counters.redone;
  const int more = tolerance::redo_substeps * n;
  try {
    take_in(more, step, length, exchange, stepper);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    const auto* failure = dynamic_cast<const StepFailure*>(&error);
    throw StepFailure(
        fmt::format("step {} at t = {} s failed, also when it was taken again in {} substeps: {}", step + 1,
                    time, more, error.what()),
        failure ? failure->bodies() : bodies_out_of_range(state_of(stepper)));
  }
}

void GuardedSteps::take_in(int substeps, std::int64_t step, double length, const Exchange& exchange,
                           Stepper& stepper) {
  const double h = length / substeps;
  double overlap = 0;
  stepper.start_step(step);
  for (int s = 0; s < substeps; ++s) {
    stepper.substep(h, s * h);
    overlap = std::max(overlap, stepper.overlap());
  }
  judge(exchange, stepper);
  if (!scene_.time.substeps) choose_substeps(substeps, overlap, stepper);
  stepper.counters.substeps += substeps;
}

void GuardedSteps::choose_substeps(int taken, double deepest, const Stepper& stepper) {
  // A step that was taken again may have more substeps than a step takes by itself.
  taken = std::min(taken, most_substeps(scene_.response.quality));
  const bool accurate = scene_.response.mode == ResponseMode::accurate;
  if (accurate || !stepper.has_heap()) return substeps_.judge(taken, deepest);
  substeps_.judge_heap(taken, deepest, [&stepper] { return stepper.overlaps_left(); });
}

/// Throws StepFailure if the run cannot go on from the state.
void GuardedSteps::judge(const Exchange& exchange, const Stepper& stepper) {
  const Energies energies = stepper.energies(origin_);
  extend_baseline(energies, exchange, stepper);
  if (energies.not_finite > 0)
    fail(bodies_out_of_range(state_of(stepper)),
         "no longer finite: its position or velocity is no finite number any more; try a smaller time.step");
  if (!(baseline_.unexplained_change() <= most_unexplained(scene_)))
    fail(by_kinetic_energy(state_of(stepper)),
         fmt::format(
             "the energy changed by {:.2g} of its scale without a known cause; the bodies named have the "
             "most kinetic energy; try a smaller time.step",
             baseline_.unexplained_change()));
  if (!scene_.world || scene_.world->leaving != Leaving::stop) return;
  std::vector<std::int32_t> out;
  for (const BodyNumber number : stepper.bodies_beyond(*scene_.world))
    out.push_back(static_cast<std::int32_t>(number));
  if (!out.empty())
    fail(
        out,
        "outside of the world; enlarge world, or set world.leaving=remove to take such bodies out and go on");
}

void GuardedSteps::fail(const std::vector<std::int32_t>& bodies, const std::string& how) const {
  throw StepFailure(fmt::format("{}: {}", words_for(bodies, scene_), how), bodies);
}

void GuardedSteps::change_bodies(double first_potential, const Exchange& exchange, const Stepper& stepper) {
  baseline_.exchange(first_potential);
  extend_baseline(stepper.energies(origin_), exchange, stepper);
}

void GuardedSteps::extend_baseline(const Energies& energies, const Exchange& exchange,
                                   const Stepper& stepper) {
  baseline_.extend(energies, explained_energy(stepper.ledger, exchange));
}

void GuardedSteps::undo(const StepStart& before, Stepper& stepper) {
  stepper.undo_step();
  baseline_ = before.baseline;
  stepper.counters = before.counters;
}

void GuardedSteps::archive(Archive& archive) {
  archive.part("substeps", substeps_);
  archive.part("baseline", baseline_);
}

}  // namespace scree
