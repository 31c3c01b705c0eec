#include "sim/contacts/contact_colors.hpp"

#include "core/parallel.hpp"
#include "core/space_atomic.hpp"
#include "core/space_phases.hpp"
#include "sim/contacts/solver_bodies.hpp"

#include <utility>
#include <vector>

namespace scree::solver {

namespace {

/// The free bodies of the solver on which a contact acts; -1 stands for a body that is not free.
struct FreeEnds {
  std::int32_t i, j;
};

/// The contacts that are coloured.
struct ColoredContacts {
  ConstView<std::int32_t> found;
  ConstView<Slot> slots;
  ConstView<Mobility> mobility;
  ConstView<BodyNumber> number;

  SCREE_HD const Slot& slot(std::int64_t d) const { return slots[found[d]]; }
  SCREE_HD FreeEnds ends(std::int64_t d) const {
    const Slot& at = slot(d);
    return {mobility[at.i] == Mobility::free ? at.end_i : -1,
            mobility[at.j] == Mobility::free ? at.end_j : -1};
  }
  /// Returns the rank of a contact among its neighbours. It is as good as random. No two contacts have the
  /// same rank, since each step of the mixing can be undone. It depends only on the numbers of the bodies and
  /// on the surface. There are fewer than 2^30 bodies, since each takes some 100 bytes, and at most 16
  /// surfaces of a pair. No rank is UncoloredContact::colored, which bodies 870,744,363 and 1,067,891,420
  /// would give.
  SCREE_HD std::uint64_t rank(std::int64_t d) const {
    const Slot& at = slot(d);
    const auto bits_of = [&](std::int32_t body) { return static_cast<std::uint64_t>(number[body]); };
    std::uint64_t x = bits_of(at.i) << 34 | bits_of(at.j) << 4 | static_cast<std::uint64_t>(at.surface);
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
  }
};

struct Uncolored {
  static constexpr std::uint32_t none = 0xffffffffu;
  ConstView<std::int32_t> found;
  ConstView<std::uint8_t> remembered;
  bool keep;
  SCREE_HD std::uint32_t operator()(std::int64_t d) const {
    return !keep || remembered[found[d]] == no_color ? static_cast<std::uint32_t>(d) : none;
  }
};

/// Gives each contact the colour that its slot remembers, if colours are kept, and marks this colour as taken
/// at the contact's free bodies.
struct KeepColors {
  ColoredContacts contacts;
  bool keep;
  ConstView<std::uint8_t> remembered;
  View<std::uint32_t> color;
  View<std::uint32_t> slot;
  View<std::uint64_t> taken;

  SCREE_HD void operator()(std::int64_t d) const {
    const std::uint8_t was = remembered[contacts.found[d]];
    slot[d] = static_cast<std::uint32_t>(contacts.found[d]);
    color[d] = no_color;
    if (!keep || was == no_color) return;
    color[d] = was % on_part;
    const FreeEnds ends = contacts.ends(d);
    if (ends.i >= 0) set_bits(&taken[ends.i], std::uint64_t{1} << color[d]);
    if (ends.j >= 0) set_bits(&taken[ends.j], std::uint64_t{1} << color[d]);
  }
};

struct GatherUncolored {
  ColoredContacts contacts;
  ConstView<std::uint32_t> list;
  View<UncoloredContact> waiting;
  SCREE_HD void operator()(std::int64_t k) const {
    const FreeEnds ends = contacts.ends(list[k]);
    waiting[k] = {contacts.rank(list[k]), ends.i, ends.j};
  }
};

/// Rounds of colouring. In the first phase of a round, the uncoloured contact of lowest rank claims each
/// body. In the second phase, a contact that has claimed both its bodies takes the lowest colour that is free
/// at both (Jones, Plassmann 1993, "A parallel graph coloring heuristic"). In each round at least the contact
/// of lowest rank among all uncoloured ones gets its colour.
struct ColorRounds {
  struct State {
    bool done;
  };
  struct Sum {
    std::int64_t left = 0;
    SCREE_HD friend Sum operator+(const Sum& a, const Sum& b) { return {a.left + b.left}; }
  };
  static constexpr int threads = 256;
  static constexpr int blocks_at_once = 2;

  ConstView<std::uint32_t> list;
  View<UncoloredContact> waiting;
  View<std::uint32_t> color;
  View<std::uint64_t> standing;
  View<std::uint64_t> taken;

  SCREE_HD int phases(const State& state) const { return state.done ? 0 : 2; }
  SCREE_HD std::int64_t items(const State&, int) const { return list.size(); }
  std::int64_t most_items() const { return list.size(); }
  SCREE_HD Sum operator()(const State&, int phase, std::int64_t item) const {
    const UncoloredContact contact = waiting[item];
    if (contact.rank == UncoloredContact::colored) return {};
    if (phase == 0) {
      if (contact.i >= 0) lower(&standing[contact.i], contact.rank);
      if (contact.j >= 0) lower(&standing[contact.j], contact.rank);
      return {};
    }
    const BodyColors at_i = colors_at(contact.i, contact.rank);
    const BodyColors at_j = colors_at(contact.j, contact.rank);
    if (!at_i.is_claimed || !at_j.is_claimed) return {1};
    std::uint32_t lowest = 0;
    while (((at_i.taken | at_j.taken) >> lowest & 1) != 0) ++lowest;
    color[list[item]] = lowest;
    waiting[item].rank = UncoloredContact::colored;
    leave(contact.i, at_i, lowest);
    leave(contact.j, at_j, lowest);
    return {};
  }
  SCREE_HD State judge(const State&, const Sum& sum) const { return {sum.left == 0}; }

