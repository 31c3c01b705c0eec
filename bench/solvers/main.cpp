// The benchmark of contact solvers alone, on problems captured from running scenes, with the same residual
// for all solvers (residual.hpp). It uses one thread.
//
//   scree_bench_solvers --scene FILE --until SECONDS --problem FILE      captures the last substep's problem
//   scree_bench_solvers --problem FILE --solver NAME [--seconds 4]       solves it repeatedly
//
// The first form prints a line of JSON about the problem and writes it (problem_file.hpp). The second prints
// a line for each budget of the solver, starting from one iteration or a tolerance of 0.1. It ends if the
// residual is under 1e-11, if a solve takes longer than `seconds`, or if eight budgets in a row have not
// reduced the residual. For budgets of iterations the last rule holds only under 1e-8, since slow modes can
// stay the same for long before they come down. Every solve starts from zero impulses. Its time is CPU time
// without the setup of the solver, and the median of several solves if they are short. bench/solvers/run
// calls this program for a whole table.
#include "bench/clock.hpp"
#include "bench/options.hpp"
#include "bench/solvers/problem_file.hpp"
#include "bench/solvers/residual.hpp"
#include "bench/solvers/solver.hpp"
#include "sim/step/simulation.hpp"

#include <nlohmann/json.hpp>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace scree::bench {

namespace {

using Json = nlohmann::ordered_json;

constexpr double good_enough = 1e-11;  // residual
constexpr double least_tolerance = 1e-14;
constexpr double finer = 10;                 // ratio of one tolerance to the next
constexpr double more = 1.4142135623730951;  // ratio of one number of iterations to the one before
constexpr double sample = 0.02;              // CPU time that the repeats of a solve fill (s)
constexpr int most_repeats = 25;
constexpr double better = 0.99;  // ratio to the best residual so far that counts as an improvement
constexpr double least_plateau = 1e-8;
constexpr int most_stale = 8;

double cpu_time() { return now(CLOCK_PROCESS_CPUTIME_ID); }

void print(const Json& line) {
  std::printf("%s\n", line.dump().c_str());
  std::fflush(stdout);
}

void add(const Residual& residual, Json& line) {
  line["residual"] = residual.natural;
  line["signorini"] = residual.signorini;
  line["cone"] = residual.cone;
}

int capture(const Options& options) {
  Simulation simulation(read_scene(options.at("--scene")), {SpaceChoice::host, 1});
  const double until = std::stod(options.at("--until"));
  do {
    simulation.step();
  } while (!simulation.finished() && simulation.time() < until);
  ProblemFile content{simulation.contact_problem(), {}};
  if (content.scene.points.empty()) throw InputError("--until: nothing touches then");
  const double start = cpu_time();
  content.problem = assemble(content.scene);
  const double elapsed = cpu_time() - start;
  write_problem(options.at("--problem"), content);
  Json line = {{"time", simulation.time()},
               {"bodies", std::ranges::count_if(content.scene.bodies,
                                                [](const auto& body) { return body.inverse_mass > 0; })},
               {"contacts", content.scene.contacts.size()},
               {"points", content.problem.size()},
               {"blocks", content.problem.delassus.count()},
               {"assembly_seconds", elapsed}};
  add(ResidualMeter(content.problem)(impulses_of(content.scene)), line);
  print(line);
  return 0;
}

/// Returns the median time over as many solves as fill a sample. `impulses` gets those of the last solve.
double timed_solve(Solver& solver, double budget, PointVectors& impulses) {
  std::vector<double> seconds;
  const double start = cpu_time();
  do {
    const double before = cpu_time();
    impulses = solver.solve(budget);
    seconds.push_back(cpu_time() - before);
  } while (cpu_time() - start < sample && std::ssize(seconds) < most_repeats);
  const auto middle = seconds.begin() + std::ssize(seconds) / 2;
  std::nth_element(seconds.begin(), middle, seconds.end());
  return *middle;
}

int solve(const Options& options) {
  const ProblemFile content = read_problem(options.at("--problem"));
  const ResidualMeter meter(content.problem);
  const auto solver = make_solver(options.at("--solver"), content.scene, content.problem);
  const double most_seconds = std::stod(options.at("--seconds"));
  const bool iterates = solver->budget() == Solver::Budget::iterations;
  double best = HUGE_VAL;
  int stale = 0;
  double budget = iterates ? 1 : 1 / finer;
  while (budget >= least_tolerance) {
    PointVectors impulses;
    const double seconds = timed_solve(*solver, budget, impulses);
    const Residual residual = meter(impulses);
    Json line = {{"budget", budget}, {"seconds", seconds}};
    add(residual, line);
    print(line);
    const bool may_plateau = iterates && best > least_plateau;
    stale = may_plateau || residual.natural < better * best ? 0 : stale + 1;
    best = std::min(best, residual.natural);
    if (best <= good_enough || seconds > most_seconds || stale == most_stale) break;
    budget = iterates ? std::ceil(more * budget) : budget / finer;
  }
  return 0;
}

int run(int argc, char** argv) {
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const Options options =
      parse(argc, argv,
            {{"--scene", ""}, {"--until", "0"}, {"--problem", ""}, {"--solver", ""}, {"--seconds", "4"}});
  if (options.at("--problem").empty()) throw InputError("--problem: needed");
  return options.at("--scene").empty() ? solve(options) : capture(options);
}

}  // namespace

}  // namespace scree::bench

int main(int argc, char** argv) {
  return scree::bench::status_of("scree_bench_solvers", [&] { return scree::bench::run(argc, argv); });
}
