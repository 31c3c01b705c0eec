#include "sim/resident/contact_finder.hpp"

#include "core/parallel.hpp"
#include "core/space_tiles.hpp"
#include "sim/resident/find_balls.hpp"
#include "sim/resident/find_points.hpp"

namespace scree::resident {

template <class Space, class Real>
void ContactFinder<Space, Real>::find(const FindStage<Real>& stage, Slots<Space, Real>& slots,
                                      ConstView<LoadedParts> loads, View<BodyRecord<Real>> solver,
                                      ContactStore<Space, Real>& store) {
  if (const std::int64_t tiles = slots.balls().tiles(); tiles > 0) {
    const PassingList passing = clear_passing(tiles * parallel::tile);
    const BallContacts<Real> contacts = store.balls();
    const FindBalls<Real> find{stage, contacts, slots.ball_memory(), solver, passing};
    parallel::compact_tiles<Space>("contacts.find balls", tiles, find, store.ball_tiles().data());
    judge(passing, JudgeBalls<Real>{stage, contacts});
  }
  if (const std::int64_t tiles = slots.others().tiles(); tiles > 0) {
    const PassingList passing = clear_passing(tiles * parallel::tile);
    const PointContacts<Real> contacts = store.points();
    const std::int64_t first = store.ball_places();
    const FindPoints<Real> find{stage, first, contacts, slots.point_memory(), loads, passing};
    parallel::compact_tiles<Space>("contacts.find points", tiles, find, store.point_tiles().data());
    judge(passing, JudgePoints<Real>{stage, first, contacts});
  }
}

template <class Space, class Real>
PassingList ContactFinder<Space, Real>::clear_passing(std::int64_t places) {
  passing_.resize(places);
  passing_count_.resize(1);
  parallel::fill("contacts.passing", passing_count_, std::uint64_t{0});
  return {passing_.view(), passing_count_.data()};
}

template <class Space, class Real>
template <class Judge>
void ContactFinder<Space, Real>::judge(const PassingList& passing, const Judge& judge) {
  parallel::for_each<Space>("contacts.passing", JudgePassing<Judge>::threads,
                            JudgePassing<Judge>{passing, judge});
}

#define SCREE_INSTANTIATE(Space)               \
  template class ContactFinder<Space, double>; \
  template class ContactFinder<Space, float>;
SCREE_FOR_EACH_SPACE(SCREE_INSTANTIATE)

}  // namespace scree::resident
