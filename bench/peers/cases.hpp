// The cases of the benchmark: scenes whose answer is known, or for which every engine has the same goal.
#pragma once

#include "bench/peers/judge.hpp"

#include <string>
#include <vector>

namespace scree::bench {

struct Measure {
  const char* name;
  const char* unit;  ///< "" for shares
  double (*error)(const Scene& scene, const Findings& findings);
  bool mean = false;  ///< whether to take the mean over all judged states but the first; else the newest
};

struct Case {
  const char* name;    ///< name of the case, and of its scene configs/FOLDER/NAME.yaml
  double watch_every;  ///< interval at which the state is judged (s); the time of the steps between is one
                       ///< sample
  double watch_from;   ///< time before which states are not judged (s), except for the first one
  double timed_from;   ///< time after which steps count for the median (s)
  std::vector<Measure> measures;
  const char* folder = "bench";
};

/// The errors of one run.
class Errors {
 public:
  /// Refers to the case and to the scene, which must outlive it.
  Errors(const Case& wanted, const Scene& scene);
  /// Takes the errors of a judged state. It must be called for each of them but the first.
  void see(const Findings& findings);
  const std::vector<double>& values() const { return values_; }  ///< in the order of the measures

 private:
  const Case& case_;
  const Scene& scene_;
  double seen_ = 0;
  std::vector<double> values_;
};

/// Returns the case with the name. Throws InputError if there is none.
const Case& find_case(const std::string& name);

}  // namespace scree::bench
