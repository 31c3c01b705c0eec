#include "sim/record/guards.hpp"

#include <fmt/format.h>

namespace scree {

namespace {

// Where what the loops left undone changes whether to trust a run.
constexpr double deep_overlap = 0.05;  // of the smaller body's size: a picture shows it
constexpr double bouncing = 0.3;       // restitution: an impact gives back a tenth of its energy
constexpr double often = 0.01;         // share of the substeps

std::string words_of(const GuardedRun& run) {
  if (run.worst.relative == 0) return "no bodies overlapped in the states that were measured";
  return fmt::format("the deepest overlap was {:.2g} % of the smaller body, of {} at {:.4g} s",
                     100 * run.worst.relative, run.bodies, run.worst.time);
}

}  // namespace

void WorstOverlap::include(const Observation& seen) {
  if (!(seen.penetration.relative_max > relative)) return;
  relative = seen.penetration.relative_max;
  time = seen.time;
  bodies = seen.penetration.deepest;
}

std::vector<GuardCount> guards_of(const Observation& last, const GuardedRun& run) {
  const Counters& c = last.counters;
  const bool is_deep = run.worst.relative > deep_overlap;
  const bool loses_bounces = run.restitution > bouncing && static_cast<double>(c.unfinished_impacts) >
                                                               often * static_cast<double>(c.substeps);
  // What the sweeps left undone shows as overlap; the accurate mode promises more, and measures it.
  const std::string overlap = words_of(run);
  const std::string rest =
      run.accurate ? fmt::format("a residual of {:.2g} was left at worst; {}", c.residual, overlap) : overlap;
  return {
      {"redone", c.redone, "steps that failed and were taken again in smaller substeps",
       "a smaller time.step", "what came of them was judged like any other step", false},
      {"left", last.left, "bodies that left the world and were taken out", "world.from and world.to",
       "they are not in what was measured afterwards", true},
      {"sweeps", c.unconverged, "substeps that used all their sweeps", "more response.iterations", rest,
       run.accurate || is_deep},
      {"impacts", c.unfinished_impacts, "substeps whose chains of impacts hit their bound",
       "a smaller time.step",
       fmt::format("of {}; the rest of their impacts did not bounce; {}", c.substeps, overlap),
       is_deep || loses_bounces},
      {"newton", c.patient_failed, "groups of contacts that no method has solved",
       "a smaller time.step or more response.iterations", rest, run.accurate || is_deep},
      {"gjk", c.narrowphase.ccd_stopped, "calls of libccd that hit their bound",
       "narrowphase.box_box: sat, convex: axes", "another method has answered them", false},
  };
}

}  // namespace scree
