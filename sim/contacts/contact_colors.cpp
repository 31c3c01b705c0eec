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

/// The contacts that are coloured, which are known by their slots.
struct ColoredContacts {
  ConstView<Slot> slots;
  ConstView<Mobility> mobility;
  ConstView<BodyNumber> number;

  SCREE_HD FreeEnds ends(std::int32_t s) const {
    const Slot& at = slots[s];
    return {mobility[at.i] == Mobility::free ? at.end_i : -1,
            mobility[at.j] == Mobility::free ? at.end_j : -1};
  }
  /// Returns the rank of a contact among its neighbours. It is as good as random. No two contacts have the
  /// same rank, since each step of the mixing can be undone. It depends only on the numbers of the bodies and
  /// on the surface. There are fewer than 2^30 bodies, since each takes some 100 bytes, and at most 16
  /// surfaces of a pair. No rank is UncoloredContact::colored, which bodies 870,744,363 and 1,067,891,420
  /// would give.
  SCREE_HD std::uint64_t rank(std::int32_t s) const {
    const Slot& at = slots[s];
    const auto bits_of = [&](std::int32_t body) { return static_cast<std::uint64_t>(number[body]); };
    std::uint64_t x = bits_of(at.i) << 34 | bits_of(at.j) << 4 | static_cast<std::uint64_t>(at.surface);
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
  }
};

// The bit that marks a remembered colour while find() looks which contacts are still there. A slot without a
// colour is not marked.
constexpr std::uint8_t is_here = 128;
static_assert((on_part | (on_part - 1)) < is_here);

/// Marks the colours of the contacts that are there, and lists the contacts that have none. `anew`: the taken
/// colours of all bodies are collected, too.
struct MarkColors {
  ColoredContacts contacts;
  ConstView<std::int32_t> found;
  bool anew;
  View<std::uint8_t> remembered;
  View<std::uint64_t> taken;
  View<std::int32_t> uncolored;
  ColorChanges* changes;

  SCREE_HD void operator()(std::int64_t d) const {
    const std::int32_t s = found[d];
    const std::uint8_t was = remembered[s];
    if (was == no_color) {
      uncolored[static_cast<std::int64_t>(count_up_together(&changes->uncolored))] = s;
      return;
    }
    remembered[s] = was | is_here;
    if (!anew) return;
    const FreeEnds ends = contacts.ends(s);
    const std::uint64_t bit = std::uint64_t{1} << was % on_part;
    if (ends.i >= 0) set_bits(&taken[ends.i], bit);
    if (ends.j >= 0) set_bits(&taken[ends.j], bit);
  }
};

/// Forgets the colours of contacts that have gone, and removes the marks of the others. `anew`: the colours
/// of contacts that have gone are not among the taken ones.
struct ForgetGone {
  ColoredContacts contacts;
  bool anew;
  View<std::uint8_t> remembered;
  View<std::uint64_t> taken;
  ColorChanges* changes;

  SCREE_HD void operator()(std::int64_t s) const {
    const std::uint8_t was = remembered[s];
    if (was == no_color) return;
    if ((was & is_here) != 0) {
      remembered[s] = static_cast<std::uint8_t>(was - is_here);
      return;
    }
    remembered[s] = no_color;
    put(&changes->any_gone, 1u);
    if (anew) return;
    const FreeEnds ends = contacts.ends(static_cast<std::int32_t>(s));
    const std::uint64_t bit = std::uint64_t{1} << was % on_part;
    if (ends.i >= 0) clear_bits(&taken[ends.i], bit);
    if (ends.j >= 0) clear_bits(&taken[ends.j], bit);
  }
};

struct GatherUncolored {
  ColoredContacts contacts;
  ConstView<std::int32_t> list;
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

