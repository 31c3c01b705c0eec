#include "sim/resident/slots.hpp"

#include "core/parallel.hpp"
#include "core/space_atomic.hpp"
#include "core/space_tiles.hpp"

#include <utility>

namespace scree::resident {

namespace {

/// A slot's color in its lower bits, and whether it is on a part of a hub.
constexpr std::uint8_t of_hub = 64;
constexpr std::uint8_t uncolored = 255;
static_assert(most_colors <= of_hub);

/// Manifolds that a pair can have: a ball in a tube touches wall and caps, a box the wall with each corner.
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

/// A slot's rank among its neighbours: as good as random, never the same twice (each step can be undone), and
/// a matter of the bodies' numbers alone. There are fewer than 2^30 bodies, since each takes some 100 bytes.
SCREE_HD std::uint64_t rank_of(const Slot& slot, ConstView<BodyNumber> number) {
  const auto bits_of = [&](std::int32_t body) { return static_cast<std::uint64_t>(number[body]); };
  std::uint64_t x = bits_of(slot.i) << 34 | bits_of(slot.j) << 4 | static_cast<std::uint64_t>(slot.surface);
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}
static_assert(box_tube_surfaces <= 16);

/// Whether a slot is on a part of a hub.
SCREE_HD bool is_on_part(ConstView<Mobility> mobility, const Slot& slot) {
  return (mobility[slot.i] == Mobility::free && slot.end_i != slot.i) ||
         (mobility[slot.j] == Mobility::free && slot.end_j != slot.j);
}

/// The first of the old slots of each pair, -1 for new pairs.
struct LookUpOld {
  ConstView<Pair> pairs;
  ListedPairs old_pairs;
  ConstView<std::int64_t> old_first;
  View<std::int64_t> was;
  SCREE_HD void operator()(std::int64_t k) const {
    const std::int64_t pair = old_pairs.find(pairs[k]);
    was[k] = pair < 0 ? -1 : old_first[pair];
  }
};

/// Slots keep their colours, but for those on parts of hubs, which are dealt anew.
struct KeepColors {
  ConstView<Slot> slots;
  ConstView<Mobility> mobility;
  ConstView<std::int64_t> was;
  ConstView<std::uint8_t> old_color;
  View<std::uint8_t> color;
  View<std::uint64_t> taken;
  SCREE_HD void operator()(std::int64_t s) const {
    const Slot& slot = slots[s];
    const std::int64_t old = was[slot.candidate];
    color[s] = uncolored;
    if (old < 0 || is_on_part(mobility, slot)) return;
    const std::uint8_t kept = old_color[old + slot.surface];
    if ((kept & of_hub) != 0) return;
    color[s] = kept;
    if (mobility[slot.i] == Mobility::free) set_bits(&taken[slot.i], std::uint64_t{1} << kept);
    if (mobility[slot.j] == Mobility::free) set_bits(&taken[slot.j], std::uint64_t{1} << kept);
  }
};

struct Uncolored {
  static constexpr std::uint32_t none = 0xffffffffu;
  ConstView<std::uint8_t> color;
  SCREE_HD std::uint32_t operator()(std::int64_t s) const {
    return color[s] == uncolored ? static_cast<std::uint32_t>(s) : none;
  }
};
struct StillUncolored {
  Uncolored all;
  ConstView<std::uint32_t> list;
  SCREE_HD std::uint32_t operator()(std::int64_t k) const { return all(list[k]); }
};

/// Rounds of colouring: of the uncoloured slots of each body the first in rank stands, and a slot that stands
/// at both its bodies takes the lowest colour that both have left (Jones, Plassmann 1993, "A parallel graph
/// coloring heuristic").
struct Stand {
  ConstView<std::uint32_t> list;
  ConstView<Slot> slots;
  ConstView<Mobility> mobility;
  ConstView<BodyNumber> number;
  ConstView<std::uint8_t> color;
  View<std::uint64_t> standing;
  SCREE_HD void operator()(std::int64_t k) const {
    const std::int64_t s = list[k];
    if (color[s] != uncolored) return;
    const Slot& slot = slots[s];
    const std::uint64_t rank = rank_of(slot, number);
    if (mobility[slot.i] == Mobility::free) lower(&standing[slot.end_i], rank);
    if (mobility[slot.j] == Mobility::free) lower(&standing[slot.end_j], rank);
  }
};
struct TakeColor {
  ConstView<std::uint32_t> list;
  ConstView<Slot> slots;
  ConstView<Mobility> mobility;
  ConstView<BodyNumber> number;
  View<std::uint8_t> color;
  View<std::uint64_t> standing;
  View<std::uint64_t> taken;
  SCREE_HD void operator()(std::int64_t k) const {
    const std::int64_t s = list[k];
    if (color[s] != uncolored) return;
    const Slot& slot = slots[s];
    const bool free_i = mobility[slot.i] == Mobility::free;
    const bool free_j = mobility[slot.j] == Mobility::free;
    const std::uint64_t rank = rank_of(slot, number);
    if ((free_i && standing[slot.end_i] != rank) || (free_j && standing[slot.end_j] != rank)) return;
    const std::uint64_t used = (free_i ? taken[slot.end_i] : 0) | (free_j ? taken[slot.end_j] : 0);
    int lowest = 0;
    while ((used >> lowest & 1) != 0) ++lowest;
    color[s] = static_cast<std::uint8_t>(lowest | (is_on_part(mobility, slot) ? of_hub : 0));
    if (free_i) taken[slot.end_i] |= std::uint64_t{1} << lowest;
    if (free_j) taken[slot.end_j] |= std::uint64_t{1} << lowest;
    // Nobody else stands here, so the next round may begin.
    if (free_i) standing[slot.end_i] = ~std::uint64_t{0};
    if (free_j) standing[slot.end_j] = ~std::uint64_t{0};
  }
};

struct KeyOf {
  ConstBodyView bodies;
  ConstView<Slot> slots;
  ConstView<std::uint8_t> color;
  View<std::uint32_t> key;
  View<std::uint32_t> slot;
  SCREE_HD void operator()(std::int64_t s) const {
    key[s] =
        color[s] % of_hub + (is_of_balls(bodies, slots[s]) ? 0u : static_cast<std::uint32_t>(most_colors));
    slot[s] = static_cast<std::uint32_t>(s);
  }
};
struct LoadKey {
  ConstView<std::uint32_t> key;
  SCREE_HD int operator()(std::int64_t k) const { return static_cast<int>(key[k]); }
};

/// Where the slots of a colour begin, among all in their order, and their places.
struct ColorStart {
  std::int64_t first;
  std::int64_t place;
};
struct PlaceSlots {
  ConstView<Slot> slots;
  ConstView<std::uint32_t> key;
  ConstView<std::uint32_t> slot;
  ConstView<ColorStart> start;
  View<Slot> places;
  View<std::int64_t> place;
  SCREE_HD void operator()(std::int64_t k) const {
    const ColorStart& color = start[key[k]];
    const std::int64_t to = color.place + (k - color.first);
    places[to] = slots[slot[k]];
    place[slot[k]] = to;
  }
};

/// Slots whose places are known.
struct PutSlots {
  ConstView<Slot> slots;
  ConstView<std::int64_t> place;
  View<Slot> places;
  SCREE_HD void operator()(std::int64_t s) const { places[place[s]] = slots[s]; }
};

/// What its slot remembered before.
template <class Real>
struct Recall {
  ConstView<Slot> places;
  ConstView<std::int64_t> was;
  ConstView<std::int64_t> old_place;
  std::int64_t ball_places, old_ball_places;
  ConstView<BallMemory<Real>> old_balls;
  ConstView<PointMemory<Real>> old_points;
  ConstView<V3<Real>> old_couples;
  View<BallMemory<Real>> balls;
  View<PointMemory<Real>> points;
  View<V3<Real>> couples;

