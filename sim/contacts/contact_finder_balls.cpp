#include "sim/contacts/ball_tiles.hpp"
#include "sim/contacts/contact_finder_approach.hpp"
#include "sim/contacts/find_balls.hpp"

namespace scree::solver {

template <class Space, class Real>
void ContactFinder<Space, Real>::find_balls(const FindStage<Real>& stage, Slots<Space, Real>& slots,
                                            View<BodyRecord<Real>> solver, ContactStore<Space, Real>& store) {
  const std::int64_t tiles = slots.ball_tiles();
  if (tiles == 0) return store.take_balls({});
  constexpr bool one_by_one = visit_width<Space, Real> == 1;
  constexpr std::int64_t few_tiles = 2, few_blocks = 32;
  found_.start(tiles);
  FindBalls<Real> find{stage, {}, slots.ball_memory(), solver, {}};
  // Calls what(search) with a search that can do what the slots need.
  const auto with_search = [&](const auto& what) {
    if (stage.any_late_impact || slots.has_rare_balls()) return what(find);
    what(FindBalls<Real, false>{stage, find.contacts, find.memory, solver, find.approaching});
  };
  if constexpr (!one_by_one) {
    reach_.resize(stage.mid.size() + 1);
    Reach* const reach = reach_.data() + 1;
    parallel::for_each<Host>("contacts.reach", reach_.size(), SetReach{stage, reach});
    parallel::for_each<Host>("contacts.find balls", tiles,
                             FindBallTile{find, reach, found_.places(), found_.counts()}, few_tiles);
  } else {
    with_search([&]<class Find>(const Find& search) {
      parallel::compact_tiles<Space>("contacts.find balls", tiles, FindSlots<Find>{search, found_.places()},
                                     found_.counts());
    });
  }
  found_.join();
  ball_colors_.find(found_.all(), slots.places_of_balls(), stage.bodies,
                    slots.solver_bodies().first_wall_point(), slots.ball_colors());
  if (!ball_colors_.are_same()) store.take_balls(ball_colors_.ranges());
  find.contacts = store.balls();
  if (!ball_colors_.are_same()) ball_colors_.place(find.contacts.slot);
  const std::int64_t contacts = find.contacts.slot.size();
  find.approaching = clear_approaching(contacts);
  if constexpr (!one_by_one) {
    parallel::for_each<Host>("contacts.make balls", contacts / simd::width,
                             MakeBallBlock{find, reach_.data() + 1}, few_blocks);
  } else {
    with_search([&]<class Find>(const Find& search) {
      parallel::for_each<Space>("contacts.make balls", contacts, MakeContacts<Find>{search});
    });
  }
  judge(find.approaching, JudgeBalls<Real>{stage, find.contacts});
}

#define SCREE_INSTANTIATE(Space)                                                                          \
  template void ContactFinder<Space, double>::find_balls(const FindStage<double>&, Slots<Space, double>&, \
                                                         View<BodyRecord<double>>,                        \
                                                         ContactStore<Space, double>&);                   \
  template void ContactFinder<Space, float>::find_balls(                                                  \
      const FindStage<float>&, Slots<Space, float>&, View<BodyRecord<float>>, ContactStore<Space, float>&);
SCREE_FOR_EACH_SPACE(SCREE_INSTANTIATE)

}  // namespace scree::solver
