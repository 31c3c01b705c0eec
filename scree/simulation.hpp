// A running scene: it is loaded, takes one step after another, and gives its state in between. This is the
// library's interface, and the class with which the program takes its own steps. docs/library.md has an
// example.
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

// These types are defined for the program's own parts alone: their headers are not installed.
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

/// Returns the version of the library: MAJOR.MINOR.PATCH.
std::string version();

/// A running scene. An object may not be used by two threads at once: callers must lock its calls, the const
/// ones too. Different objects may be used by different threads, but only one at a time of those that run on
/// a GPU. An object owns all that it needs: files are read by the constructor alone, and what is returned by
/// value stays valid after the object is gone.
class Simulation {
 public:
  /// Loads a scene file, whose language is described in docs/scene.md. Throws InputError for errors in the
  /// scene or in an override, and if `cuda` is requested but there is none; std::bad_alloc.
  explicit Simulation(const std::filesystem::path& scene, const std::vector<Override>& overrides = {},
                      const SimulationOptions& options = {});
  /// Loads a scene from text. `name` is used as the file's name in messages, and files named in the scene are
  /// searched for beside it.
  static Simulation from_text(const std::string& scene, const std::filesystem::path& name = "scene.yaml",
                              const std::vector<Override>& overrides = {},
                              const SimulationOptions& options = {});
  ~Simulation();
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;

  // Steps.

  /// Takes one step of the scene's length; the last one ends at time.end exactly. A step that fails is taken
  /// again in smaller substeps. If it fails again, throws StepFailure, with the state as it was before the
  /// step: if a body's state stops being finite, if energy comes or goes that the ledger does not explain, if
  /// a body leaves the world and the scene says to stop, or if the device fails. Throws std::bad_alloc if
  /// memory runs out, with the state as before too; std::logic_error if finished().
  void step();
  bool finished() const;       ///< whether time.end is reached
  double time() const;         ///< simulated time (s)
  std::int64_t steps() const;  ///< number of steps taken
  std::int64_t steps_total() const;
  const char* space_name() const;  ///< space of the bodies and their contacts: "host" or "cuda"

  // The scene.

  const std::string& scene_name() const;
  /// Returns the scene as YAML with defaults (but not `response.quality` at 1) and overrides written out; it
  /// can be loaded as it is.
  const std::string& resolved_scene() const;
  /// Returns the number of each body that has a name; bodies of a `repeat` are named name[0], name[1], ...
  const std::map<std::string, std::int32_t>& body_names() const;

  // The state.

  /// Returns a measure of the scene language, docs/scene.md#measures, in SI units: energy.unexplained,
  /// ball.position.z, region.exit.flux. The result is NaN for a body that is absent. Throws InputError if
  /// there is no measure of that name. Measures of penetration and pairs cost about as much as a step; all
  /// others are cheap.
  double measure(std::string_view name);
  /// Returns all bodies of the scene, by their numbers, absent ones included.
  std::vector<Body> bodies() const;
  /// Returns one body. Throws InputError if there is no body of that number.
  Body read_body(std::int32_t id) const;
  /// Returns the contacts that carried an impulse in the last substep, and its impacts; none before the first
  /// step, and none just after load_checkpoint().
  std::vector<LoadedContact> loaded_contacts() const;
  /// Returns a 64-bit hash of the state. It does not depend on the number of threads, nor on the broad phase.
  /// It differs between double and mixed precision, and between the spaces in which the bodies are.
  std::uint64_t state_hash() const;

  // Checkpoints.

  /// Saves all that the next step starts from (HDF5). Throws RunError if the file cannot be written.
  void save_checkpoint(const std::filesystem::path& file);
  /// Continues from a checkpoint with the same bits as if the run had never stopped; the program's
  /// checkpoints are accepted too. Throws RunError if the file is not complete; throws InputError if it is of
  /// another scene, version or space, and says in what it differs, or if a field is missing or not valid. The
  /// state is then as it was.
  void load_checkpoint(const std::filesystem::path& file);

  // For the program's own parts; this interface may change at any time.

  explicit Simulation(const Scene& scene, const SimulationOptions& options = {});
  const Scene& scene() const;
  /// Returns the observation of the present state, which is computed on request. `overlaps`: includes the
  /// penetration and the pairs, which cost a narrow phase; else these are NaN and -1.
  const Observation& observe(bool overlaps = true);
  void snapshot(Snapshot& out) const;
  BodyState body(std::int32_t id) const;
  /// Saves or loads all that the next step starts from, as in save_checkpoint(). Throws InputError if a saved
  /// state is of another kind.
  void archive(Archive& archive);
  /// Returns the candidate pairs for the present state without planes, each once.
  std::vector<BodyPair> pairs();
  /// Returns the boxes in which the last broad phase searched for pairs, by body; none before the first step.
  std::vector<BodyBox> boxes() const;
  /// Returns the contacts of the last substep that carried a force, and its impacts.
  std::vector<ContactForce> contact_forces() const;
  /// Returns the contact problem of the last substep, with the impulses that the response found; empty before
  /// the first step.
  ContactProblem contact_problem() const;
  /// Returns the occupied cells of the grid with which pairs() are found.
  GridOccupancy grid_occupancy();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace scree
