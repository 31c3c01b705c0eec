#include "sim/resident/contact_colors.hpp"

#include "core/parallel.hpp"
#include "core/space_atomic.hpp"
#include "core/space_rounds.hpp"
#include "sim/resident/slots.hpp"

#include <utility>

namespace scree::resident {

namespace {

constexpr std::uint8_t uncolored = 255;

template <class Real>
struct FindRank {
  ContactEnds<Real> contacts;
  ConstView<std::int32_t> places;
  View<std::uint64_t> rank;
  SCREE_HD void operator()(std::int64_t k) const {
    rank[k] = rank_of(contacts.slot_of(places[k]), contacts.number);
  }
};

struct Uncolored {
  std::int64_t count = 0;
  SCREE_HD friend Uncolored operator+(const Uncolored& a, const Uncolored& b) { return {a.count + b.count}; }
};
struct ColorState {
  bool done = false;
};

/// Rounds of two phases, as those of slots (Jones, Plassmann 1993): of the uncoloured contacts of each body
/// the first in rank stands, and a contact that stands at both its bodies takes the lowest colour that both
/// have left.
template <class Real>
struct ColorRounds {
  using State = ColorState;
  using Sum = Uncolored;
  static constexpr int threads = 256;

  ContactEnds<Real> contacts;
  ConstView<std::int32_t> places;
  ConstView<std::uint64_t> rank;
  View<std::uint8_t> color;
  View<std::uint64_t> standing, taken;

  SCREE_HD int phases(const State& state) const { return state.done ? 0 : 2; }
  SCREE_HD std::int64_t items(const State&, int) const { return places.size(); }
  std::int64_t most_items() const { return places.size(); }
  SCREE_HD Sum operator()(const State&, int phase, std::int64_t k) const {
    if (color[k] != uncolored) return {};
    const Ends ends = contacts.ends[places[k]];
    const bool free_i = contacts.is_free(ends.i), free_j = contacts.is_free(ends.j);
    if (phase == 0) {
      if (free_i) lower(&standing[ends.i], rank[k]);
      if (free_j) lower(&standing[ends.j], rank[k]);
      return {};
    }
    if ((free_i && standing[ends.i] != rank[k]) || (free_j && standing[ends.j] != rank[k])) return {1};
    const std::uint64_t used = (free_i ? taken[ends.i] : 0) | (free_j ? taken[ends.j] : 0);
    int lowest = 0;
    while ((used >> lowest & 1) != 0) ++lowest;
    color[k] = static_cast<std::uint8_t>(lowest);
    // Nobody else stands here, so the next round may begin.
    if (free_i) {
      taken[ends.i] |= std::uint64_t{1} << lowest;
      standing[ends.i] = ~std::uint64_t{0};
    }
    if (free_j) {
      taken[ends.j] |= std::uint64_t{1} << lowest;
      standing[ends.j] = ~std::uint64_t{0};
    }
    return {};
  }
  SCREE_HD State judge(State state, const Sum& left) const {
    state.done = left.count == 0;
    return state;
  }
};

struct Key {
  ConstView<std::uint8_t> color;
  View<std::uint32_t> key;
  SCREE_HD void operator()(std::int64_t k) const { key[k] = color[k]; }
};
struct KeyOf {
  ConstView<std::uint32_t> key;
  SCREE_HD int operator()(std::int64_t k) const { return static_cast<int>(key[k]); }
};

}  // namespace

template <class Space, class Real>
void ContactColors<Space, Real>::color(const ContactEnds<Real>& contacts, std::int64_t bodies,
                                       ContactList<Space>& list) {
  constexpr int color_bits = 6;
  static_assert(most_colors == 1 << color_bits);
  const std::int64_t n = list.size();
  rank_.resize(n);
  color_.resize(n);
  key_.resize(n);
  standing_.resize(bodies);
  taken_.resize(bodies);
  parallel::fill("contacts.color", color_, uncolored);
  parallel::fill("contacts.color", standing_, ~std::uint64_t{0});
  parallel::fill("contacts.color", taken_, std::uint64_t{0});
  parallel::for_each<Space>("contacts.color", n, FindRank<Real>{contacts, list.places(), rank_.view()});
  parallel::run_rounds<Space>("contacts.color",
                              ColorRounds<Real>{contacts, list.places(), std::as_const(rank_).view(),
                                                color_.view(), standing_.view(), taken_.view()},
                              ColorState{.done = n == 0});
  parallel::for_each<Space>("contacts.color", n, Key{std::as_const(color_).view(), key_.view()});
  parallel::histogram<Space>("contacts.color", n, KeyOf{std::as_const(key_).view()}, most_colors, counts_);
  Array<std::int32_t, Space> by_color(n);
  copy_bytes<Space, Space>(by_color.data(), list.places().data(),
                           static_cast<std::size_t>(n) * sizeof(std::int32_t));
  parallel::sort_by_key("contacts.color", key_, by_color, color_bits);
  list.set_visits(std::move(by_color), to_vector(counts_));
}

#define SCREE_INSTANTIATE(Space)               \
  template class ContactColors<Space, double>; \
  template class ContactColors<Space, float>;
SCREE_FOR_EACH_SPACE(SCREE_INSTANTIATE)

}  // namespace scree::resident
