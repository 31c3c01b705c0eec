// The program that runs one case in one engine, and prints the errors and the costs as one line of JSON.
//
//   scree_bench_peers --case pile --engine bullet [--setting default] [--step 0.004166666666666667]
//
// Times are CPU times of the process, which works with one thread. bench/peers/run calls this program for a
// whole table.
#include "bench/clock.hpp"
#include "bench/peers/cases.hpp"
#include "bench/peers/engine.hpp"
#include "core/error.hpp"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace scree::bench {

namespace {

struct Arguments {
  std::string scenes = SCREE_SOURCE_DIR "/configs";
  std::string name;
  std::string engine;
  std::string setting = "default";
  double step = 1.0 / 240;  // step size (s)
};

struct Outcome {
  double median = 0;           ///< median time of a step, over the samples that count (s)
  double total = 0;            ///< time of all steps (s)
  std::vector<double> errors;  ///< errors in the order of the measures
};

/// Steps the scene to its end, and judges the states that the case selects.
Outcome run_case(const Case& wanted, const Scene& scene, double step, Engine& engine) {
  const auto steps = std::lround(scene.time.end / step);
  if (std::abs(static_cast<double>(steps) * step - scene.time.end) > 1e-9 * scene.time.end)
    throw InputError("--step: must divide the scene's end");
  const auto per_sample = std::max(std::lround(wanted.watch_every / step), 1L);
  BodyTable state = scene.bodies;
  Judge judge(scene);
  Errors errors(wanted, scene);
  std::vector<double> samples;
  Outcome outcome;
  for (long done = 0; done < steps;) {
    const long stop = std::min(done + per_sample, steps);
    const double start = now(CLOCK_PROCESS_CPUTIME_ID);
    for (long k = done; k < stop; ++k) engine.step();
    const double elapsed = now(CLOCK_PROCESS_CPUTIME_ID) - start;
    outcome.total += elapsed;
    const double half = 0.5 * step;  // tolerance, because times are sums of steps
    if (static_cast<double>(done) * step > wanted.timed_from - half)
      samples.push_back(elapsed / static_cast<double>(stop - done));
    done = stop;
    if (static_cast<double>(done) * step < wanted.watch_from - half) continue;
    engine.read(state);
    judge.see(state, static_cast<double>(done) * step);
    errors.see(judge.findings());
  }
  std::nth_element(samples.begin(), samples.begin() + std::ssize(samples) / 2, samples.end());
  outcome.median = samples[samples.size() / 2];
  outcome.errors = errors.values();
  return outcome;
}

int run(const Arguments& arguments) {
  const Case& wanted = find_case(arguments.name);
  const Scene scene = read_scene(arguments.scenes + "/" + wanted.folder + "/" + wanted.name + ".yaml");
  const auto engine = make_engine(arguments.engine, arguments.setting, scene, arguments.step);
  const Outcome outcome = run_case(wanted, scene, arguments.step, *engine);

  nlohmann::ordered_json line = {{"case", wanted.name},
                                 {"engine", arguments.engine},
                                 {"setting", arguments.setting},
                                 {"step", arguments.step},
                                 {"us_per_step", 1e6 * outcome.median},
                                 {"ms_per_second", 1e3 * outcome.total / scene.time.end},
                                 {"cpu_s", outcome.total}};
  for (std::size_t k = 0; k < wanted.measures.size(); ++k) {
    const Measure& measure = wanted.measures[k];
    line["errors"][measure.name] = outcome.errors[k];
    line["units"][measure.name] = measure.unit;
  }
  std::printf("%s\n", line.dump().c_str());
  return 0;
}

}  // namespace
}  // namespace scree::bench

int main(int argc, char** argv) {
  scree::bench::Arguments arguments;
  CLI::App program("One case in one engine: errors and costs as a line of JSON");
  program.add_option("--case", arguments.name, "its name, that of its scene, too")->required();
  program.add_option("--engine", arguments.engine, "bullet, ode or scree")->required();
  program.add_option("--setting", arguments.setting, "of the engine; for scree a list of key=value");
  program.add_option("--step", arguments.step, "s")->check(CLI::PositiveNumber);
  program.add_option("--scenes", arguments.scenes, "folder that has the cases' folders of scenes");
  CLI11_PARSE(program, argc, argv);
  try {
    return scree::bench::run(arguments);
  } catch (const scree::InputError& error) {
    std::fprintf(stderr, "scree_bench_peers: %s\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "scree_bench_peers: %s\n", error.what());
    return 3;
  }
}
