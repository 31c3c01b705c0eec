#include "sim/response/sweep_count.hpp"

#include "core/tolerances.hpp"

#include <algorithm>
#include <cmath>

namespace scree::solver {

namespace {

struct Degree {
  double more, less;  // shares of the power, over or under which the degree goes up or down
};
using namespace tolerance;
constexpr Degree degrees[] = {
    {stirring_power, 0},          {done_power, least_sweeps_power}, {residual_power, least_sweeps_power},
    {residual_power, done_power}, {residual_power, done_power},     {residual_power, done_power},
    {HUGE_VAL, done_power}};
/// The range of degrees for bodies that share several points. For these degree 2 is 12 sweeps, and with fewer
/// than those of degree 3 they do not stay at rest.
constexpr int least_shared = 3, most_shared = 5;
constexpr int usual_degree = 2, most_degree = 6;

}  // namespace

int SweepCount::sweeps(int usual, bool shared, double share) {
  const int least = !shared ? 0 : moves_ ? usual_degree : least_shared;
  const int most = shared ? most_shared : most_degree;
  degree_ = std::clamp(degree_, least, most);
  // The substeps of a step share its sweeps, since each starts from the impulses of the last.
  const int degree = std::max(0, std::min(degree_, most - std::ilogb(1 / share)));
  return std::max(usual / 3, (usual << degree) / 4);
}

/// Judges the sums over many substeps: the slow modes are oscillations, and a number of sweeps that goes up
/// and down with them would excite them. There are two exceptions. Where the residual of one substep is about
/// as large as the power of its impulses, as when a heap has just fallen on its ground, the highest degree
/// follows at once, since bodies that sink in meanwhile take seconds to come out again. And a heap that flows
/// has no slow modes, so that a few substeps suffice to find that the usual number of sweeps is enough.
void SweepCount::judge(double residual, double kicked, double dissipated) {
  constexpr int judged_together = 32, judged_in_flow = 8;
  const auto of = [](double loss) { return residual_of_dissipated * std::max(loss, 0.0); };
  if (std::abs(residual) > all_residual * kicked + much_residual * of(dissipated)) {
    degree_ = most_degree;
    tolerance_exponent_ = 0;
    residual_ = kicked_ = dissipated_ = overlap_ = judged_ = 0;
    return;
  }
  residual_ += std::abs(residual);
  kicked_ += kicked;
  dissipated_ += dissipated;
  ++judged_;
  const bool flows = dissipated_ > flowing_power * kicked_;
  const bool is_done = residual_ < of(dissipated_);
  if (judged_ < (flows && is_done ? judged_in_flow : judged_together)) return;
  moves_ = dissipated_ > moving_power * kicked_;
  flows_ = flows;
  tolerance_exponent_ = flows ? next_tolerance_exponent() : 0;
  if (flows && is_done) degree_ = std::min(degree_, usual_degree);
  const double most_residual = degrees[degree_].more * kicked_ + of(dissipated_);
  if (residual_ > most_residual) {
    degree_ = std::min(degree_ + (residual_ > much_residual * most_residual ? 2 : 1), most_degree);
  } else if (residual_ < degrees[degree_].less * kicked_ || (moves_ && degree_ > usual_degree && is_done)) {
    --degree_;
  }
  residual_ = kicked_ = dissipated_ = overlap_ = judged_ = 0;
}

int SweepCount::next_tolerance_exponent() const {
  constexpr int loosest = 3;
  static_assert(heap_change_in_flow <= heap_change * (1 << loosest));
  if (overlap_ > 2 * much_overlap_in_flow) return 0;
  if (overlap_ > much_overlap_in_flow) return std::max(tolerance_exponent_ - 1, 0);
  return overlap_ < little_overlap_in_flow ? std::min(tolerance_exponent_ + 1, loosest) : tolerance_exponent_;
}

double SweepCount::change() const {
  return std::min(std::ldexp(heap_change, tolerance_exponent_), heap_change_in_flow);
}

}  // namespace scree::solver