  ColoredContacts contacts;
  ConstView<std::int32_t> list;
  View<UncoloredContact> waiting;
  View<std::uint8_t> remembered;
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
    const bool part = is_on_part(contacts.mobility, contacts.slots[list[item]]);
    remembered[list[item]] = static_cast<std::uint8_t>(lowest | (part ? on_part : 0));
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

/// Loads the colour and the slot of each contact.
struct LoadColors {
  ConstView<std::int32_t> found;
  ConstView<std::uint8_t> remembered;
  View<std::uint8_t> color;
  View<std::int32_t> slot;
  SCREE_HD void operator()(std::int64_t d) const {
    color[d] = remembered[found[d]] % on_part;
    slot[d] = found[d];
  }
};

struct LoadColor {
  ConstView<std::uint8_t> color;
  SCREE_HD int operator()(std::int64_t d) const { return color[d]; }
};

struct PlaceContacts {
  ConstView<std::uint8_t> color;
  ConstView<std::int32_t> slot;
  ConstView<ColorStart> start;
  View<std::int32_t> to;
  SCREE_HD void operator()(std::int64_t k) const {
    const ColorStart& of = start[color[k]];
    to[of.place + (k - of.first)] = slot[k];
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
  const bool keep = colors_ > 0 && colors_ <= colors_at_first_ + most_more;
  const bool anew = !keep || !knows_slots_;
  if (anew) {
    standing_.resize(ends);
    taken_.resize(ends);
    parallel::fill("contacts.color", standing_, ~std::uint64_t{0});
    parallel::fill("contacts.color", taken_, std::uint64_t{0});
  }
  if (!keep) parallel::fill<Space>("contacts.color", remembered, no_color);
  uncolored_.resize(n);
  changes_.resize(1);
  parallel::fill("contacts.color", changes_, ColorChanges{});
  const ColoredContacts contacts{slots, bodies.mobility, bodies.id};
  parallel::for_each<Space>(
      "contacts.color", n,
      MarkColors{contacts, found, anew, remembered, taken_.view(), uncolored_.view(), changes_.data()});
  parallel::for_each<Space>("contacts.color", remembered.size(),
                            ForgetGone{contacts, anew, remembered, taken_.view(), changes_.data()});
  ColorChanges changes;
  copy_bytes<Host, Space>(&changes, changes_.data(), sizeof(changes));
  are_same_ = !anew && changes.uncolored == 0 && changes.any_gone == 0;
  knows_slots_ = true;
  if (are_same_) return;
  uncolored_.resize(static_cast<std::int64_t>(changes.uncolored));
  color_others(slots, bodies, remembered);
  sort(found, remembered);
  if (!keep && n > 0) colors_at_first_ = colors_;
}

/// Colours the contacts that have no colour yet.
template <class Space>
void ContactColors<Space>::color_others(ConstView<Slot> slots, const ConstBodyView& bodies,
                                        View<std::uint8_t> remembered) {
  const ConstView<std::int32_t> list = std::as_const(uncolored_).view();
  if (list.size() == 0) return;
  const ColoredContacts contacts{slots, bodies.mobility, bodies.id};
  waiting_.resize(list.size());
  parallel::for_each<Space>("contacts.color", list.size(), GatherUncolored{contacts, list, waiting_.view()});
  parallel::run_in_phases<Space>(
      "contacts.color",
      ColorRounds{contacts, list, waiting_.view(), remembered, standing_.view(), taken_.view()},
      ColorRounds::State{false});
}

/// Sorts the contacts by their colours, and finds the ranges of the colours.
template <class Space>
void ContactColors<Space>::sort(ConstView<std::int32_t> found, ConstView<std::uint8_t> remembered) {
  constexpr int color_bits = 6;
  static_assert(most_colors <= 1 << color_bits);
  const std::int64_t n = found.size();
  color_.resize(n);
  slot_.resize(n);
  ranges_ = {};
  if (n == 0) return;
  parallel::for_each<Space>("contacts.color", n, LoadColors{found, remembered, color_.view(), slot_.view()});
  parallel::sort_by_key("contacts.color", color_, slot_, color_bits);
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
}

template <class Space>
void ContactColors<Space>::place(View<std::int32_t> slot) const {
  parallel::fill<Space>("contacts.color", slot, Slot::empty);
  parallel::for_each<Space>("contacts.color", color_.size(),
                            PlaceContacts{color_.view(), slot_.view(), start_.view(), slot});
}

#define SCREE_INSTANTIATE(Space) template class ContactColors<Space>;
SCREE_FOR_EACH_SPACE(SCREE_INSTANTIATE)

}  // namespace scree::solver
