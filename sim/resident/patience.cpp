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
constexpr int most_degree = 6;

}  // namespace

int Patience::sweeps(int usual, bool shared, double share) {
  const int least = shared ? least_shared : 0;
  const int most = shared ? most_shared : most_degree;
  degree_ = std::clamp(degree_, least, most);
  // Substeps share the sweeps of a step: each starts from the impulses of the last.
  const int degree = std::max(0, std::min(degree_, most - std::ilogb(1 / share)));
  return std::max(usual / 3, (usual << degree) / 4);
}

/// Over many substeps at once: the slow modes are oscillations, and a number of sweeps that goes up and down
/// with them pumps them.
void Patience::judge(double undone, double kicked) {
  constexpr int judged_together = 32;
  undone_ += std::abs(undone);
  kicked_ += kicked;
  if (++judged_ < judged_together) return;
  if (undone_ > degrees[degree_].more * kicked_) {
    ++degree_;
  } else if (undone_ < degrees[degree_].less * kicked_) {
    --degree_;
  }
  undone_ = kicked_ = judged_ = 0;
}

}  // namespace scree::resident
