// What a running scene asks of whoever takes its bodies through a step: their state, the step, and a look at
// pairs and contacts. Free of Thrust, so that any part of the program can include it.
#pragma once

#include "core/archive.hpp"
#include "core/bodies.hpp"
#include "sim/bodies/motion.hpp"
#include "sim/bodies/region.hpp"
#include "sim/model/substep_count.hpp"
#include "sim/observe/inspection.hpp"
#include "sim/observe/observation.hpp"
#include "sim/scene/scene.hpp"

#include <cstdint>
#include <functional>
#include <vector>

namespace scree {

/// A body as it is now, and what the last step did to it.
struct SteppedBody {
  Mobility mobility;
  double inverse_mass;  ///< 1/kg
  Vec3 position;        ///< m
  Quat orientation;
  Vec3 velocity;         ///< m/s
  Vec3 spin;             ///< rad/s
  Vec3 velocity_before;  ///< at the start of the step (m/s)
  Vec3 acceleration;     ///< by gravity and applied forces over the step, of a free body (m/s^2)
  Vec3 contact_impulse;  ///< over the step, on a body that is not free (N s)
  Vec3 contact_moment;   ///< of these impulses about its centre, on a triangle (N m s)
};

/// The bodies between two steps. They are known by their numbers, in whatever places and space they lie.
class StepState {
 public:
  virtual ~StepState() = default;

  virtual void copy_state(BodyTable& out) const = 0;  ///< in the order of numbers
  virtual SteppedBody body(BodyNumber number) const = 0;
  virtual Vec3 gravity() const = 0;  ///< of the last substep, or of the start (m/s^2)
  virtual Energies energies(const Vec3& reference) const = 0;
  virtual Totals totals(const Vec3& reference) const = 0;
  virtual double largest_speed() const = 0;
  virtual RegionContents contents_of(const Region& region) const = 0;
  /// The free bodies whose centre is outside of the world, in the order of their numbers.
  virtual std::vector<BodyNumber> bodies_beyond(const World& world) const = 0;
  /// The free bodies whose centre is in a region, in the order of their numbers.
  virtual std::vector<BodyNumber> bodies_in(const Region& region) const = 0;
  /// The bodies that are there and may reach into a box (m), planes and tubes included.
  virtual BodyTable bodies_near(const Vec3& low, const Vec3& high) const = 0;

  /// Lets bodies come, go, or become others. It may copy all of them to Host and back.
  virtual void change_bodies(const std::function<void(Bodies<Host>&)>& change) = 0;
  /// Takes out bodies, which are few, and returns them as they were.
  virtual BodyTable take_out(const std::vector<BodyNumber>& numbers) = 0;
  /// Brings in bodies, which are few.
  virtual void bring_in(const BodyTable& bodies) = 0;
};

/// The step itself: free flight, impacts, contacts, impulses and correction, substep by substep.
class Step {
 public:
  virtual ~Step() = default;

  /// To be called at the start of each step: keeps the state, which is that of `step`, and sets the forces
  /// that act from there to the next.
  virtual void start_step(std::int64_t step) = 0;
  /// A substep of length h (s), after `done` of the step went by (s). Throws RunError where it cannot go on.
  virtual void substep(double h, double done) = 0;
  /// Deepest overlap that the last substep found (of the smaller body's smallest_size).
  virtual double overlap() const = 0;
  /// Whether its contacts are so many that they are a heap (is_heap()).
  virtual bool has_heap() const = 0;
  /// Overlaps of the state as it is, which are looked for among the pairs of the last substep.
  virtual OverlapsLeft overlaps_left() const = 0;
  /// Back to the state at the start of the step, ledger included. What the steps before have left of pairs,
  /// contacts and impulses is forgotten: the step that failed may have spoilt it.
  virtual void undo_step() = 0;

  Ledger ledger;
  Counters counters;
};

/// What is asked of pairs and contacts by whoever watches a run. Who does not ask pays nothing, and asking
/// changes nothing.
class StepInspection {
 public:
  virtual ~StepInspection() = default;

  /// The pairs that may touch, for the state as it is.
  virtual std::vector<BodyPair> pairs() = 0;
  virtual GridOccupancy grid_occupancy() = 0;
  /// The boxes in which the last broad phase looked for pairs, in the order of the bodies' numbers.
  virtual std::vector<BodyBox> boxes() const = 0;
  /// The penetration, and the size of the PCS.
  virtual void measure_overlaps(Observation& out) = 0;

  /// The contacts of the last substep that the response has solved.
  virtual ContactProblem contact_problem() const = 0;
  /// Those of them that carried a force, and the impacts.
  virtual std::vector<ContactForce> contact_forces() const = 0;
  /// Counts and gaps of the contacts that carried a force.
  virtual void measure_contacts(std::int64_t free_bodies, Observation& out) const = 0;

  virtual const char* space_name() const = 0;  ///< of the broad phase
};

/// A running scene's bodies and the stages that move them, in whatever space they are.
class Stepper : public StepState, public Step, public StepInspection {
 public:
  /// What the next step starts from. The contacts of the last substep are not among it: after loading there
  /// are none until the next.
  virtual void archive(Archive& archive) = 0;
};

}  // namespace scree