 private:
  /// The colours that are taken at a body, and whether the contact that asks has claimed the body.
  struct BodyColors {
    bool is_claimed;
    std::uint64_t taken;
  };
  SCREE_HD BodyColors colors_at(std::int32_t end, std::uint64_t rank) const {
    if (end < 0) return {true, 0};
    return {standing[end] == rank, taken[end]};
  }
  /// Marks a colour as taken at a body and clears the claim for the next round. Only the contact that has
  /// claimed the body gets here, so no other thread writes to it.
  SCREE_HD void leave(std::int32_t end, const BodyColors& before, std::uint32_t at) const {
    if (end < 0) return;
    taken[end] = before.taken | std::uint64_t{1} << at;
    standing[end] = ~std::uint64_t{0};
  }
};

struct RememberColors {
  ColoredContacts contacts;
  ConstView<std::uint32_t> color;
  View<std::uint8_t> remembered;
  SCREE_HD void operator()(std::int64_t d) const {
    const bool part = is_on_part(contacts.mobility, contacts.slot(d));
    remembered[contacts.found[d]] = static_cast<std::uint8_t>(color[d] | (part ? on_part : 0));
  }
};

struct LoadColor {
  ConstView<std::uint32_t> color;
  SCREE_HD int operator()(std::int64_t d) const { return static_cast<int>(color[d]); }
};

template <class T>
struct Fill {
  View<T> of;
  T value;
  SCREE_HD void operator()(std::int64_t k) const { of[k] = value; }
};

struct PlaceContacts {
  ConstView<std::uint32_t> color;
  ConstView<std::uint32_t> slot;
  ConstView<ColorStart> start;
  View<std::int32_t> to;
  SCREE_HD void operator()(std::int64_t k) const {
    const ColorStart& of = start[color[k]];
    to[of.place + (k - of.first)] = static_cast<std::int32_t>(slot[k]);
  }
};

}  // namespace

template <class Space>
void ContactColors<Space>::find(ConstView<std::int32_t> found, ConstView<Slot> slots,
                                const ConstBodyView& bodies, std::int64_t ends,
                                View<std::uint8_t> remembered) {
  // Kept colours leave gaps, so that the number of colours creeps up. When it exceeds that of the last full
  // colouring by more than this, all contacts are coloured anew.
  constexpr int most_more = 3;
  const std::int64_t n = found.size();
  const ColoredContacts contacts{found, slots, bodies.mobility, bodies.id};
  const bool keep = colors_ > 0 && colors_ <= colors_at_first_ + most_more;
  parallel::select("contacts.color", n, Uncolored{found, remembered, keep}, Uncolored::none, uncolored_);
  are_same_ = knows_slots_ && keep && uncolored_.empty() && n == color_.size();
  knows_slots_ = true;
  if (are_same_) return;
  color_.resize(n);
  slot_.resize(n);
  standing_.resize(ends);
  taken_.resize(ends);
  parallel::fill("contacts.color", standing_, ~std::uint64_t{0});
  parallel::fill("contacts.color", taken_, std::uint64_t{0});
  parallel::for_each<Space>(
      "contacts.color", n,
      KeepColors{contacts, keep, remembered, color_.view(), slot_.view(), taken_.view()});
  if (const ConstView<std::uint32_t> list = std::as_const(uncolored_).view(); list.size() > 0) {
    waiting_.resize(list.size());
    parallel::for_each<Space>("contacts.color", list.size(),
                              GatherUncolored{contacts, list, waiting_.view()});
    parallel::run_in_phases<Space>(
        "contacts.color", ColorRounds{list, waiting_.view(), color_.view(), standing_.view(), taken_.view()},
        ColorRounds::State{false});
  }
  parallel::for_each<Space>("contacts.color", remembered.size(), Fill<std::uint8_t>{remembered, no_color});
  parallel::for_each<Space>("contacts.color", n,
                            RememberColors{contacts, std::as_const(color_).view(), remembered});
  ranges_ = {};
  if (n == 0) return;
  parallel::sort_by_key("contacts.color", color_, slot_, 6);
  parallel::histogram<Space>("contacts.color", n, LoadColor{std::as_const(color_).view()}, most_colors,
                             counts_);
  std::vector<ColorStart> start;
  std::int64_t first = 0;
  for (const std::uint32_t count : to_vector(counts_)) {
    start.push_back({first, ranges_.places()});
    first += count;
    if (count > 0) ranges_.add(count);
  }
  copy(start_, start);
  colors_ = ranges_.colors();
  if (!keep) colors_at_first_ = colors_;
}

template <class Space>
void ContactColors<Space>::place(View<std::int32_t> slot) const {
  parallel::for_each<Space>("contacts.color", slot.size(), Fill<std::int32_t>{slot, Slot::empty});
  parallel::for_each<Space>("contacts.color", color_.size(),
                            PlaceContacts{color_.view(), slot_.view(), start_.view(), slot});
}

#define SCREE_INSTANTIATE(Space) template class ContactColors<Space>;
SCREE_FOR_EACH_SPACE(SCREE_INSTANTIATE)

}  // namespace scree::solver
