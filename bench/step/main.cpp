// The benchmark of the steps of a settled scene: the time of a step, and its errors.
//
//   scree bench step SCENE [--settle S] [--steps N] [--within W] [--space auto|host|cuda] [--threads N]
//                          [--set key=value;...] [--calls no|yes]
//
// It runs until S seconds of simulated time have passed, then times N steps. It prints one JSON object:
// medians over these steps, the memory then in use in its space, and the state after the last step. Settling
// ends after W seconds of wall time even if S is not reached, and the timed steps end after W seconds too.
// With --calls yes, ten more steps follow in which each parallel call is waited for. They give the times of
// the calls and stages, which on Device cannot be separated otherwise.
#include "bench/options.hpp"
#include "core/error.hpp"
#include "core/space.hpp"
#include "core/timing.hpp"
#include "sim/record/build_info.hpp"
#include "sim/scene/reader.hpp"
#include "sim/step/simulation.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <sstream>

namespace {

using namespace scree;
using Clock = std::chrono::steady_clock;
using Json = nlohmann::ordered_json;

double median(std::vector<double> values) {
  if (values.empty()) return NAN;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

Scene scene_of(const std::string& file, const std::string& settings) {
  std::vector<Override> overrides;
  std::istringstream list(settings);
  for (std::string item; std::getline(list, item, ';');) {
    const std::size_t equals = item.find('=');
    if (equals == std::string::npos) throw InputError("--set " + item + ": needs key=value");
    overrides.push_back({item.substr(0, equals), item.substr(equals + 1)});
  }
  return read_scene(file, overrides);
}

SpaceChoice space_of(const std::string& name) {
  if (name == "auto") return SpaceChoice::automatic;
  if (name == "host") return SpaceChoice::host;
  if (name == "cuda") return SpaceChoice::cuda;
  throw InputError("--space " + name + ": auto, host or cuda");
}

double median_speed(const Simulation& simulation) {
  Snapshot snapshot;
  simulation.snapshot(snapshot);
  std::vector<double> speeds;
  for (std::size_t k = 0; k < snapshot.bodies.velocity.size(); ++k)
    if (snapshot.bodies.mobility[k] == Mobility::free) speeds.push_back(snapshot.bodies.velocity[k].norm());
  return median(std::move(speeds));
}

/// Returns the memory that the program uses in the space of that name, the one of `Spaces` that holds the
/// bodies.
template <class... Spaces>
MemoryUse memory_use_of(const std::string& space) {
  MemoryUse use;
  ((space == Spaces::name ? static_cast<void>(use = Spaces::memory_use()) : void()), ...);
  return use;
}

/// Returns the names of the processor and, if the bodies are on it, of the GPU.
std::string hardware_of(const std::string& space) {
  const MachineInfo machine = machine_info();
  const std::string host = fmt::format("{}, {} cores", machine.cpu, machine.cores);
  return space == Host::name ? host : device_info().name + " beside " + host;
}

/// Returns the times of the entries in ms per step.
Json per_step(const std::vector<timing::Entry>& list, double steps) {
  Json json;
  for (const timing::Entry& entry : list) json[entry.label] = 1e3 * entry.seconds / steps;
  return json;
}

/// Returns how often each of the entries came in a step.
Json times_per_step(const std::vector<timing::Entry>& list, double steps) {
  Json json;
  for (const timing::Entry& entry : list) json[entry.label] = static_cast<double>(entry.calls) / steps;
  return json;
}

/// Takes steps in which each parallel call is waited for, to measure its share; this makes the steps slower.
Json steps_by_calls(Simulation& simulation, int most) {
  const Counters before = simulation.observe(false).counters;
  timing::reset();
  timing::time_calls(true);
  const auto start = Clock::now();
  int steps = 0;
  for (; steps < most && !simulation.finished(); ++steps) simulation.step();
  const double total = seconds_since(start);
  timing::time_calls(false);
  const Counters& after = simulation.observe(false).counters;
  const auto each = [steps](std::int64_t more) { return static_cast<double>(more) / steps; };
  return {{"steps", steps},
          {"substeps", each(after.substeps - before.substeps)},
          {"sweeps", each(after.sweeps - before.sweeps)},
          {"pcs_made", each(after.pcs_made - before.pcs_made)},
          {"mean_ms", 1e3 * total / steps},
          {"stages_ms", per_step(timing::entries(), steps)},
          {"calls_ms", per_step(timing::calls(), steps)},
          {"calls", times_per_step(timing::calls(), steps)}};
}

/// Takes steps until the simulated time `until` (s), or until the wall time `within` (s) has passed.
void settle(Simulation& simulation, double until, double within) {
  const auto start = Clock::now();
  while (!simulation.finished() && simulation.time() < until && seconds_since(start) < within)
    simulation.step();
}

/// Returns the wall time of each of at most `most` steps (s), or of the steps that fit into the wall time
/// `within` (s).
std::vector<double> time_steps(Simulation& simulation, int most, double within) {
  std::vector<double> times;
  const auto start = Clock::now();
  while (!simulation.finished() && static_cast<int>(times.size()) < most && seconds_since(start) < within) {
    const auto begin = Clock::now();
    simulation.step();
    times.push_back(seconds_since(begin));
  }
  if (times.empty()) throw InputError("the scene ends before there is a step to time");
  return times;
}

/// Returns the results of the timed steps and the state after them. `before` holds the counters before these
/// steps.
Json results(const Scene& scene, Simulation& simulation, const std::vector<double>& times,
             const Counters& before) {
  const auto n = static_cast<double>(times.size());
  const Json stages = per_step(timing::entries(), n);
  const MemoryUse memory = memory_use_of<SCREE_SPACES>(simulation.space_name());
  const Observation& seen = simulation.observe();
  const double typical = median(times);
  return {{"scene", scene.name},
          {"space", simulation.space_name()},
          {"precision", scene.precision == Precision::mixed ? "mixed" : "double"},
          {"commit", build_info().commit},
          {"hardware", hardware_of(simulation.space_name())},
          {"bodies", seen.bodies},
          {"contacts", seen.contacts},
          {"pairs", seen.pairs},
          {"time", simulation.time()},
          {"steps", n},
          {"median_ms", 1e3 * typical},
          {"mean_ms", 1e3 * std::accumulate(times.begin(), times.end(), 0.0) / n},
          {"steps_per_s", 1 / typical},
          {"body_steps_per_s", static_cast<double>(seen.bodies) / typical},
          {"memory_bytes", memory.now},
          {"memory_peak_bytes", memory.peak},
          {"substeps", static_cast<double>(seen.counters.substeps - before.substeps) / n},
          {"sweeps", static_cast<double>(seen.counters.sweeps - before.sweeps) / n},
          {"unconverged", seen.counters.unconverged - before.unconverged},
          {"unfinished_impacts", seen.counters.unfinished_impacts - before.unfinished_impacts},
          {"impacts", static_cast<double>(seen.counters.impacts - before.impacts) / n},
          {"pcs_made", seen.counters.pcs_made - before.pcs_made},
          {"penetration_relative_mean", seen.penetration.relative_mean},
          {"penetration_relative_max", seen.penetration.relative_max},
          {"gap_mean", seen.gap_mean},
          {"speed_median", median_speed(simulation)},
          {"speed_rms", seen.speed_rms},
          {"speed_max", seen.speed_max},
          {"centre_z", seen.centre.z()},
          {"unexplained", seen.unexplained},
          {"state_hash", fmt::format("{:016x}", simulation.state_hash())},
          {"stages_ms", stages}};
}

int run(int argc, char** argv) {
  std::vector<std::string> words;
  const bench::Options options = bench::parse(argc, argv,
                                              {{"--settle", "0"},
                                               {"--steps", "100"},
                                               {"--within", "inf"},
                                               {"--space", "auto"},
                                               {"--threads", "0"},
                                               {"--set", ""},
                                               {"--calls", "no"}},
                                              &words);
  if (words.size() != 1) throw InputError("needs one scene; see --help");
  const double within = std::stod(options.at("--within"));
  const Scene scene = scene_of(words.front(), options.at("--set"));
  const auto building = Clock::now();
  Simulation simulation(scene, {.space = space_of(options.at("--space")),
                                .threads = std::stoi(options.at("--threads")),
                                .all_forces = false});
  const double built = seconds_since(building);
  const auto settling = Clock::now();
  settle(simulation, std::stod(options.at("--settle")), within);
  const double settled = seconds_since(settling);
  const std::int64_t first = simulation.steps();
  const Counters before = simulation.observe(false).counters;
  timing::reset();
  const std::vector<double> times = time_steps(simulation, std::stoi(options.at("--steps")), within);
  Json json = results(scene, simulation, times, before);
  json["built_s"] = built;
  json["settled_s"] = settled;
  json["settling_steps"] = first;
  if (options.at("--calls") == "yes") json["by_calls"] = steps_by_calls(simulation, 10);
  fmt::print("{}\n", json.dump(1));
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return scree::bench::status_of("scree_bench_step", [&] { return run(argc, argv); });
}
