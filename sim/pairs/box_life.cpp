#include "sim/pairs/box_life.hpp"

#include "core/tolerances.hpp"

#include <algorithm>

namespace scree {

/// Returns the time that pairs take in each substep if they last `substeps`, in arbitrary units: their
/// number, times the cost of looking at a pair and of making it. The number of bodies near a body grows with
/// the third power of the box. The length of a path adds to the pairs that have to be made, but few of them
/// are near each other on their paths and have to be looked at. `travel`: distance per substep to which a box
/// must have room, and `along`: on its path, both in smallest_size.
double BoxLife::cost_of(int substeps, double travel, double along) const {
  constexpr double making = 2;  // cost of making a pair, as a multiple of that of looking at it in a substep
  const double box = 1 + tolerance::contact_slack + tolerance::pair_skin + (substeps + room_) * travel;
  const double made = box + 0.5 * substeps * along;
  return box * box * (box + making * made / substeps);
}

/// Impacts make boxes fail that were to last, which shows only afterwards. Then the next ones are to last no
/// longer than these have lasted. After several that have lasted as they should, twice as long is tried.
void BoxLife::judge(double lasted) {
  constexpr int enough = 4;
  if (lasted < planned_ - tolerance::pair_life_rounding) {
    most_ = std::max(1, static_cast<int>(lasted + tolerance::pair_life_rounding));
    kept_in_a_row_ = 0;
  } else if (++kept_in_a_row_ >= enough) {
    most_ = std::min(2 * most_, longest);
    kept_in_a_row_ = 0;
  }
}

double BoxLife::choose(double now, double substep, double rate, double along) {
  constexpr double least_room = 0.05, shrinking = 0.97;
  if (planned_ > 0 && substep_ > 0 && now > made_) judge((now - made_) / substep_);
  room_ = std::max(shrinking * room_, least_room);
  int best = 1;
  for (int substeps = 2; substeps <= most_; ++substeps) {
    if (cost_of(substeps, rate * substep, along * substep) < cost_of(best, rate * substep, along * substep))
      best = substeps;
  }
  made_ = now;
  substep_ = substep;
  planned_ = best;
  return (best + room_) * substep;
}

void BoxLife::make_room() {
  constexpr double growing = 1.5, most_room = 2;
  room_ = std::min(growing * room_, most_room);
}

}  // namespace scree
