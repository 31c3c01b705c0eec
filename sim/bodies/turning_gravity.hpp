// Gravity that changes with time.
#pragma once

#include "core/archive.hpp"
#include "core/bodies.hpp"
#include "sim/laws/response_parameters.hpp"
#include "sim/scene/scene.hpp"

#include <optional>

namespace scree {

/// In each substep it is that of the midpoint. Between two substeps the potential energy changes where the
/// bodies are, which is work of what turns it: potential energy is about the world's origin in such scenes.
/// Costs nothing where gravity is constant.
class TurningGravity {
 public:
  explicit TurningGravity(const Scene& scene) : at_start_(scene.gravity), turn_(scene.gravity_turn) {}

  bool turns() const { return turn_.has_value(); }
  /// A step begins.
  void start_step() { kick_.setZero(); }
  /// Sets the gravity of the substep around a time (s). Returns the work done (J).
  template <class Space>
  double turn_to(double midpoint, const Bodies<Space>& bodies, ResponseParameters& parameters) const;
  /// The substep, of such a length (s), is over.
  void count(double h, const ResponseParameters& parameters) { kick_ += h * parameters.gravity; }
  /// By how much the mean over the step, of such a length (s), exceeds that of its last substep (m/s^2).
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
  Vec3 kick_ = Vec3::Zero();  // in the step so far (m/s)
};

}  // namespace scree