  SCREE_HD void operator()(std::int64_t place) const {
    const std::int64_t old = old_place_of(places[place]);
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
    if (slot.i == Slot::empty || was[slot.candidate] < 0) return -1;
    return old_place[was[slot.candidate] + slot.surface];
  }
};

}  // namespace

template <class Space, class Real>
void Slots<Space, Real>::build(ConstView<Pair> candidates, ConstView<std::int32_t> place_before,
                               const ConstBodyView& bodies, bool rolls) {
  old_pairs_.swap(pairs_);
  old_first_.swap(first_);
  old_place_.swap(place_);
  old_color_.swap(color_);
  old_ball_memory_.swap(ball_memory_);
  old_point_memory_.swap(point_memory_);
  old_couples_.swap(couples_);
  old_ball_places_ = balls_.tiles() * parallel::tile;
  pairs_.resize(candidates.size());
  copy_bytes<Space, Space>(pairs_.data(), candidates.data(),
                           static_cast<std::size_t>(candidates.size()) * sizeof(Pair));
  was_.resize(pairs_.size());
  parallel::for_each<Space>("slots.recall", pairs_.size(),
                            LookUpOld{std::as_const(pairs_).view(),
                                      {std::as_const(old_pairs_).view(), place_before},
                                      std::as_const(old_first_).view(),
                                      was_.view()});
  list_slots(bodies);
  solver_bodies_.number(bodies, slots_.view());
  color_slots(bodies);
  place_slots(bodies);
  recall(rolls);
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
void Slots<Space, Real>::color_slots(const ConstBodyView& bodies) {
  constexpr int rounds_at_once = 8;
  // Colours that are kept leave gaps, so that their number creeps up.
  constexpr int most_more = 3;
  const ConstView<Slot> slots = std::as_const(slots_).view();
  Array<std::uint64_t, Space> standing(solver_bodies_.first_wall_point()),
      taken(solver_bodies_.first_wall_point());
  parallel::fill("slots.color", standing, ~std::uint64_t{0});
  parallel::fill("slots.color", taken, std::uint64_t{0});
  color_.resize(slots.size());
  const bool keep = keeps_colors_ && colors_used() <= colors_at_first_ + most_more;
  if (keep) {
    parallel::for_each<Space>("slots.color", slots.size(),
                              KeepColors{slots, bodies.mobility, std::as_const(was_).view(),
                                         std::as_const(old_color_).view(), color_.view(), taken.view()});
  } else {
    parallel::fill("slots.color", color_, uncolored);
  }
  Array<std::uint32_t, Space> list, shorter;
  const Uncolored uncolored_slots{std::as_const(color_).view()};
  parallel::select("slots.color", slots.size(), uncolored_slots, Uncolored::none, list);
  // In each round the first in rank of all that are left finds its colour.
  while (list.size() > 0) {
    const ConstView<std::uint32_t> left = std::as_const(list).view();
    for (int round = 0; round < rounds_at_once; ++round) {
      parallel::for_each<Space>(
          "slots.color", left.size(),
          Stand{left, slots, bodies.mobility, bodies.id, std::as_const(color_).view(), standing.view()});
      parallel::for_each<Space>(
          "slots.color", left.size(),
          TakeColor{left, slots, bodies.mobility, bodies.id, color_.view(), standing.view(), taken.view()});
    }
    parallel::select("slots.color", left.size(), StillUncolored{uncolored_slots, left}, Uncolored::none,
                     shorter);
    list.swap(shorter);
  }
  recolored_ = !keep;
}

template <class Space, class Real>
void Slots<Space, Real>::place_slots(const ConstBodyView& bodies) {
  constexpr int keys = 2 * most_colors;
  const ConstView<Slot> slots = std::as_const(slots_).view();
  Array<std::uint32_t, Space> key(slots.size()), slot(slots.size()), counts;
  parallel::for_each<Space>("slots.place", slots.size(),
                            KeyOf{bodies, slots, std::as_const(color_).view(), key.view(), slot.view()});
  parallel::sort_by_key("slots.place", key, slot, 7);
  parallel::histogram<Space>("slots.place", slots.size(), LoadKey{std::as_const(key).view()}, keys, counts);
  const std::vector<std::uint32_t> count = to_vector(counts);
  std::vector<ColorStart> start;
  std::int64_t first = 0;
  std::int64_t tiles = 0;
  balls_.begin.assign(1, 0);
  for (int k = 0; k < keys; ++k) {
    ColorTiles& kind = k < most_colors ? balls_ : others_;
    if (k == most_colors) others_.begin.assign(1, tiles);
    start.push_back({first, tiles * parallel::tile});
    first += count[static_cast<std::size_t>(k)];
    if (count[static_cast<std::size_t>(k)] == 0) continue;
    tiles += parallel::tiles_of(count[static_cast<std::size_t>(k)]);
    kind.begin.push_back(tiles);
  }
  if (recolored_) colors_at_first_ = colors_used();
  keeps_colors_ = true;
  Array<ColorStart, Space> starts;
  copy(starts, start);
  places_.resize(tiles * parallel::tile);
  place_.resize(slots.size());
  parallel::fill("slots.place", places_, Slot{});
  parallel::for_each<Space>("slots.place", slots.size(),
                            PlaceSlots{slots, std::as_const(key).view(), std::as_const(slot).view(),
                                       std::as_const(starts).view(), places_.view(), place_.view()});
}

template <class Space, class Real>
void Slots<Space, Real>::recall(bool rolls) {
  const std::int64_t ball_places = balls_.tiles() * parallel::tile;
  ball_memory_.resize(ball_places);
  point_memory_.resize(places_.size() - ball_places);
  couples_.resize(rolls ? places_.size() : 0);
  parallel::for_each<Space>(
      "slots.recall", places_.size(),
      Recall<Real>{std::as_const(places_).view(), std::as_const(was_).view(),
                   std::as_const(old_place_).view(), ball_places, old_ball_places_,
                   std::as_const(old_ball_memory_).view(), std::as_const(old_point_memory_).view(),
                   std::as_const(old_couples_).view(), ball_memory_.view(), point_memory_.view(),
                   couples_.view()});
}

template <class Space, class Real>
void Slots<Space, Real>::keep_memory() {
  copy(kept_ball_memory_, ball_memory_);
  copy(kept_point_memory_, point_memory_);
  copy(kept_couples_, couples_);
}

template <class Space, class Real>
void Slots<Space, Real>::recall_memory() {
  copy(ball_memory_, kept_ball_memory_);
  copy(point_memory_, kept_point_memory_);
  copy(couples_, kept_couples_);
}

/// What follows from the candidates and the bodies is made again. If bodies have come or gone since, so may
/// it be otherwise; but then the slots are built anew before anybody asks for it.
template <class Space, class Real>
void Slots<Space, Real>::archive(Archive& archive, const ConstBodyView& bodies) {
  archive("pairs", pairs_);
  archive("color", color_);
  archive("place", place_);
  archive("ball_memory", ball_memory_);
  archive("point_memory", point_memory_);
  archive("couples", couples_);
  archive("keeps_colors", keeps_colors_);
  archive("colors_at_first", colors_at_first_);
  archive.part("balls", balls_);
  archive.part("others", others_);
  if (!archive.is_loading()) return;
  list_slots(bodies);
  solver_bodies_.number(bodies, slots_.view());
  places_.resize(ball_memory_.size() + point_memory_.size());
  parallel::fill("slots.place", places_, Slot{});
  parallel::for_each<Space>(
      "slots.place", place_.size(),
      PutSlots{std::as_const(slots_).view(), std::as_const(place_).view(), places_.view()});
}

#define SCREE_INSTANTIATE(Space)       \
  template class Slots<Space, double>; \
  template class Slots<Space, float>;
SCREE_FOR_EACH_SPACE(SCREE_INSTANTIATE)

}  // namespace scree::resident
