#include "sim/resident/slots.hpp"

#include "core/parallel.hpp"
#include "core/space_atomic.hpp"
#include "core/space_tiles.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace scree::resident {

namespace {

/// Slots that a free body may have before it is a hub, and those of a part of one. Two bodies leave one of 64
/// colours for what they share. Most bodies of a heap have fewer; each colour that only few need is a wait
/// for all.
constexpr std::int32_t most_slots = 24;
constexpr std::int32_t slots_of_part = 12;
static_assert(2 * most_slots <= most_colors);
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

struct CountSlots {
  ConstView<Slot> slots;
  ConstView<Mobility> mobility;
  View<std::int32_t> counts;
  SCREE_HD void operator()(std::int64_t s) const {
    if (mobility[slots[s].i] == Mobility::free) add(&counts[slots[s].i], 1);
    if (mobility[slots[s].j] == Mobility::free) add(&counts[slots[s].j], 1);
  }
};

struct MarkHubs {
  ConstView<std::int32_t> counts;
  View<std::uint8_t> is_hub;
  SCREE_HD void operator()(std::int64_t b) const { is_hub[b] = counts[b] > most_slots ? 1 : 0; }
};

struct ListHubs {
  ConstView<std::int32_t> counts;
  ConstView<std::int64_t> number;
  View<Hub> hubs;
  View<std::int32_t> parts;
  SCREE_HD void operator()(std::int64_t b) const {
    if (number[b] == number[b + 1]) return;
    parts[number[b]] = (counts[b] + slots_of_part - 1) / slots_of_part;
    hubs[number[b]] = {.body = static_cast<std::int32_t>(b), .first = 0, .parts = parts[number[b]]};
  }
};

struct PlaceHubs {
  ConstView<std::int64_t> first;
  std::int64_t bodies;
  View<Hub> hubs;
  SCREE_HD void operator()(std::int64_t h) const {
    hubs[h].first = static_cast<std::int32_t>(bodies + first[h]);
  }
};
/// The hub of each part: the last that does not begin after it.
struct NameHubs {
  ConstView<std::int64_t> first;
  View<std::int32_t> hub_of;
  SCREE_HD void operator()(std::int64_t p) const {
    std::int64_t low = 0, high = first.size() - 1;
    while (high - low > 1) {
      const std::int64_t middle = (low + high) / 2;
      (first[middle] <= p ? low : high) = middle;
    }
    hub_of[p] = static_cast<std::int32_t>(low);
  }
};

/// Ends of slots on hubs: 2 s for i, 2 s + 1 for j.
struct MarkHubEnds {
  ConstView<Slot> slots;
  ConstView<std::int64_t> number;
  View<std::uint8_t> on_hub;
  SCREE_HD void operator()(std::int64_t e) const {
    const Slot& slot = slots[e / 2];
    const std::int32_t body = e % 2 == 0 ? slot.i : slot.j;
    on_hub[e] = number[body + 1] > number[body] ? 1 : 0;
  }
};
/// In the order of hubs, and those on the heaviest bodies first: the bits of a float that is not negative are
/// in the order of such floats.
struct ListHubEnds {
  ConstBodyView bodies;
  ConstView<Slot> slots;
  ConstView<std::int64_t> number;
  ConstView<std::int64_t> to;
  View<std::uint64_t> key;
  View<std::uint64_t> ends;
  SCREE_HD void operator()(std::int64_t e) const {
    if (to[e] == to[e + 1]) return;
    const Slot& slot = slots[e / 2];
    const std::int32_t body = e % 2 == 0 ? slot.i : slot.j;
    const auto lightness = static_cast<float>(bodies.inverse_mass[e % 2 == 0 ? slot.j : slot.i]);
    key[to[e]] = static_cast<std::uint64_t>(number[body]) << 32 | std::bit_cast<std::uint32_t>(lightness);
    ends[to[e]] = static_cast<std::uint64_t>(e);
  }
};
/// The ends of a hub, in their order, are dealt to its parts. Adds up what they weigh for each, but each at
/// most as much as the hub: in integers, since sums of these do not hang on the order of threads.
struct DealHubEnds {
  ConstBodyView bodies;
  ConstView<std::uint64_t> key;
  ConstView<std::uint64_t> ends;
  ConstView<Hub> hubs;
  ConstView<std::int32_t> hub_of;
  std::int64_t first_part;
  View<Slot> slots;
  View<std::int64_t> weight;
  SCREE_HD void operator()(std::int64_t p) const {
    constexpr double unit = 0x1p40;  // of the hub's mass
    const std::int64_t begin = first_of(hub_of[p]) + (first_part + p - hubs[hub_of[p]].first) * slots_of_part;
    const double least = bodies.inverse_mass[hubs[hub_of[p]].body];
    std::int64_t sum = 0;
    for (std::int64_t k = begin; k < begin + slots_of_part && k < ends.size() && hub_at(k) == hub_of[p];
         ++k) {
      Slot& slot = slots[static_cast<std::int64_t>(ends[k] / 2)];
      const bool is_i = ends[k] % 2 == 0;
      (is_i ? slot.end_i : slot.end_j) = static_cast<std::int32_t>(first_part + p);
      sum += 1 + static_cast<std::int64_t>(
                     unit * (least / fmax(least, bodies.inverse_mass[is_i ? slot.j : slot.i])));
    }
    weight[p] = sum;
  }

