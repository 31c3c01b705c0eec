#include "sim/model/resolved_response.hpp"

#include "sim/bodies/prescribed.hpp"
#include "sim/model/model.hpp"

namespace scree {

ResponseParameters response_parameters_of(const Scene& scene) {
  const ModelPlan plan = plan_model(scene);
  return {.gravity = scene.gravity,
          .acceleration = {},
          .torque = {},
          .guides = {},
          .prescribed_acceleration = prescribed_acceleration(scene),
          .friction = plan.friction.on,
          .rolling_friction = plan.rolling_friction.on,
          .restitution = plan.restitution.on,
          .rotation = plan.rotation.on,
          .gyroscopic = plan.gyroscopic.on,
          .continuous = plan.continuous.on,
          .warm_start = scene.response.warm_start,
          .accurate = scene.response.mode == ResponseMode::accurate,
          .quality = scene.response.quality,
          .iterations = scene.response.iterations.value_or(0),
          .block_sweeps = scene.response.block_sweeps.value_or(0),
          .tolerance = scene.response.tolerance.value_or(0),
          .restitution_threshold = plan.restitution_threshold};
}

std::vector<PairLaw> pair_laws_of(const Scene& scene) {
  std::vector<PairLaw> table;
  for (const ContactLaw& law : scene.laws)
    table.push_back({law.restitution, law.friction, law.rolling_friction});
  return table;
}

}  // namespace scree
