// The features of the model that a scene needs, and those that cannot matter in it.
#pragma once

#include "sim/laws/restitution.hpp"
#include "sim/scene/scene.hpp"

#include <string>
#include <vector>

namespace scree {

/// One feature of the model: whether it is computed or left out, and why.
struct Feature {
  const char* name;
  bool on;
  std::string reason;
};

/// Leaving a feature out where its reason holds changes no result (docs/accuracy.md has what each saves).
struct ModelPlan {
  Feature friction;          ///< tangential impulses
  Feature rolling_friction;  ///< couples against rolling
  Feature restitution;       ///< impacts that bounce
  Feature rotation;          ///< orientations
  Feature gyroscopic;        ///< free rotation of bodies with unequal moments of inertia
  Feature continuous;        ///< impacts at their own time between bodies that would go deep in a substep
  Feature gravity;           ///< weight, and potential energy
  Feature levels;            ///< more than one level of the hierarchical grid
  RestitutionThreshold restitution_threshold;

  std::vector<Feature> features() const {
    return {rotation, gyroscopic, friction, rolling_friction, restitution, continuous, gravity, levels};
  }
};

ModelPlan plan_model(const Scene& scene);

/// Returns the largest number of substeps that a step takes if the scene leaves their number open.
int most_substeps(const Scene& scene);

}  // namespace scree
