#include "sim/resident/contact_list.hpp"

#include "core/parallel.hpp"
#include "core/space_atomic.hpp"
#include "core/space_rounds.hpp"
#include "core/space_tiles.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace scree::resident {

namespace {

constexpr std::int64_t tile = parallel::tile;

struct ListContacts {
  const std::int32_t* found;
  ConstView<std::int64_t> number;
  View<std::int32_t> places;
  SCREE_HD void operator()(std::int64_t place) const {
    if (has_contact(found, place))
      places[number[place / tile] + place % tile] = static_cast<std::int32_t>(place);
  }
};

struct FirstOfColor {
  ConstView<std::int64_t> number;
  ConstView<std::int64_t> tile;
  View<std::int64_t> first;
  SCREE_HD void operator()(std::int64_t c) const { first[c] = number[tile[c]]; }
};

constexpr std::uint8_t uncolored = 255;

struct ColoringState {
  bool started = false;
  bool done = false;
};

/// How many are left.
struct Left {
  std::int64_t count = 0;
  SCREE_HD friend Left operator+(const Left& a, const Left& b) { return {a.count + b.count}; }
};

/// Of the uncoloured contacts of each body the first in rank stands, and one that stands at both its bodies
/// takes the lowest colour that both have left (Jones, Plassmann 1993, "A parallel graph coloring
/// heuristic").
struct ColoringRounds {
  using State = ColoringState;
  using Sum = Left;
  static constexpr int threads = 512;
  static constexpr int blocks_at_once = 2;

  ConstView<std::int32_t> places;
  ConstView<Ends> ends;
  ConstView<Mobility> mobility;
  View<std::uint8_t> color;
  View<std::uint64_t> standing, taken;

  SCREE_HD int phases(const State& state) const {
    if (state.done) return 0;
    return state.started ? 2 : 1;
  }
  SCREE_HD std::int64_t items(const State& state, int) const {
    return state.started ? places.size() : std::max(places.size(), taken.size());
  }
  std::int64_t most_items() const { return std::max(places.size(), taken.size()); }
  SCREE_HD Sum operator()(const State& state, int phase, std::int64_t item) const {
    if (!state.started) {
      if (item < places.size()) color[item] = uncolored;
      if (item >= taken.size()) return {};
      standing[item] = ~std::uint64_t{0};
      taken[item] = 0;
      return {};
    }
    if (color[item] != uncolored) return {};
    const Ends at = ends[places[item]];
    const std::uint64_t rank = rank_of(places[item]);
    const bool free_i = is_free(at.i);
    const bool free_j = is_free(at.j);
    if (phase == 0) {
      if (free_i) lower(&standing[at.i], rank);
      if (free_j) lower(&standing[at.j], rank);
      return {};
    }
    if ((free_i && standing[at.i] != rank) || (free_j && standing[at.j] != rank)) return {1};
    const std::uint64_t used = (free_i ? taken[at.i] : 0) | (free_j ? taken[at.j] : 0);
    int lowest = 0;
    while ((used >> lowest & 1) != 0) ++lowest;
    color[item] = static_cast<std::uint8_t>(lowest);
    // Nobody else stands at these bodies, so the next round may begin.
    if (free_i) take(at.i, lowest);
    if (free_j) take(at.j, lowest);
    return {};
  }
  SCREE_HD State judge(const State& state, const Sum& left) const {
    return {.started = true, .done = state.started && left.count == 0};
  }

 private:
  SCREE_HD bool is_free(std::int32_t end) const {
    return end >= mobility.size() || mobility[end] == Mobility::free;
  }
  SCREE_HD void take(std::int32_t end, int lowest) const {
    taken[end] |= std::uint64_t{1} << lowest;
    standing[end] = ~std::uint64_t{0};
  }
};

struct LoadColor {
  ConstView<std::uint8_t> color;
  SCREE_HD int operator()(std::int64_t k) const { return color[k]; }
};

}  // namespace

template <class Space>
void ContactList<Space>::take(const ColorTiles& colors) {
  std::vector<std::int64_t> tiles;
  for (const std::int64_t t : colors.begin) tiles.push_back(t - colors.begin.front());
  copy(tile_, tiles);
  places_.resize(0);
  begin_.assign(tiles.size(), 0);
}

template <class Space>
void ContactList<Space>::make(const Array<std::int32_t, Space>& found) {
  if (found.empty()) return;
  parallel::exclusive_scan_into("contacts.list", found, number_);
  places_.resize(tile * found.size());
  parallel::for_each<Space>("contacts.list", places_.size(),
                            ListContacts{found.data(), std::as_const(number_).view(), places_.view()});
  first_.resize(tile_.size());
  parallel::for_each<Space>(
      "contacts.list", tile_.size(),
      FirstOfColor{std::as_const(number_).view(), std::as_const(tile_).view(), first_.view()});
  copy(begin_, first_);
  places_.resize(begin_.back());
}

template <class Space>
void ContactList<Space>::recolor(ConstView<Ends> ends, ConstView<Mobility> mobility,
                                 std::int64_t solver_bodies) {
  if (places_.empty()) return;
  color_.resize(places_.size());
  standing_.resize(solver_bodies);
  taken_.resize(solver_bodies);
  parallel::run_rounds<Space>("contacts.recolor",
                              ColoringRounds{std::as_const(places_).view(), ends, mobility, color_.view(),
                                             standing_.view(), taken_.view()},
                              ColoringState{});
  parallel::sort_by_key("contacts.recolor", color_, places_, std::bit_width(unsigned{most_colors} - 1));
  parallel::histogram<Space>("contacts.recolor", places_.size(), LoadColor{std::as_const(color_).view()},
                             most_colors, counts_);
  begin_.assign(1, 0);
  for (const std::uint32_t count : to_vector(counts_))
    if (count > 0) begin_.push_back(begin_.back() + count);
}

#define SCREE_INSTANTIATE(Space) template class ContactList<Space>;
SCREE_FOR_EACH_SPACE(SCREE_INSTANTIATE)

}  // namespace scree::resident
