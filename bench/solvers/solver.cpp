#include "bench/solvers/solver.hpp"

#include "core/error.hpp"

#include <functional>
#include <map>

namespace scree::bench {

namespace {

using Make = std::function<std::unique_ptr<Solver>(const ContactProblem&, const Problem&)>;

const std::map<std::string, Make>& makers() {
  using Scene = ContactProblem;
  static const std::map<std::string, Make> all = {
      {"nsgs", [](const Scene&, const Problem& p) { return make_nsgs(p); }},
      {"jacobi", [](const Scene&, const Problem& p) { return make_jacobi(p); }},
      {"apgd", [](const Scene&, const Problem& p) { return make_apgd(p); }},
      {"scree-sweeps-1", [](const Scene& s, const Problem&) { return make_scree_sweeps(s, 1); }},
      {"scree-sweeps-4", [](const Scene& s, const Problem&) { return make_scree_sweeps(s, 4); }},
      {"scree-direct", [](const Scene& s, const Problem&) { return make_scree_direct(s); }},
      {"scree-default", [](const Scene& s, const Problem&) { return make_scree_response(s, false); }},
      {"scree-accurate", [](const Scene& s, const Problem&) { return make_scree_response(s, true); }},
  };
  return all;
}

}  // namespace

std::vector<std::string> solver_names() {
  std::vector<std::string> names;
  for (const auto& [name, make] : makers()) names.push_back(name);
  return names;
}

std::unique_ptr<Solver> make_solver(const std::string& name, const ContactProblem& scene,
                                    const Problem& problem) {
  const auto maker = makers().find(name);
  if (maker == makers().end()) throw InputError("solver " + name + ": unknown");
  return maker->second(scene, problem);
}

}  // namespace scree::bench
