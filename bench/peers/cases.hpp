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
};

struct Case {
  const char* name;    ///< of the scene configs/bench/NAME.yaml, too
  double watch_every;  ///< how often the state is judged (s); the time of the steps between is one sample
  double watch_from;   ///< states before this time are not judged (s); but the first one always is
  double timed_from;   ///< steps after this time make the median (s)
  std::vector<Measure> measures;
};

/// Throws InputError for a name that none has.
const Case& find_case(const std::string& name);

}  // namespace scree::bench
