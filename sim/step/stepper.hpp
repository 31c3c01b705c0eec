// The interface between a running scene and the class that takes its bodies through a step: their state, the
// step, and inspection of pairs and contacts. It is free of Thrust, so that any part of the program can
// include it.
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

/// A body as it is now, and the effect of the last step on it.
struct SteppedBody {
  Mobility mobility;
  double inverse_mass;  ///< 1/kg
  Vec3 position;        ///< m
  Quat orientation;
  Vec3 velocity;         ///< m/s
  Vec3 spin;             ///< rad/s
  Vec3 velocity_before;  ///< velocity at the start of the step (m/s)
  Vec3 acceleration;     ///< acceleration of a free body over the step by gravity and applied forces (m/s^2)
  Vec3 contact_impulse;  ///< impulse over the step on a body that is not free (N s)
  Vec3 contact_moment;   ///< moment of these impulses about the centre of a triangle (N m s)
};

/// The bodies between two steps. They are known by their numbers, whatever places and space they are in.
class StepState {
 public:
  virtual ~StepState() = default;

  virtual void copy_state(BodyTable& out) const = 0;  ///< copies the bodies in the order of numbers
  virtual SteppedBody body(BodyNumber number) const = 0;
  virtual Vec3 gravity() const = 0;  ///< gravity of the last substep, or of the start (m/s^2)
  virtual Energies energies(const Vec3& reference) const = 0;
  virtual Totals totals(const Vec3& reference) const = 0;
  virtual double largest_speed() const = 0;
  virtual RegionContents contents_of(const Region& region) const = 0;
  /// Returns the free bodies whose centre is outside of the world, in the order of their numbers.
  virtual std::vector<BodyNumber> bodies_beyond(const World& world) const = 0;
  /// Returns the free bodies whose centre is in a region, in the order of their numbers.
  virtual std::vector<BodyNumber> bodies_in(const Region& region) const = 0;
  /// Returns the bodies that are present and may reach into a box (m), planes and tubes included.
  virtual BodyTable bodies_near(const Vec3& low, const Vec3& high) const = 0;

  /// Lets the caller change which bodies are present, and their data. It may copy all of them to Host and
  /// back.
  virtual void change_bodies(const std::function<void(Bodies<Host>&)>& change) = 0;
  /// Removes a few bodies and returns them as they were.
  virtual BodyTable take_out(const std::vector<BodyNumber>& numbers) = 0;
  /// Brings in a few bodies.
  virtual void bring_in(const BodyTable& bodies) = 0;
};

/// The step itself: free flight, impacts, contacts, impulses and correction, substep by substep.
class Step {
 public:
  virtual ~Step() = default;

  /// Must be called at the start of each step: saves the state, which is that of `step`, and sets the forces
  /// that act from there to the next.
  virtual void start_step(std::int64_t step) = 0;
  /// Takes a substep of length h (s), after `done` (s) of the step. Throws RunError if it cannot be taken.
  virtual void substep(double h, double done) = 0;
  /// Returns the deepest overlap that the last substep found, before position correction (of the smaller
  /// body's smallest_size).
  virtual double overlap() const = 0;
  /// Returns whether the last substep has so many contact points that it counts as a heap (is_heap()).
  virtual bool has_heap() const = 0;
  /// Returns the overlaps of the present state, among the pairs of the last substep.
  virtual OverlapsLeft overlaps_left() const = 0;
  /// Restores the state at the start of the step, ledger included. All pairs, contacts and impulses of
  /// earlier steps are forgotten, because the step that failed may have spoilt them.
  virtual void undo_step() = 0;

  Ledger ledger;
  Counters counters;
};

/// The inspection of pairs and contacts, for observers of a run. It costs nothing unless it is used, and it
/// changes no result.
class StepInspection {
 public:
  virtual ~StepInspection() = default;

  /// Returns the pairs that may touch in the present state.
  virtual std::vector<BodyPair> pairs() = 0;
  virtual GridOccupancy grid_occupancy() = 0;
  /// Returns the boxes in which the last broad phase looked for pairs, in the order of the bodies' numbers.
  virtual std::vector<BodyBox> boxes() const = 0;
  /// Measures the penetration, and the size of the PCS.
  virtual void measure_overlaps(Observation& out) = 0;

  /// Returns the contact problem that the response solved in the last substep.
  virtual ContactProblem contact_problem() const = 0;
  /// Returns the contacts of the last substep that carried a force, and its impacts.
  virtual std::vector<ContactForce> contact_forces() const = 0;
  /// Counts the contacts that carried a force, and finds their mean gap.
  virtual void measure_contacts(std::int64_t free_bodies, Observation& out) const = 0;

  virtual const char* space_name() const = 0;  ///< space of the broad phase
};

/// The bodies of a running scene and the stages that move them, in whatever space they are.
class Stepper : public StepState, public Step, public StepInspection {
 public:
  /// Saves or loads the data that the next step starts from. The contacts of the last substep are not part of
  /// it: after loading there are none until the next substep.
  virtual void archive(Archive& archive) = 0;
};

}  // namespace scree
