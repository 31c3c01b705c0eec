#include "sim/contacts/solver_bodies.hpp"

#include "core/parallel.hpp"
#include "core/space_atomic.hpp"
#include "core/space_tiles.hpp"
#include "sim/contacts/contact_store.hpp"

#include <bit>
#include <cmath>
#include <utility>

namespace scree::solver {

namespace {

/// The most contacts that a free body may have without being a hub, and the number of contacts of a part of a
/// hub. Two bodies that are no hubs leave at least one of the 64 colours for a contact between them. Most
/// bodies of a heap have fewer contacts; each colour that only few contacts need makes all threads wait.
constexpr std::int32_t most_contacts = 32;
constexpr std::int32_t contacts_of_part = 12;
static_assert(2 * most_contacts <= most_colors);

/// Counts a slot at its bodies, as far as they are free.
struct CountEnds {
  ConstView<Mobility> mobility;
  View<std::int32_t> counts;
  SCREE_HD void count(const Slot& slot) const {
    if (mobility[slot.i] == Mobility::free) add(&counts[slot.i], 1);
    if (mobility[slot.j] == Mobility::free) add(&counts[slot.j], 1);
  }
};
struct CountSlots {
  CountEnds ends;
  ConstView<Slot> slots;
  SCREE_HD void operator()(std::int64_t s) const { ends.count(slots[s]); }
};
struct CountContacts {
  CountEnds ends;
  FoundPlaces found;
  ConstView<Slot> places;
  SCREE_HD void operator()(std::int64_t k) const { ends.count(places[found[k]]); }
};
struct LoadCount {
  ConstView<std::int32_t> counts;
  SCREE_HD std::int32_t operator()(std::int64_t b) const { return counts[b]; }
};

struct MarkHubs {
  ConstView<std::int32_t> counts;
  View<std::uint8_t> is_hub;
  SCREE_HD void operator()(std::int64_t b) const { is_hub[b] = counts[b] > most_contacts ? 1 : 0; }
};

/// Makes all free bodies whole: the ends of their slots are the bodies themselves.
struct MakeWhole {
  ConstView<Mobility> mobility;
  View<Slot> places;
  SCREE_HD void operator()(std::int64_t s) const {
    Slot& slot = places[s];
    if (slot.i == Slot::empty) return;
    if (mobility[slot.i] == Mobility::free) slot.end_i = slot.i;
    if (mobility[slot.j] == Mobility::free) slot.end_j = slot.j;
  }
};

struct ListHubs {
  ConstView<std::int32_t> counts;
  ConstView<std::int64_t> number;
  View<Hub> hubs;
  View<std::int32_t> parts;
  SCREE_HD void operator()(std::int64_t b) const {
    if (number[b] == number[b + 1]) return;
    parts[number[b]] = (counts[b] + contacts_of_part - 1) / contacts_of_part;
    hubs[number[b]] = {.body = static_cast<std::int32_t>(b), .first = 0, .parts = parts[number[b]]};
  }
};

struct PlaceHubs {
  ConstView<std::int64_t> first;
  std::int64_t first_part;
  View<Hub> hubs;
  SCREE_HD void operator()(std::int64_t h) const {
    hubs[h].first = static_cast<std::int32_t>(first_part + first[h]);
  }
};
/// Finds the hub of each part: the last one whose first part is not after it.
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

/// The ends of the contacts: end 2 k is body i of found slot k, end 2 k + 1 is body j.
struct ContactEnds {
  FoundPlaces found;
  View<Slot> places;