 private:
  SCREE_HD std::int32_t hub_at(std::int64_t k) const { return static_cast<std::int32_t>(key[k] >> 32); }
  SCREE_HD std::int64_t first_of(std::int32_t hub) const {
    std::int64_t low = 0, high = key.size();
    while (low < high) {
      const std::int64_t middle = (low + high) / 2;
      if (hub_at(middle) < hub) {
        low = middle + 1;
      } else {
        high = middle;
      }
    }
    return low;
  }
};
/// Half by weight, half alike: `before` has the weights of all parts before each.
struct ShareHub {
  ConstView<Hub> hubs;
  ConstView<std::int32_t> hub_of;
  std::int64_t first_part;
  ConstView<std::int64_t> weight, before;
  View<double> share;
  SCREE_HD void operator()(std::int64_t p) const {
    const Hub& hub = hubs[hub_of[p]];
    const std::int64_t first = hub.first - first_part;
    const auto all = static_cast<double>(before[first + hub.parts] - before[first]);
    share[p] = 0.5 * (static_cast<double>(weight[p]) / all + 1.0 / hub.parts);
  }
};

/// A slot's rank among its neighbours: as good as random, and never the same twice.
SCREE_HD std::uint64_t rank_of(std::int64_t slot) {
  auto x = static_cast<std::uint64_t>(slot) * 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x ^= x >> 31;
  return (x & 0xffffffff00000000u) | static_cast<std::uint32_t>(slot);
}

/// Balls on balls, or on what is not free.
SCREE_HD bool is_of_balls(const ConstBodyView& bodies, const Slot& slot) {
  const auto is_ball = [&](std::int32_t body) {
    return bodies.mobility[body] != Mobility::free || bodies.shape[body] == Shape::sphere;
  };
  return is_ball(slot.i) && is_ball(slot.j);
}

SCREE_HD bool is_turning_wall(const ConstBodyView& bodies, std::int32_t body) {
  return bodies.mobility[body] != Mobility::free && !bodies.spin[body].isZero(0);
}
struct CountTurningWalls {
  ConstBodyView bodies;
  SCREE_HD std::int64_t operator()(std::int64_t b) const {
    return is_turning_wall(bodies, static_cast<std::int32_t>(b)) ? 1 : 0;
  }
};
struct MarkWallPoints {
  ConstBodyView bodies;
  ConstView<Slot> slots;
  View<std::uint8_t> marks;
  SCREE_HD void operator()(std::int64_t s) const {
    const Slot& slot = slots[s];
    marks[s] =
        is_of_balls(bodies, slot) && (is_turning_wall(bodies, slot.i) || is_turning_wall(bodies, slot.j));
  }
};
struct NumberWallPoints {
  ConstBodyView bodies;
  ConstView<std::int64_t> number;
  std::int64_t first;
  View<Slot> slots;
  SCREE_HD void operator()(std::int64_t s) const {
    if (number[s] == number[s + 1]) return;
    Slot& slot = slots[s];
    (is_turning_wall(bodies, slot.i) ? slot.end_i : slot.end_j) =
        static_cast<std::int32_t>(first + number[s]);
  }
};

/// Whether a slot is on a part of a hub.
SCREE_HD bool is_on_part(ConstView<Mobility> mobility, const Slot& slot) {
  return (mobility[slot.i] == Mobility::free && slot.end_i != slot.i) ||
         (mobility[slot.j] == Mobility::free && slot.end_j != slot.j);
}

/// The first of the old slots of each pair, -1 for new pairs.
struct LookUpOld {
  ConstView<Pair> pairs, old_pairs;
  ConstView<std::int64_t> old_first;
  View<std::int64_t> was;
  SCREE_HD void operator()(std::int64_t k) const {
    const std::int64_t pair = find_pair(old_pairs, pairs[k].i, pairs[k].j);
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
  ConstView<std::uint8_t> color;
  View<std::uint64_t> standing;
  SCREE_HD void operator()(std::int64_t k) const {
    const std::int64_t s = list[k];
    if (color[s] != uncolored) return;
    const Slot& slot = slots[s];
    if (mobility[slot.i] == Mobility::free) lower(&standing[slot.end_i], rank_of(s));
    if (mobility[slot.j] == Mobility::free) lower(&standing[slot.end_j], rank_of(s));
  }
};
struct TakeColor {
  ConstView<std::uint32_t> list;
  ConstView<Slot> slots;
  ConstView<Mobility> mobility;
  View<std::uint8_t> color;
  View<std::uint64_t> standing;
  View<std::uint64_t> taken;
  SCREE_HD void operator()(std::int64_t k) const {
    const std::int64_t s = list[k];
    if (color[s] != uncolored) return;
    const Slot& slot = slots[s];
    const bool free_i = mobility[slot.i] == Mobility::free;
    const bool free_j = mobility[slot.j] == Mobility::free;
    if ((free_i && standing[slot.end_i] != rank_of(s)) || (free_j && standing[slot.end_j] != rank_of(s)))
      return;
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

/// What its slot remembered before.
template <class Real>
struct Recall {
  ConstView<Slot> places;
  ConstView<std::int64_t> was;
  ConstView<std::int64_t> old_place;
  std::int64_t ball_places, old_ball_places;
  ConstView<BallMemory<Real>> old_balls;
  ConstView<PointMemory<Real>> old_points;
  View<BallMemory<Real>> balls;
  View<PointMemory<Real>> points;

  SCREE_HD void operator()(std::int64_t place) const {
    const std::int64_t old = old_place_of(places[place]);
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
void Slots<Space, Real>::build(ConstView<Pair> candidates, const ConstBodyView& bodies) {
  old_pairs_.swap(pairs_);
  old_first_.swap(first_);
  old_place_.swap(place_);
  old_color_.swap(color_);
  old_ball_memory_.swap(ball_memory_);
  old_point_memory_.swap(point_memory_);
  old_ball_places_ = balls_.tiles() * parallel::tile;
  pairs_.resize(candidates.size());
  copy_bytes<Space, Space>(pairs_.data(), candidates.data(),
                           static_cast<std::size_t>(candidates.size()) * sizeof(Pair));
  was_.resize(pairs_.size());
  parallel::for_each<Space>("slots.recall", pairs_.size(),
                            LookUpOld{std::as_const(pairs_).view(), std::as_const(old_pairs_).view(),
                                      std::as_const(old_first_).view(), was_.view()});
  list_slots(bodies);
  split_hubs(bodies);
  number_wall_points(bodies);
  color_slots(bodies);
  place_slots(bodies);
  recall();
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
void Slots<Space, Real>::split_hubs(const ConstBodyView& bodies) {
  const std::int64_t n = bodies.count();
  const std::int64_t ends = 2 * slots_.size();
  const ConstView<Slot> slots = std::as_const(slots_).view();
  Array<std::int32_t, Space> counts(n);
  Array<std::uint8_t, Space> marks(n);
  Array<std::int64_t, Space> number, to;
  parallel::fill("slots.degree", counts, 0);
  parallel::for_each<Space>("slots.degree", slots.size(), CountSlots{slots, bodies.mobility, counts.view()});
  parallel::for_each<Space>("slots.hubs", n, MarkHubs{std::as_const(counts).view(), marks.view()});
  hubs_.resize(parallel::exclusive_scan("slots.hubs", marks, number));
  solver_bodies_ = n;
  hub_of_.resize(0);
  share_.resize(0);
  if (hubs_.empty()) return;
  Array<std::int32_t, Space> parts(hubs_.size());
  parallel::for_each<Space>(
      "slots.hubs", n,
      ListHubs{std::as_const(counts).view(), std::as_const(number).view(), hubs_.view(), parts.view()});
  hub_of_.resize(parallel::exclusive_scan("slots.hubs", parts, to));
  solver_bodies_ += hub_of_.size();
  parallel::for_each<Space>("slots.hubs", hubs_.size(), PlaceHubs{std::as_const(to).view(), n, hubs_.view()});
  parallel::for_each<Space>("slots.hubs", hub_of_.size(), NameHubs{std::as_const(to).view(), hub_of_.view()});
  marks.resize(ends);
  parallel::for_each<Space>("slots.hub ends", ends,
                            MarkHubEnds{slots, std::as_const(number).view(), marks.view()});
  const std::int64_t on_hubs = parallel::exclusive_scan("slots.hub ends", marks, to);
  Array<std::uint64_t, Space> key(on_hubs), end(on_hubs);
  parallel::for_each<Space>("slots.hub ends", ends,
                            ListHubEnds{bodies, slots, std::as_const(number).view(), std::as_const(to).view(),
                                        key.view(), end.view()});
  parallel::sort_by_key("slots.hub ends", key, end,
                        32 + std::bit_width(static_cast<std::uint64_t>(hubs_.size())));
  Array<std::int64_t, Space> weight(hub_of_.size()), before;
  parallel::for_each<Space>(
      "slots.hub ends", hub_of_.size(),
      DealHubEnds{bodies, std::as_const(key).view(), std::as_const(end).view(), std::as_const(hubs_).view(),
                  std::as_const(hub_of_).view(), n, slots_.view(), weight.view()});
  parallel::exclusive_scan("slots.hub ends", weight, before);
  share_.resize(hub_of_.size());
  parallel::for_each<Space>(
      "slots.hub ends", hub_of_.size(),
      ShareHub{std::as_const(hubs_).view(), std::as_const(hub_of_).view(), n, std::as_const(weight).view(),
               std::as_const(before).view(), share_.view()});
}

template <class Space, class Real>
void Slots<Space, Real>::number_wall_points(const ConstBodyView& bodies) {
  first_wall_point_ = solver_bodies_;
  const auto walls =
      parallel::sum_by_tiles<std::int64_t, Space>("slots.walls", bodies.count(), CountTurningWalls{bodies});
  if (walls == 0) return;
  Array<std::uint8_t, Space> marks(slots_.size());
  Array<std::int64_t, Space> number;
  parallel::for_each<Space>("slots.walls", slots_.size(),
                            MarkWallPoints{bodies, std::as_const(slots_).view(), marks.view()});
  solver_bodies_ += parallel::exclusive_scan("slots.walls", marks, number);
  parallel::for_each<Space>(
      "slots.walls", slots_.size(),
      NumberWallPoints{bodies, std::as_const(number).view(), first_wall_point_, slots_.view()});
}

template <class Space, class Real>
void Slots<Space, Real>::color_slots(const ConstBodyView& bodies) {
  constexpr int rounds_at_once = 8;
  // Colours that are kept leave gaps, so that their number creeps up.
  constexpr int most_more = 3;
  const ConstView<Slot> slots = std::as_const(slots_).view();
  Array<std::uint64_t, Space> standing(first_wall_point_), taken(first_wall_point_);
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
          Stand{left, slots, bodies.mobility, std::as_const(color_).view(), standing.view()});
      parallel::for_each<Space>(
          "slots.color", left.size(),
          TakeColor{left, slots, bodies.mobility, color_.view(), standing.view(), taken.view()});
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
void Slots<Space, Real>::recall() {
  const std::int64_t ball_places = balls_.tiles() * parallel::tile;
  ball_memory_.resize(ball_places);
  point_memory_.resize(places_.size() - ball_places);
  parallel::for_each<Space>(
      "slots.recall", places_.size(),
      Recall<Real>{std::as_const(places_).view(), std::as_const(was_).view(),
                   std::as_const(old_place_).view(), ball_places, old_ball_places_,
                   std::as_const(old_ball_memory_).view(), std::as_const(old_point_memory_).view(),
                   ball_memory_.view(), point_memory_.view()});
}

#define SCREE_INSTANTIATE(Space)       \
  template class Slots<Space, double>; \
  template class Slots<Space, float>;
SCREE_FOR_EACH_SPACE(SCREE_INSTANTIATE)

}  // namespace scree::resident
