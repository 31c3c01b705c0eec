// scree run --reproduce: runs a recorded run again and compares its states with those of its manifest.
#include "core/error.hpp"
#include "sim/cli/commands.hpp"
#include "sim/cli/console.hpp"
#include "sim/record/build_info.hpp"
#include "sim/record/manifest.hpp"
#include "sim/record/outcome.hpp"

#include <fmt/format.h>

namespace scree::cli {

int reproduce(const RunArguments& arguments) {
  const RecordedRun recorded = read_manifest(arguments.reproduce);
  const Scene scene = read_scene(arguments.reproduce.parent_path() / "scene.yaml", arguments.overrides);
  if (scene_hash_of(scene) != recorded.scene_hash)
    throw InputError(
        fmt::format("{}: scene.yaml beside it is not the scene of that run (its hash is {}, that of the run "
                    "{}); restore the file, or run the scene again",
                    arguments.reproduce.string(), scene_hash_of(scene), recorded.scene_hash));
  if (const std::string commit = build_info().commit; commit != recorded.commit)
    print_error(fmt::format(
        "warning: the run was made by commit {}, and this is {}: its states may differ for that reason alone",
        recorded.commit, commit));
  SimulationOptions options = arguments.simulation;
  if (options.space == SpaceChoice::automatic)
    options.space = recorded.space == "cuda" ? SpaceChoice::cuda : SpaceChoice::host;
  Simulation simulation(scene, options);
  std::int64_t different = 0;
  fmt::print("{:>10}  {:>10}  {:<16}  {:<16}\n", "step", "t", "recorded", "reproduced");
  for (const StateMark& state : recorded.states) {
    while (simulation.steps() < state.step && !simulation.finished()) simulation.step();
    const std::uint64_t hash = simulation.state_hash();
    const bool same = simulation.steps() == state.step && hash == state.hash;
    different += !same;
    fmt::print("{:>10}  {:>10.6g}  {}  {}{}\n", simulation.steps(), simulation.time(), hex(state.hash),
               hex(hash), same ? "" : "  DIFFERENT");
  }
  fmt::print("{} states, {} different{}\n", recorded.states.size(), different,
             different == 0 ? ": every state is the same to the last bit" : "");
  return different == 0 ? status_done : status_check_failed;
}

}  // namespace scree::cli
