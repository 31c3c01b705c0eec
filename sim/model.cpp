#include "sim/model.hpp"

#include "core/tolerances.hpp"

#include <algorithm>

namespace scree {

namespace {

Feature choose(const std::optional<bool>& asked, bool needed, const char* why_needed, const char* why_not) {
  if (asked) return {*asked, "the scene says so"};
  return {needed, needed ? why_needed : why_not};
}

template <class Predicate>
bool any_free_body(const BodyTable& bodies, Predicate predicate) {
  for (std::size_t k = 0; k < bodies.mobility.size(); ++k) {
    if (bodies.mobility[k] == Mobility::free && predicate(k)) return true;
  }
  return false;
}

}  // namespace

ModelPlan plan_model(const Scene& scene) {
  const auto any_law = [&scene](auto field) {
    return std::any_of(scene.laws.begin(), scene.laws.end(),
                       [field](const ContactLaw& law) { return law.*field > 0; });
  };
  const BodyTable& bodies = scene.bodies;
  ModelPlan plan;
  plan.friction = choose(scene.model.friction, any_law(&ContactLaw::friction), "some pair has friction",
                         "no pair has friction");
  plan.restitution = choose(scene.model.restitution, any_law(&ContactLaw::restitution), "some pair bounces",
                            "no pair bounces");
  const bool any_box = any_free_body(bodies, [&](std::size_t k) { return bodies.shape[k] == Shape::box; });
  const bool any_spin =
      std::any_of(bodies.spin.begin(), bodies.spin.end(), [](const Vec3& w) { return !w.isZero(0); });
  plan.rotation = choose(scene.model.rotation, any_box || any_spin || plan.friction.on,
                         any_box    ? "boxes turn"
                         : any_spin ? "some body spins"
                                    : "friction turns spheres",
                         "spheres without friction or spin never turn");
  const bool any_unequal =
      any_free_body(bodies, [&](std::size_t k) { return !has_equal_moments(bodies.inverse_inertia[k]); });
  plan.gyroscopic = {plan.rotation.on && any_unequal,
                     any_unequal ? "some box is no cube" : "only spheres and cubes move freely"};
  plan.continuous =
      choose(scene.model.continuous, true, "in substeps where some body is fast for the sizes", "");
  const double step = scene.time.step / scene.time.substeps.value_or(1);
  const double threshold = scene.response.mode == ResponseMode::accurate
                               ? tolerance::accurate_restitution_threshold
                               : tolerance::restitution_threshold;
  plan.restitution_threshold = scene.response.restitution_threshold
                                   ? RestitutionThreshold{.any = *scene.response.restitution_threshold}
                                   : RestitutionThreshold{.lossy = threshold * scene.gravity.norm() * step};
  return plan;
}

}  // namespace scree