  SCREE_HD Slot& slot(std::int64_t end) const { return places[found[end / 2]]; }
  SCREE_HD std::int32_t body(std::int64_t end) const { return end % 2 == 0 ? slot(end).i : slot(end).j; }
  SCREE_HD std::int32_t other(std::int64_t end) const { return end % 2 == 0 ? slot(end).j : slot(end).i; }
  SCREE_HD void put_on(std::int64_t end, std::int32_t part) const {
    (end % 2 == 0 ? slot(end).end_i : slot(end).end_j) = part;
  }
};

struct MarkHubEnds {
  ContactEnds ends;
  ConstView<std::int64_t> number;
  View<std::uint8_t> on_hub;
  SCREE_HD void operator()(std::int64_t e) const {
    const std::int32_t body = ends.body(e);
    on_hub[e] = number[body + 1] > number[body] ? 1 : 0;
  }
};
/// Lists the ends on hubs, with the numbers of the other bodies as keys of a first sorting: the order of a
/// hub's ends does then not depend on where bodies lie in memory.
struct ListHubEnds {
  ConstBodyView bodies;
  ContactEnds ends;
  ConstView<std::int64_t> to;
  View<std::uint64_t> key;
  View<std::uint64_t> list;
  SCREE_HD void operator()(std::int64_t e) const {
    if (to[e] == to[e + 1]) return;
    key[to[e]] = static_cast<std::uint64_t>(bodies.id[ends.other(e)]);
    list[to[e]] = static_cast<std::uint64_t>(e);
  }
};
/// Computes the keys of a second sorting: by hub, and within a hub the ends with the heaviest other bodies
/// first. The bits of floats that are not negative have the same order as the floats.
struct KeyOfHubEnd {
  ConstBodyView bodies;
  ContactEnds ends;
  ConstView<std::int64_t> number;
  ConstView<std::uint64_t> list;
  View<std::uint64_t> key;
  SCREE_HD void operator()(std::int64_t k) const {
    const auto end = static_cast<std::int64_t>(list[k]);
    const auto lightness = static_cast<float>(bodies.inverse_mass[ends.other(end)]);
    key[k] =
        static_cast<std::uint64_t>(number[ends.body(end)]) << 32 | std::bit_cast<std::uint32_t>(lightness);
  }
};
/// Distributes the ends of each hub over its parts, in their order, and adds up the masses of the other
/// bodies for each part. Each mass counts at most as much as that of the hub. The sums are integers, which do
/// not depend on the order of threads.
struct DealHubEnds {
  ConstBodyView bodies;
  ContactEnds ends;
  ConstView<std::uint64_t> key;
  ConstView<std::uint64_t> list;
  ConstView<Hub> hubs;
  ConstView<std::int32_t> hub_of;
  std::int64_t first_part;
  View<std::int64_t> weight;
  SCREE_HD void operator()(std::int64_t p) const {
    constexpr double unit = 0x1p40;  // integer weight of the hub's mass
    const std::int64_t begin =
        first_of(hub_of[p]) + (first_part + p - hubs[hub_of[p]].first) * contacts_of_part;
    const double least = bodies.inverse_mass[hubs[hub_of[p]].body];
    std::int64_t sum = 0;
    for (std::int64_t k = begin; k < begin + contacts_of_part && k < list.size() && hub_at(k) == hub_of[p];
         ++k) {
      const auto end = static_cast<std::int64_t>(list[k]);
      ends.put_on(end, static_cast<std::int32_t>(first_part + p));
      sum +=
          1 + static_cast<std::int64_t>(unit * (least / fmax(least, bodies.inverse_mass[ends.other(end)])));
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
/// Computes the share of its hub that each part gets: one half in proportion to the weights, the other half
/// equally. `before`: the sum of the weights of all parts before each part.
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

}  // namespace

template <class Space>
void SolverBodies<Space>::number(const ConstBodyView& bodies, View<Slot> slots) {
  hubs_.resize(0);
  hub_of_.resize(0);
  share_.resize(0);
  number_wall_points(bodies, slots);
  Array<std::int32_t, Space> counts(bodies.count());
  parallel::fill("slots.degree", counts, 0);
  parallel::for_each<Space>("slots.degree", slots.size(),
                            CountSlots{{bodies.mobility, counts.view()}, slots});
  may_have_hubs_ =
      parallel::max<std::int32_t, Space>("slots.degree", counts.size(),
                                         LoadCount{std::as_const(counts).view()}, 0) > most_contacts;
}

template <class Space>
bool SolverBodies<Space>::split_hubs(const ConstBodyView& bodies, const FoundPlaces& found,
                                     View<Slot> places) {
  if (!may_have_hubs_) return false;
  const bool were_there = !hubs_.empty();
  if (were_there)
    parallel::for_each<Space>("contacts.hubs", places.size(), MakeWhole{bodies.mobility, places});
  if (!find_hubs(bodies, found, places)) return were_there;
  deal_ends(bodies, found, places);
  return true;
}

/// Finds the hubs and their parts. Returns whether there are any.
template <class Space>
bool SolverBodies<Space>::find_hubs(const ConstBodyView& bodies, const FoundPlaces& found,
                                    ConstView<Slot> places) {
  const std::int64_t n = bodies.count();
  Array<std::int32_t, Space> counts(n);
  Array<std::uint8_t, Space> marks(n);
  parallel::fill("contacts.hubs", counts, 0);
  parallel::for_each<Space>("contacts.hubs", found.size(),
                            CountContacts{{bodies.mobility, counts.view()}, found, places});
  parallel::for_each<Space>("contacts.hubs", n, MarkHubs{std::as_const(counts).view(), marks.view()});
  hubs_.resize(parallel::exclusive_scan("contacts.hubs", marks, hub_number_));
  hub_of_.resize(0);
  share_.resize(0);
  if (hubs_.empty()) return false;
  Array<std::int32_t, Space> parts(hubs_.size());
  Array<std::int64_t, Space> first;
  parallel::for_each<Space>(
      "contacts.hubs", n,
      ListHubs{std::as_const(counts).view(), std::as_const(hub_number_).view(), hubs_.view(), parts.view()});
  hub_of_.resize(parallel::exclusive_scan("contacts.hubs", parts, first));
  parallel::for_each<Space>("contacts.hubs", hubs_.size(),
                            PlaceHubs{std::as_const(first).view(), first_part_, hubs_.view()});
  parallel::for_each<Space>("contacts.hubs", hub_of_.size(),
                            NameHubs{std::as_const(first).view(), hub_of_.view()});
  return true;
}

/// Deals the ends of contacts on hubs to the parts, and finds each part's share.
template <class Space>
void SolverBodies<Space>::deal_ends(const ConstBodyView& bodies, const FoundPlaces& found,
                                    View<Slot> places) {
  const ContactEnds ends{found, places};
  const ConstView<std::int64_t> number = std::as_const(hub_number_).view();
  Array<std::uint8_t, Space> marks(2 * found.size());
  Array<std::int64_t, Space> to;
  parallel::for_each<Space>("contacts.hubs", marks.size(), MarkHubEnds{ends, number, marks.view()});
  const std::int64_t on_hubs = parallel::exclusive_scan("contacts.hubs", marks, to);
  Array<std::uint64_t, Space> key(on_hubs), list(on_hubs);
  parallel::for_each<Space>("contacts.hubs", marks.size(),
                            ListHubEnds{bodies, ends, std::as_const(to).view(), key.view(), list.view()});
  parallel::sort_by_key("contacts.hubs", key, list,
                        std::bit_width(static_cast<std::uint64_t>(bodies.count())));
  parallel::for_each<Space>("contacts.hubs", on_hubs,
                            KeyOfHubEnd{bodies, ends, number, std::as_const(list).view(), key.view()});
  parallel::sort_by_key("contacts.hubs", key, list,
                        32 + std::bit_width(static_cast<std::uint64_t>(hubs_.size())));
  Array<std::int64_t, Space> weight(hub_of_.size()), before;
  parallel::for_each<Space>(
      "contacts.hubs", hub_of_.size(),
      DealHubEnds{bodies, ends, std::as_const(key).view(), std::as_const(list).view(),
                  std::as_const(hubs_).view(), std::as_const(hub_of_).view(), first_part_, weight.view()});
  parallel::exclusive_scan("contacts.hubs", weight, before);
  share_.resize(hub_of_.size());
  parallel::for_each<Space>(
      "contacts.hubs", hub_of_.size(),
      ShareHub{std::as_const(hubs_).view(), std::as_const(hub_of_).view(), first_part_,
               std::as_const(weight).view(), std::as_const(before).view(), share_.view()});
}

template <class Space>
void SolverBodies<Space>::number_wall_points(const ConstBodyView& bodies, View<Slot> slots) {
  first_wall_point_ = first_part_ = bodies.count() + 1;
  const auto walls =
      parallel::sum_by_tiles<std::int64_t, Space>("slots.walls", bodies.count(), CountTurningWalls{bodies});
  if (walls == 0) return;
  Array<std::uint8_t, Space> marks(slots.size());
  Array<std::int64_t, Space> number;
  parallel::for_each<Space>("slots.walls", slots.size(), MarkWallPoints{bodies, slots, marks.view()});
  first_part_ += parallel::exclusive_scan("slots.walls", marks, number);
  parallel::for_each<Space>("slots.walls", slots.size(),
                            NumberWallPoints{bodies, std::as_const(number).view(), first_wall_point_, slots});
}

#define SCREE_INSTANTIATE(Space) template class SolverBodies<Space>;
SCREE_FOR_EACH_SPACE(SCREE_INSTANTIATE)

}  // namespace scree::solver
