// A running scene: the step in order. Free of Thrust, so that every part of the program can include it.
#pragma once

#include "core/archive.hpp"
#include "core/snapshot.hpp"
#include "sim/inspection.hpp"
#include "sim/observation.hpp"
#include "sim/scene/scene.hpp"

#include <cstdint>
#include <memory>
#include <vector>

namespace scree {

enum class SpaceChoice { automatic, host, cuda };

struct SimulationOptions {
  /// automatic: Device if the machine has one and the scene has bodies enough for it, else Host.
  SpaceChoice space = SpaceChoice::automatic;
  int threads = 0;        ///< 0: all cores. Never changes the result.
  bool resident = false;  ///< Host too takes the steps as Device does, with everything in one space
};

class Simulation {
 public:
  /// Throws InputError if `cuda` is asked for and there is none.
  explicit Simulation(const Scene& scene, const SimulationOptions& options = {});
  ~Simulation();
  Simulation(Simulation&&) noexcept;

  /// One step of the scene's length; the last one ends at time.end exactly. A step that fails is taken again
  /// in smaller substeps; if it fails again, throws StepFailure, with the state as it was before the step: if
  /// a body's state stops being finite, if energy comes or goes that the ledger does not explain, if a body
  /// leaves the world and the scene says to stop, or if memory or the device give out.
  void step();
  bool finished() const;

  double time() const;         ///< s
  std::int64_t steps() const;  ///< steps done
  std::int64_t steps_total() const;
  const char* space_name() const;  ///< where the bodies and their contacts are: "host" or "cuda"

  /// Saves what the next step starts from, or loads it, into a simulation of the same scene that takes its
  /// steps in the same way and space: it goes on with the same bits as if it had never stopped. The contacts
  /// of the last step are not among it: contact_forces() and contact_problem() find none before the next.
  /// Throws InputError if the state is of another kind.
  void archive(Archive& archive);

  /// The whole state, on the host.
  void snapshot(Snapshot& out) const;
  /// 64-bit hash of the state: the same for any number of threads, and for any broad phase. Each of the two
  /// ways to take a step has its own, and each space where the bodies stay.
  std::uint64_t state_hash() const;
  BodyState body(std::int32_t id) const;
  /// The pairs of the last step's broad phase (before the first step, of the start), each once.
  std::vector<BodyPair> pairs();
  /// The boxes in which the last broad phase looked for pairs, by body; none before the first step.
  std::vector<BodyBox> boxes() const;
  /// The contacts of the last substep that carried a force.
  std::vector<ContactForce> contact_forces() const;
  /// What the response had to solve in the last substep, and its answer; empty before the first step.
  ContactProblem contact_problem() const;
  /// The grid behind pairs().
  GridOccupancy grid_occupancy();

  /// Computed when asked for. `overlaps`: the penetration and the pairs too, which cost a narrow phase;
  /// without them those are NaN and -1.
  const Observation& observe(bool overlaps = true);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace scree
