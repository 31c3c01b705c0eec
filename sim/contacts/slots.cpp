#include "sim/contacts/slots.hpp"

#include "core/parallel.hpp"
#include "core/space_atomic.hpp"
#include "core/space_tiles.hpp"
#include "sim/contacts/contact_colors.hpp"

#include <utility>

namespace scree::solver {

namespace {

/// Largest numbers of manifolds of a pair with a tube: a ball touches the wall and two caps; a box touches
/// two caps, and the wall with each of its eight corners.
constexpr int tube_surfaces = 3;
constexpr int box_tube_surfaces = 10;

SCREE_HD int surfaces_of(Shape a, Shape b) {
  if (a != Shape::tube && b != Shape::tube) return 1;
  return a == Shape::box || b == Shape::box ? box_tube_surfaces : tube_surfaces;
}

struct CountSurfaces {
  ConstBodyView bodies;
  ConstView<Pair> pairs;
  View<std::uint8_t> counts;
  SCREE_HD void operator()(std::int64_t k) const {
    counts[k] = static_cast<std::uint8_t>(surfaces_of(bodies.shape[pairs[k].i], bodies.shape[pairs[k].j]));
  }
};

struct ListSlots {
  ConstView<Pair> pairs;
  ConstView<std::int64_t> first;
  View<Slot> slots;
  SCREE_HD void operator()(std::int64_t k) const {
    const Pair& pair = pairs[k];
    for (std::int64_t s = first[k]; s < first[k + 1]; ++s) {
      slots[s] = {.i = pair.i,
                  .j = pair.j,
                  .end_i = pair.i,
                  .end_j = pair.j,
                  .candidate = static_cast<std::int32_t>(k),
                  .surface = static_cast<std::int32_t>(s - first[k])};
    }
  }
};

static_assert(box_tube_surfaces <= 16);  // the rank in contact_colors.cpp has 4 bits for a surface

struct LookUpPairs {
  ConstView<Pair> pairs;
  ListedPairs listed;
  View<std::int64_t> index;
  SCREE_HD void operator()(std::int64_t k) const { index[k] = listed.find(pairs[k]); }
};

/// Marks the slots that are not of balls. Places of balls come first, and each kind is in the order of the
/// candidates.
struct MarkOthers {
  ConstBodyView bodies;
  ConstView<Slot> slots;
  View<std::uint8_t> marks;
  SCREE_HD void operator()(std::int64_t s) const { marks[s] = is_of_balls(bodies, slots[s]) ? 0 : 1; }
};
struct PlaceSlots {
  ConstView<std::int64_t> others;  ///< number of slots before each slot that are not of balls
  std::int64_t first_other;        ///< first place of these slots
  View<std::int64_t> place;
  SCREE_HD void operator()(std::int64_t s) const {
    place[s] = others[s] == others[s + 1] ? s - others[s] : first_other + others[s];
  }
};

/// Copies slots to their places, and sets *any_rare to 1 if any slot of balls is rare.
struct PutSlots {
  ConstBodyView bodies;
  ConstView<Slot> slots;
  ConstView<std::int64_t> place;
  std::int64_t ball_places;
  View<Slot> places;
  std::uint32_t* any_rare;
  SCREE_HD void operator()(std::int64_t s) const {
    places[place[s]] = slots[s];
    if (place[s] < ball_places && is_rare(bodies, slots[s])) put(any_rare, 1u);
  }
};

/// Gives each place what its slot remembered before the slots were built anew.
template <class Real>
struct Recall {
  ConstView<Slot> places;
  ConstView<std::int64_t> before;     ///< index of each candidate among the old ones (Slots::look_up())
  ConstView<std::int64_t> old_first;  ///< first slot of each old candidate
  ConstView<std::int64_t> old_place;
  std::int64_t ball_places, old_ball_places;
  ConstView<BallMemory<Real>> old_balls;
  ConstView<PointMemory<Real>> old_points;
  ConstView<V3<Real>> old_couples;
  ConstView<std::uint8_t> old_color;
  View<BallMemory<Real>> balls;
  View<PointMemory<Real>> points;
  View<V3<Real>> couples;
  View<std::uint8_t> color;

