// Gravity that changes with time.
#pragma once

#include "core/archive.hpp"
#include "core/bodies.hpp"
#include "sim/laws/response_parameters.hpp"
#include "sim/scene/scene.hpp"

#include <optional>

namespace scree {

/// Gravity that may turn. Each substep has the gravity of its midpoint. Between two substeps the potential
/// energy changes while the bodies stay where they are, and this change is the work of what turns gravity: in
/// such scenes potential energies are relative to the world's origin. This costs nothing if gravity is
/// constant.
class TurningGravity {
 public:
  explicit TurningGravity(const Scene& scene) : at_start_(scene.gravity), turn_(scene.gravity_turn) {}

  bool turns() const { return turn_.has_value(); }
  /// Must be called at the start of a step.
  void start_step() { kick_.setZero(); }
  /// Sets the gravity of the substep with this midpoint (s). Returns the work done (J).
  template <class Space>
  double turn_to(double midpoint, const Bodies<Space>& bodies, ResponseParameters& parameters) const;
  /// Must be called when a substep of length h (s) is over.
  void count(double h, const ResponseParameters& parameters) { kick_ += h * parameters.gravity; }
  /// Returns the mean gravity over the step of this length (s), less the gravity of its last substep (m/s^2).
  Vec3 excess_of_mean(double length, const ResponseParameters& parameters) const {
    return turns() ? Vec3(kick_ / length - parameters.gravity) : Vec3(Vec3::Zero());
  }

  void archive(Archive& archive, ResponseParameters& parameters) {
    if (!turns()) return;
    archive("gravity", parameters.gravity);
    archive("gravity_kick", kick_);
  }

 private:
  Vec3 at_start_;
  std::optional<GravityTurn> turn_;
  Vec3 kick_ = Vec3::Zero();  // integral of gravity over the step so far (m/s)
};

}  // namespace scree
