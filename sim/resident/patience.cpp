#include "sim/resident/patience.hpp"

#include "core/tolerances.hpp"

#include <algorithm>
#include <cmath>

namespace scree::resident {

namespace {

struct Degree {
  double more, less;  // of the power: over the first the next degree follows, under the second the last
};
using namespace tolerance;
constexpr Degree degrees[] = {{stirring_power, 0},        {done_power, calm_power},
                              {undone_power, calm_power}, {undone_power, done_power},
                              {undone_power, done_power}, {undone_power, done_power},
                              {HUGE_VAL, done_power}};
/// Bodies that share several points, of which a sweep of degree 2 is 12 sweeps, do not stay at rest with
/// less.
constexpr int least_shared = 3, most_shared = 5;
constexpr int usual_degree = 2, most_degree = 6;
constexpr int substeps_judged = 32, few_substeps = 8;

}  // namespace

int Patience::sweeps(int usual, bool shared, double share) {
  const int least = !shared ? 0 : moves_ ? usual_degree : least_shared;
  const int most = shared ? most_shared : most_degree;
  degree_ = std::clamp(degree_, least, most);
  // Substeps share the sweeps of a step: each starts from the impulses of the last.
  const int degree = std::max(0, std::min(degree_, most - std::ilogb(1 / share)));
  return std::max(usual / 3, (usual << degree) / 4);
}

/// Over many substeps at once: the slow modes are oscillations, and a number of sweeps that goes up and down
/// with them pumps them. But where a few leave far too much undone, or one as much as its impulses do, since
/// a heap has just fallen on its ground, all sweeps follow at once: what sinks in meanwhile takes seconds to
/// come out again.
void Patience::judge(double undone, double kicked, double dissipated) {
  undone = std::abs(undone);
  dissipated = std::max(dissipated, 0.0);
  const bool has_fallen = undone > fallen_power * kicked + fallen_of_dissipated * dissipated;
  undone_ += undone;
  kicked_ += kicked;
  dissipated_ += dissipated;
  ++judged_;
  const double of_dissipated = undone_of_dissipated * dissipated_;
  const double most_undone = degrees[degree_].more * kicked_ + of_dissipated;
  const bool is_far_off = judged_ >= few_substeps && undone_ > far_too_much_undone * most_undone;
  if (judged_ < substeps_judged && !has_fallen && !is_far_off) return;
  moves_ = dissipated_ > moving_power * kicked_;
  if (has_fallen || is_far_off) {
    degree_ = most_degree;
  } else if (undone_ > most_undone) {
    degree_ = std::min(degree_ + 1, most_degree);
  } else if (undone_ < degrees[degree_].less * kicked_ ||
             (moves_ && degree_ > usual_degree && undone_ < of_dissipated)) {
    --degree_;
  }
  undone_ = kicked_ = dissipated_ = judged_ = 0;
}

}  // namespace scree::resident
