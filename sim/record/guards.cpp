#include "sim/record/guards.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace scree {

namespace {

// Above these values, what the loops left undone changes whether to trust a run.
constexpr double deep_overlap = 0.05;  // share of the smaller body's size: a picture shows it
constexpr double bouncing = 0.3;       // restitution: an impact gives back a tenth of its energy
constexpr double often = 0.01;         // share of the substeps

std::string words_of(const GuardedRun& run) {
  if (run.worst.relative == 0) return "no bodies overlapped in the states that were measured";
  return fmt::format(
      "the deepest overlap was {} of the smaller body's radius or half edge, between {}, at t = {:.4g} s",
      percent_words(run.worst.relative), run.bodies, run.worst.time);
}

bool is_deep(const GuardedRun& run) { return run.worst.relative > deep_overlap; }

}  // namespace

void WorstOverlap::include(const Observation& seen) {
  if (!(seen.penetration.relative_max > relative)) return;
  relative = seen.penetration.relative_max;
  time = seen.time;
  bodies = seen.penetration.deepest;
}

std::vector<GuardCount> guards_of(const Observation& last, const GuardedRun& run) {
  const Counters& c = last.counters;
  const bool loses_bounces = run.restitution > bouncing && static_cast<double>(c.unfinished_impacts) >
                                                               often * static_cast<double>(c.substeps);
  // The error that the sweeps leave shows as overlap; the accurate mode promises more, and measures it.
  const std::string overlap = words_of(run);
  const std::string rest =
      run.accurate ? fmt::format("a residual of {:.2g} was left at worst; {}", c.residual, overlap) : overlap;
  const bool unsolved_matters = run.accurate || is_deep(run);
  return {
      {"redone", c.redone, "steps that failed and were taken again in smaller substeps",
       "a smaller time.step", "the repeated steps passed the same tests as all others", false},
      {"left", last.left, "bodies that left the world and were taken out",
       "a larger box in world.from and world.to", "later measurements do not include them", true},
      {"sweeps", c.unconverged, "substeps that used all their sweeps",
       "more response.iterations, or a smaller time.step", rest, unsolved_matters},
      {"impacts", c.unfinished_impacts, "substeps whose chains of impacts reached the limit",
       "a smaller time.step",
       fmt::format("that is {} of {} substeps; their remaining impacts did not bounce; {}",
                   c.unfinished_impacts, c.substeps, overlap),
       is_deep(run) || loses_bounces},
      {"newton", c.long_direct_failed,
       "groups of contacts that neither all sweeps nor a second, longer direct solution has solved",
       "a smaller time.step or more response.iterations", rest, unsolved_matters},
      {"gjk", c.narrowphase.ccd_stopped, "calls of libccd that reached their limit",
       "narrowphase.box_box: sat, convex: axes", "another method has answered them", false},
  };
}

std::string percent_words(double share) {
  const double percent = 100 * share;
  return percent < 1000 ? fmt::format("{:.3g} %", percent) : fmt::format("{:.0f} %", percent);
}

std::string line_of(const GuardCount& guard) {
  return fmt::format("{}: {}; {}. To have fewer: {}.", guard.what, guard.count, guard.effect, guard.setting);
}

std::string overlap_warning(const std::vector<GuardCount>& guards, const GuardedRun& run) {
  if (!is_deep(run)) return {};
  const std::string overlap = words_of(run);
  const bool is_told = std::ranges::any_of(guards, [&](const GuardCount& guard) {
    return guard.count > 0 && guard.matters && guard.effect.ends_with(overlap);
  });
  if (is_told) return {};
  return overlap + (run.worst.time == 0
                        ? ": the scene places these bodies into each other; move them apart in the scene"
                        : "; try a smaller time.step");
}

}  // namespace scree
