#include "sim/resident/ball_tiles.hpp"
#include "sim/resident/contact_finder_passing.hpp"
#include "sim/resident/find_balls.hpp"

namespace scree::resident {

template <class Space, class Real>
void ContactFinder<Space, Real>::find_balls(const FindStage<Real>& stage, Slots<Space, Real>& slots,
                                            View<BodyRecord<Real>> solver, ContactStore<Space, Real>& store) {
  const std::int64_t tiles = slots.balls().tiles();
  if (tiles == 0) return;
  const PassingList passing = clear_passing(tiles * parallel::tile);
  const BallContacts<Real> contacts = store.balls();
  const FindBalls<Real> find{stage, contacts, slots.ball_memory(), solver, passing};
  if constexpr (visit_width<Space, Real> == 1) {
    parallel::compact_tiles<Space>("contacts.find balls", tiles, find, store.ball_tiles().data());
  } else {
    constexpr std::int64_t few_tiles = 2;
    reach_.resize(stage.mid.size() + 1);
    Reach* const reach = reach_.data() + 1;
    parallel::for_each<Host>("contacts.reach", reach_.size(), SetReach{stage, reach});
    parallel::for_each<Host>("contacts.find balls", tiles,
                             FindBallTile{find, reach, store.ball_tiles().data()}, few_tiles);
  }
  judge(passing, JudgeBalls<Real>{stage, contacts});
}

#define SCREE_INSTANTIATE(Space)                                                                          \
  template void ContactFinder<Space, double>::find_balls(const FindStage<double>&, Slots<Space, double>&, \
                                                         View<BodyRecord<double>>,                        \
                                                         ContactStore<Space, double>&);                   \
  template void ContactFinder<Space, float>::find_balls(                                                  \
      const FindStage<float>&, Slots<Space, float>&, View<BodyRecord<float>>, ContactStore<Space, float>&);
SCREE_FOR_EACH_SPACE(SCREE_INSTANTIATE)

}  // namespace scree::resident