  SCREE_HD void operator()(std::int64_t place) const {
    const std::int64_t old = old_place_of(places[place]);
    color[place] = old < 0 ? no_color : color_with_new_parts(old_color[old]);
    if (couples.size() > 0) {
      const bool known = old >= 0 && old < old_couples.size();
      couples[place] = known ? old_couples[old] : V3<Real>{};
    }
    if (place < ball_places) {
      balls[place] = old >= 0 && old < old_ball_places ? old_balls[old] : BallMemory<Real>{};
    } else {
      points[place - ball_places] =
          old >= old_ball_places ? old_points[old - old_ball_places] : PointMemory<Real>{};
    }
  }
  SCREE_HD std::int64_t old_place_of(const Slot& slot) const {
    if (slot.i == Slot::empty || before[slot.candidate] < 0) return -1;
    return old_place[old_first[before[slot.candidate]] + slot.surface];
  }
};

/// Forgets the colours of contacts that are or were on parts.
struct ForgetParts {
  ConstView<Mobility> mobility;
  ConstView<Slot> places;
  FoundPlaces found;
  View<std::uint8_t> color;
  SCREE_HD void operator()(std::int64_t k) const {
    const std::int64_t place = found[k];
    color[place] = is_on_part(mobility, places[place]) ? no_color : color_with_new_parts(color[place]);
  }
};

}  // namespace

template <class Space, class Real>
void Slots<Space, Real>::look_up(ConstView<Pair> pairs, ConstView<std::int32_t> place_before,
                                 Array<std::int64_t, Space>& index) const {
  index.resize(pairs.size());
  parallel::for_each<Space>("slots.look up", pairs.size(),
                            LookUpPairs{pairs, {candidates(), place_before}, index.view()});
}

template <class Space, class Real>
void Slots<Space, Real>::build(ConstView<Pair> candidates, ConstView<std::int64_t> before,
                               const ConstBodyView& bodies, bool rolls) {
  old_first_.swap(first_);
  old_place_.swap(place_);
  old_color_.swap(color_);
  old_ball_memory_.swap(ball_memory_);
  old_point_memory_.swap(point_memory_);
  old_couples_.swap(couples_);
  old_ball_places_ = ball_places();
  pairs_.resize(candidates.size());
  copy_bytes<Space, Space>(pairs_.data(), candidates.data(),
                           static_cast<std::size_t>(candidates.size()) * sizeof(Pair));
  list_slots(bodies);
  solver_bodies_.number(bodies, slots_.view());
  place_slots(bodies);
  recall(before, rolls);
}

template <class Space, class Real>
void Slots<Space, Real>::list_slots(const ConstBodyView& bodies) {
  Array<std::uint8_t, Space> counts(pairs_.size());
  parallel::for_each<Space>("slots.count", pairs_.size(),
                            CountSurfaces{bodies, std::as_const(pairs_).view(), counts.view()});
  slots_.resize(parallel::exclusive_scan("slots.count", counts, first_));
  parallel::for_each<Space>(
      "slots.list", pairs_.size(),
      ListSlots{std::as_const(pairs_).view(), std::as_const(first_).view(), slots_.view()});
}

template <class Space, class Real>
void Slots<Space, Real>::place_slots(const ConstBodyView& bodies) {
  const ConstView<Slot> slots = std::as_const(slots_).view();
  Array<std::uint8_t, Space> marks(slots.size());
  Array<std::int64_t, Space> others;
  parallel::for_each<Space>("slots.place", slots.size(), MarkOthers{bodies, slots, marks.view()});
  const std::int64_t other_slots = parallel::exclusive_scan("slots.place", marks, others);
  ball_tiles_ = parallel::tiles_of(slots.size() - other_slots);
  place_.resize(slots.size());
  parallel::for_each<Space>("slots.place", slots.size(),
                            PlaceSlots{std::as_const(others).view(), ball_places(), place_.view()});
  put_slots(bodies, (ball_tiles_ + parallel::tiles_of(other_slots)) * parallel::tile);
}

/// Makes room for a number of places, and copies the slots to theirs.
template <class Space, class Real>
void Slots<Space, Real>::put_slots(const ConstBodyView& bodies, std::int64_t places) {
  places_.resize(places);
  parallel::fill("slots.place", places_, Slot{});
  Array<std::uint32_t, Space> any_rare(1);
  parallel::fill("slots.place", any_rare, 0u);
  parallel::for_each<Space>("slots.place", place_.size(),
                            PutSlots{bodies, std::as_const(slots_).view(), std::as_const(place_).view(),
                                     ball_places(), places_.view(), any_rare.data()});
  has_rare_balls_ = to_vector(any_rare).front() != 0;
}

template <class Space, class Real>
std::int64_t Slots<Space, Real>::ball_places() const {
  return ball_tiles_ * parallel::tile;
}
template <class Space, class Real>
std::int64_t Slots<Space, Real>::other_tiles() const {
  return places_.size() / parallel::tile - ball_tiles_;
}

template <class Space, class Real>
bool Slots<Space, Real>::split_hubs(const ConstBodyView& bodies, const FoundPlaces& found) {
  const bool changed = solver_bodies_.split_hubs(bodies, found, places_.view());
  if (solver_bodies_.may_have_hubs()) {
    parallel::for_each<Space>(
        "contacts.hubs", found.size(),
        ForgetParts{bodies.mobility, std::as_const(places_).view(), found, color_.view()});
  }
  return changed;
}

template <class Space, class Real>
void Slots<Space, Real>::forget_colors() {
  parallel::fill("slots.recall", color_, no_color);
}

template <class Space, class Real>
void Slots<Space, Real>::recall(ConstView<std::int64_t> before, bool rolls) {
  ball_memory_.resize(ball_places());
  point_memory_.resize(places_.size() - ball_places());
  couples_.resize(rolls ? places_.size() : 0);
  color_.resize(places_.size());
  parallel::for_each<Space>(
      "slots.recall", places_.size(),
      Recall<Real>{std::as_const(places_).view(), before, std::as_const(old_first_).view(),
                   std::as_const(old_place_).view(), ball_places(), old_ball_places_,
                   std::as_const(old_ball_memory_).view(), std::as_const(old_point_memory_).view(),
                   std::as_const(old_couples_).view(), std::as_const(old_color_).view(), ball_memory_.view(),
                   point_memory_.view(), couples_.view(), color_.view()});
}

template <class Space, class Real>
void Slots<Space, Real>::keep_memory() {
  copy(kept_ball_memory_, ball_memory_);
  copy(kept_point_memory_, point_memory_);
  copy(kept_couples_, couples_);
  copy(kept_color_, color_);
}

template <class Space, class Real>
void Slots<Space, Real>::recall_memory() {
  copy(ball_memory_, kept_ball_memory_);
  copy(point_memory_, kept_point_memory_);
  copy(couples_, kept_couples_);
  copy(color_, kept_color_);
}

/// Saves or loads the slots. What follows from the candidates and the bodies is computed again when they are
/// loaded. If bodies have come or gone since the last build(), the result may differ from that before; but
/// then the slots are built anew before it is used.
template <class Space, class Real>
void Slots<Space, Real>::archive(Archive& archive, const ConstBodyView& bodies) {
  archive("pairs", pairs_);
  archive("place", place_);
  archive("ball_memory", ball_memory_);
  archive("point_memory", point_memory_);
  archive("couples", couples_);
  archive("color", color_);
  archive("ball_tiles", ball_tiles_);
  if (!archive.is_loading()) return;
  list_slots(bodies);
  solver_bodies_.number(bodies, slots_.view());
  put_slots(bodies, ball_memory_.size() + point_memory_.size());
}

#define SCREE_INSTANTIATE(Space)       \
  template class Slots<Space, double>; \
  template class Slots<Space, float>;
SCREE_FOR_EACH_SPACE(SCREE_INSTANTIATE)

}  // namespace scree::solver
