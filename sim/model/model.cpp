#include "sim/model/model.hpp"

#include "broadphase/bounds.hpp"
#include "broadphase/grid_plan.hpp"
#include "core/tolerances.hpp"
#include "sim/model/substep_count.hpp"
#include "sim/scene/motion_bounds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace scree {

namespace {

Feature choose(const char* name, const std::optional<bool>& asked, bool needed, const char* why_needed,
               const char* why_not) {
  if (asked) return {name, *asked, "the scene says so"};
  return {name, needed, needed ? why_needed : why_not};
}

template <class Predicate>
bool any_free_body(const BodyTable& bodies, Predicate predicate) {
  for (std::size_t k = 0; k < bodies.mobility.size(); ++k) {
    if (bodies.mobility[k] == Mobility::free && predicate(k)) return true;
  }
  return false;
}

/// Returns the width of the cells of each level (m), for the bodies as they start and without margins.
std::vector<double> cell_widths(const Scene& scene) {
  Bodies<Host> bodies;
  copy_bodies(bodies, scene.bodies);
  Array<double, Host> margin;
  margin.resize(bodies.count());
  std::ranges::fill(margin.view(), 0.0);
  Array<Aabb, Host> bounds;
  bounds.resize(bodies.count());
  compute_bounds<Host>(view_of(std::as_const(bodies)), margin.view(), {}, Vec3::Zero(), bounds.view());
  const Census census = take_census<Host>(std::as_const(bounds).view());
  const SizeHistogram sizes = count_sizes<Host>(std::as_const(bounds).view(), census);
  std::vector<double> widths;
  for (const GridLevel& level : plan_grid(census, sizes, grid_costs<Host>, scene.broadphase.levels).levels)
    widths.push_back(level.cell);
  return widths;
}

Feature plan_levels(const Scene& scene) {
  constexpr const char* name = "levels";
  if (scene.broadphase.method != BroadPhaseMethod::hierarchical_grid)
    return {name, false, "the broad phase is another"};
  const std::vector<double> widths = cell_widths(scene);
  if (widths.empty()) return {name, false, "planes alone"};
  const char* why = scene.broadphase.levels > 0 ? ", as the scene says" : "";
  if (widths.size() == 1)
    return {name, false, fmt::format("one grid serves all sizes, cells of {:.3g} m{}", widths[0], why)};
  return {name, true,
          fmt::format("{} grids for the sizes, cells of {:.3g} to {:.3g} m{}", widths.size(), widths.front(),
                      widths.back(), why)};
}

/// Decides on rolling friction, which is needed if a pair of materials has it and one of the two has round
/// bodies that turn.
Feature plan_rolling_friction(const Scene& scene, bool rotation) {
  const BodyTable& bodies = scene.bodies;
  const std::size_t materials = scene.materials.size();
  std::vector<bool> round(materials);
  for (std::size_t k = 0; k < bodies.shape.size(); ++k) {
    if (std::isfinite(rolling_radius(bodies.shape[k], bodies.size[k])))
      round[static_cast<std::size_t>(bodies.material[k])] = true;
  }
  bool any_law = false;
  bool any_rolls = false;
  for (std::size_t pair = 0; pair < scene.laws.size(); ++pair) {
    if (!(scene.laws[pair].rolling_friction > 0)) continue;
    any_law = true;
    any_rolls = any_rolls || round[pair / materials] || round[pair % materials];
  }
  return choose("rolling_friction", scene.model.rolling_friction, any_rolls && rotation,
                "some pair has rolling friction",
                !any_law    ? "no pair has rolling friction"
                : !rotation ? "nothing turns"
                            : "nothing of the materials that have it is round");
}

/// Returns the largest acceleration that brings a body back from a bounce (m/s^2): gravity, or a servo's
/// drive.
double pressing_acceleration(const Scene& scene) {
  double largest = largest_gravity(scene);
  for (const Servo& servo : scene.servos) {
    const double inverse_mass = scene.bodies.inverse_mass[static_cast<std::size_t>(servo.body)];
    largest = std::max(largest, std::abs(servo.force) * inverse_mass);
  }
  return largest;
}

}  // namespace

ModelPlan plan_model(const Scene& scene) {
  const auto any_law = [&scene](auto field) {
    return std::any_of(scene.laws.begin(), scene.laws.end(),
                       [field](const ContactLaw& law) { return law.*field > 0; });
  };
  const BodyTable& bodies = scene.bodies;
  const bool any_box = any_free_body(bodies, [&](std::size_t k) { return bodies.shape[k] == Shape::box; });
  const bool any_general = any_free_body(bodies, [&](std::size_t k) { return is_general(bodies.shape[k]); });
  const bool any_spin =
      std::any_of(bodies.spin.begin(), bodies.spin.end(), [](const Vec3& w) { return !w.isZero(0); });
  const bool any_torque = std::any_of(scene.forces.begin(), scene.forces.end(),
                                      [](const AppliedForce& force) { return !force.torque.isZero(0); });
  const bool any_unequal =
      any_free_body(bodies, [&](std::size_t k) { return !has_equal_moments(bodies.inverse_inertia[k]); });
  const double gravity = largest_gravity(scene);
  // The members are set one by one: if the value of a member of an aggregate throws, GCC 12 destroys the
  // members before it twice.
  ModelPlan plan;
  plan.friction = choose("friction", scene.model.friction, any_law(&ContactLaw::friction),
                         "some pair has friction", "no pair has friction");
  plan.restitution = choose("restitution", scene.model.restitution, any_law(&ContactLaw::restitution),
                            "some pair bounces", "no pair bounces");
  plan.continuous = choose("continuous", scene.model.continuous, true,
                           "in substeps in which a body moves far for its size", "");
  plan.gravity = {"gravity", gravity > 0,
                  gravity == 0         ? "none"
                  : scene.gravity_turn ? "bodies have weight, which turns"
                                       : "bodies have weight"};
  plan.levels = plan_levels(scene);
  plan.rotation = choose("rotation", scene.model.rotation,
                         any_box || any_general || any_spin || any_torque || plan.friction.on,
                         any_box       ? "boxes turn"
                         : any_general ? "bodies that are no spheres turn"
                         : any_spin    ? "some body spins"
                         : any_torque  ? "a torque acts"
                                       : "friction turns spheres",
                         "spheres without friction, spin or torque never turn");
  plan.rolling_friction = plan_rolling_friction(scene, plan.rotation.on);
  plan.gyroscopic = {"gyroscopic", plan.rotation.on && any_unequal,
                     !any_unequal ? "only spheres and cubes move freely"
                     : plan.rotation.on
                         ? any_general ? "some body has unequal moments" : "some box is no cube"
                         : "nothing turns"};
  const double step = scene.time.step / scene.time.substeps.value_or(1);
  const double threshold = scene.response.mode == ResponseMode::accurate
                               ? tolerance::accurate_restitution_threshold
                               : tolerance::restitution_threshold;
  plan.restitution_threshold =
      scene.response.restitution_threshold
          ? RestitutionThreshold{.any = *scene.response.restitution_threshold}
          : RestitutionThreshold{.lossy = threshold * pressing_acceleration(scene) * step};
  return plan;
}

int most_substeps(const Scene& scene) { return most_substeps(scene.response.quality); }

}  // namespace scree
