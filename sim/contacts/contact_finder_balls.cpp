#include "sim/contacts/ball_tiles.hpp"
#include "sim/contacts/contact_finder_approach.hpp"
#include "sim/contacts/find_balls.hpp"

namespace scree::solver {

namespace {

template <class Space, class Real>
constexpr bool one_by_one = !has_ball_kernels<Space, Real>;

/// Calls what(search) with a search that can do what the slots need.
template <class Space, class Real, class What>
void with_search(const FindBalls<Real>& find, const Slots<Space, Real>& slots, const What& what) {
  if (find.stage.any_late_impact || slots.has_rare_balls()) return what(find);
  what(FindBalls<Real, false>{find.stage, find.contacts, find.memory, find.solver, find.approaching});
}

}  // namespace

template <class Space, class Real>
void ContactFinder<Space, Real>::search_balls(const FindStage<Real>& stage, Slots<Space, Real>& slots) {
  const std::int64_t tiles = slots.ball_tiles();
  constexpr std::int64_t few_tiles = 2;
  found_balls_.start(tiles);
  if (tiles == 0) return;
  const FindBalls<Real> find{stage, {}, slots.ball_memory(), {}, {}};
  if constexpr (one_by_one<Space, Real>) {
    with_search(find, slots, [&]<class Find>(const Find& search) {
      parallel::compact_tiles<Space>("contacts.find balls", tiles,
                                     FindSlots<Find>{search, found_balls_.places()}, found_balls_.counts());
    });
  } else {
    reach_.resize(stage.mid.size() + 1);
    Reach* const reach = reach_.data() + 1;
    parallel::for_each<Host>("contacts.reach", reach_.size(), SetReach{stage, reach});
    parallel::for_each<Host>("contacts.find balls", tiles,
                             FindBallTile{find, reach, found_balls_.places(), found_balls_.counts()},
                             few_tiles);
  }
  found_balls_.join();
}

template <class Space, class Real>
void ContactFinder<Space, Real>::make_balls(const FindStage<Real>& stage, Slots<Space, Real>& slots,
                                            View<BodyRecord<Real>> solver, ContactStore<Space, Real>& store) {
  constexpr std::int64_t few_blocks = 32;
  if (slots.ball_tiles() == 0) return store.take_balls({});
  ball_colors_.find(found_balls_.all(), slots.places_of_balls(), stage.bodies, slots.solver_bodies().count(),
                    slots.ball_colors());
  if (!ball_colors_.are_same()) store.take_balls(ball_colors_.ranges());
  FindBalls<Real> find{stage, store.balls(), slots.ball_memory(), solver, {}};
  if (!ball_colors_.are_same()) ball_colors_.place(find.contacts.slot);
  const std::int64_t contacts = find.contacts.slot.size();
  find.approaching = clear_approaching(contacts);
  if constexpr (one_by_one<Space, Real>) {
    with_search(find, slots, [&]<class Find>(const Find& search) {
      parallel::for_each<Space>("contacts.make balls", contacts, MakeContacts<Find>{search});
    });
  } else {
    parallel::for_each<Host>("contacts.make balls", contacts / simd::width,
                             MakeBallBlock{find, reach_.data() + 1}, few_blocks);
  }
  judge(find.approaching, JudgeBalls<Real>{stage, find.contacts});
}

#define SCREE_INSTANTIATE_FOR(Space, Real)                                                             \
  template void ContactFinder<Space, Real>::search_balls(const FindStage<Real>&, Slots<Space, Real>&); \
  template void ContactFinder<Space, Real>::make_balls(const FindStage<Real>&, Slots<Space, Real>&,    \
                                                       View<BodyRecord<Real>>, ContactStore<Space, Real>&);
#define SCREE_INSTANTIATE(Space)       \
  SCREE_INSTANTIATE_FOR(Space, double) \
  SCREE_INSTANTIATE_FOR(Space, float)
SCREE_FOR_EACH_SPACE(SCREE_INSTANTIATE)

}  // namespace scree::solver
