#include "sim/record/guards.hpp"

namespace scree {

std::vector<GuardCount> guards_of(const Observation& now) {
  const Counters& c = now.counters;
  return {
      {"redone", c.redone, "steps that failed and were taken again in smaller substeps",
       "a smaller time.step"},
      {"left", now.left, "bodies that left the world and were taken out", "world.from and world.to"},
      {"sweeps", c.unconverged, "substeps that used all their sweeps", "more response.iterations"},
      {"impacts", c.unfinished_impacts, "substeps whose chains of impacts hit their bound",
       "a smaller time.step"},
      {"newton", c.patient_failed, "groups of contacts that no method has solved",
       "a smaller time.step or more response.iterations"},
      {"gjk", c.narrowphase.ccd_stopped, "calls of libccd that hit their bound",
       "narrowphase.box_box: sat, convex: axes"},
  };
}

}  // namespace scree
