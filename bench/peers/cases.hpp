// The cases: scenes with an answer that is known, or a wish that every engine shares.
#pragma once

#include "bench/peers/judge.hpp"

#include <string>
#include <vector>

namespace scree::bench {

struct Measure {
  const char* name;
  const char* unit;  ///< "" for shares
  double (*error)(const Scene& scene, const Findings& findings);
  bool mean = false;  ///< of the errors in all the states that are judged, but the first; else of the newest
};

struct Case {
  const char* name;    ///< of the scene configs/FOLDER/NAME.yaml, too
  double watch_every;  ///< how often the state is judged (s); the time of the steps between is one sample
  double watch_from;   ///< states before this time are not judged (s); but the first one always is
  double timed_from;   ///< steps after this time make the median (s)
  std::vector<Measure> measures;
  const char* folder = "bench";
};

/// The errors of one run.
class Errors {
 public:
  /// Both must outlive it.
  Errors(const Case& wanted, const Scene& scene);
  /// To be told of every state that is judged, but the first.
  void see(const Findings& findings);
  const std::vector<double>& values() const { return values_; }  ///< in the order of the measures

 private:
  const Case& case_;
  const Scene& scene_;
  double seen_ = 0;
  std::vector<double> values_;
};

/// Throws InputError for a name that none has.
const Case& find_case(const std::string& name);

}  // namespace scree::bench
