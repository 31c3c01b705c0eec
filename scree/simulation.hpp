// A scene that runs: it is loaded, takes one step after the other, and is asked for its state in between.
// This is the library's interface, and the class with which the program takes its own steps. docs/library.md
// has an example.
#pragma once

#include "scree/body.hpp"
#include "scree/error.hpp"
#include "scree/options.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace scree {

// Only the program's own parts see into these: their headers are not installed.
class Archive;
struct BodyBox;
struct BodyState;
struct ContactForce;
struct ContactProblem;
struct GridOccupancy;
struct Observation;
struct Scene;
struct Snapshot;
using BodyPair = std::array<std::int32_t, 2>;

/// The version of the library: MAJOR.MINOR.PATCH.
std::string version();

/// Not for two threads at once: calls of one object need the caller's lock, the const ones too. Different
/// objects may be used by different threads. An object owns all it needs: files are read by the constructor
/// alone, and what is returned by value stays good after it.
class Simulation {
 public:
  /// Loads a scene file; docs/scene.md is its language. Throws InputError for what is wrong with the scene or
  /// with an override, and if `cuda` is asked for and there is none; std::bad_alloc.
  explicit Simulation(const std::filesystem::path& scene, const std::vector<Override>& overrides = {},
                      const SimulationOptions& options = {});
  /// The same from text; `name` stands for the file in messages, and files in the scene are looked for beside
  /// it.
  static Simulation from_text(const std::string& scene, const std::filesystem::path& name = "scene.yaml",
                              const std::vector<Override>& overrides = {},
                              const SimulationOptions& options = {});
  ~Simulation();
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;

  // Steps.

  /// One step of the scene's length; the last one ends at time.end exactly. A step that fails is taken again
  /// in smaller substeps; if it fails again, throws StepFailure, with the state as it was before the step: if
  /// a body's state stops being finite, if energy comes or goes that the ledger does not explain, if a body
  /// leaves the world and the scene says to stop, or if memory or the device give out. std::logic_error if
  /// finished().
  void step();
  bool finished() const;       ///< at time.end
  double time() const;         ///< simulated (s)
  std::int64_t steps() const;  ///< steps done
  std::int64_t steps_total() const;
  const char* space_name() const;  ///< where the bodies and their contacts are: "host" or "cuda"

  // The scene.

  const std::string& scene_name() const;
  /// The scene as YAML with every default and override written out; it loads as it is.
  const std::string& resolved_scene() const;
  /// The number of each body that has a name; those of a `repeat` are name[0], name[1], ...
  const std::map<std::string, std::int32_t>& body_names() const;

  // The state.

  /// A measure of the scene language, docs/scene.md#measures, in SI units: energy.unexplained,
  /// ball.position.z, region.exit.flux. NaN for a body that is not there. Throws InputError for a name that
  /// is none. Those of penetration and pairs cost about a step; all others are cheap.
  double measure(std::string_view name);
  /// All bodies of the scene, by their numbers, absent ones included.
  std::vector<Body> bodies() const;
  /// One of them. Throws InputError for a number that is none.
  Body read_body(std::int32_t id) const;
  /// The contacts that carried an impulse in the last substep, and its impacts; none before the first step,
  /// and none just after load_checkpoint().
  std::vector<LoadedContact> loaded_contacts() const;
  /// 64-bit hash of the state: the same for any number of threads, and for any broad phase. Each of the two
  /// ways to take a step has its own, and each space where the bodies stay.
  std::uint64_t state_hash() const;

  // Checkpoints.

  /// Saves what the next step starts from (HDF5). Throws RunError if it cannot be written.
  void save_checkpoint(const std::filesystem::path& file);
  /// Goes on from there with the same bits as if it had never stopped; takes the program's checkpoints too.
  /// Throws RunError if the file is not whole; InputError if it is of another scene, version or space, and
  /// says in what: the state is then as it was.
  void load_checkpoint(const std::filesystem::path& file);

  // For the program's own parts; none of this is promised.

  explicit Simulation(const Scene& scene, const SimulationOptions& options = {});
  const Scene& scene() const;
  /// Computed when asked for. `overlaps`: the penetration and the pairs too, which cost a narrow phase;
  /// without them those are NaN and -1.
  const Observation& observe(bool overlaps = true);
  void snapshot(Snapshot& out) const;
  BodyState body(std::int32_t id) const;
  /// What the next step starts from, as save_checkpoint() has it. Throws InputError if it is of another kind.
  void archive(Archive& archive);
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

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace scree
