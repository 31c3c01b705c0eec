// Colours of contacts: no two of one colour share a free body, few are needed, and they are those of a greedy
// colouring in the order of the ranks, wherever the bodies lie.
#include "sim/resident/contact_colors.hpp"

#include "core/parallel.hpp"
#include "core/rng.hpp"
#include "core/space_tiles.hpp"
#include "tests/core/spaces.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

namespace scree::resident {
namespace {

constexpr std::int32_t bodies = 500;
constexpr std::int64_t tiles = 8;
constexpr std::int64_t places = tiles * parallel::tile;
constexpr std::int32_t fixed = 3;  // of the numbers, that below are not free

using PairOfNumbers = std::pair<std::int32_t, std::int32_t>;

/// Contacts at the fronts of the tiles, some of bodies that are not free; a tile is a colour of slots.
template <class Space>
struct Contacts {
  Array<Slot, Space> slots;
  Array<std::uint8_t, Space> slot;
  Array<Ends, Space> ends;
  Array<BodyRecord<double>, Space> solver;
  Array<BodyNumber, Space> number;
  ContactList<Space> list;
  std::vector<Slot> slots_on_host;

  /// `place_of`: where the body of each number lies.
  explicit Contacts(const std::vector<std::int32_t>& place_of) {
    std::vector<BodyNumber> numbers(bodies);
    std::vector<BodyRecord<double>> records(bodies);
    for (std::int32_t n = 0; n < bodies; ++n) {
      const auto place = static_cast<std::size_t>(place_of[static_cast<std::size_t>(n)]);
      numbers[place] = BodyNumber{n};
      records[place].inverse_mass = n < fixed ? 0 : 1;
    }
    slots_on_host.resize(places);
    std::vector<std::uint8_t> of_tile(places);
    std::vector<Ends> of_contact(places);
    std::vector<std::int32_t> found(tiles);
    Random random(7, 0);
    std::set<PairOfNumbers> taken;
    for (std::int64_t t = 0; t < tiles; ++t) {
      found[static_cast<std::size_t>(t)] = t == 3 ? 0 : static_cast<std::int32_t>(100 + 13 * t);
      for (std::int32_t k = 0; k < found[static_cast<std::size_t>(t)];) {
        const auto i = static_cast<std::int32_t>(random.uniform() * bodies);
        const auto j = static_cast<std::int32_t>(random.uniform() * bodies);
        if (i >= j || j < fixed || !taken.insert({i, j}).second) continue;
        const std::int32_t at_i = place_of[static_cast<std::size_t>(i)];
        const std::int32_t at_j = place_of[static_cast<std::size_t>(j)];
        // The contact is of the slot two places on.
        const auto c = static_cast<std::size_t>(t * parallel::tile + k);
        slots_on_host[c + 2] = {.i = at_i, .j = at_j, .end_i = at_i, .end_j = at_j};
        of_tile[c] = static_cast<std::uint8_t>(k + 2);
        of_contact[c] = {at_i, at_j};
        ++k;
      }
    }
    copy(slots, slots_on_host);
    copy(slot, of_tile);
    copy(ends, of_contact);
    copy(solver, records);
    copy(number, numbers);
    Array<std::int32_t, Space> counts;
    copy(counts, found);
    ColorTiles colors;
    colors.begin.resize(tiles + 1);
    std::iota(colors.begin.begin(), colors.begin.end(), 0);
    list.take(colors);
    list.make(counts, 1);
  }
  void color() {
    ContactColors<Space, double> colors;
    colors.color({.places = std::as_const(slots).view(),
                  .slot = std::as_const(slot).view(),
                  .ends = ends.data(),
                  .solver = std::as_const(solver).view(),
                  .number = std::as_const(number).view()},
                 bodies, list);
  }
  /// Of each pair of bodies, by their numbers.
  std::map<PairOfNumbers, int> colors() const {
    std::vector<std::int32_t> visits(static_cast<std::size_t>(list.visits().size()));
    copy_bytes<Host, Space>(visits.data(), list.visits().data(), visits.size() * sizeof(std::int32_t));
    const std::vector<Ends> on = to_vector(ends);
    const std::vector<BodyNumber> numbers = to_vector(number);
    const auto number_at = [&](std::int32_t k) {
      return static_cast<std::int32_t>(numbers[static_cast<std::size_t>(k)]);
    };
    std::map<PairOfNumbers, int> colors;
    for (std::int64_t c = 0; c < list.colors(); ++c) {
      for (std::int64_t v = list.visits_begin()[static_cast<std::size_t>(c)];
           v < list.visits_begin()[static_cast<std::size_t>(c) + 1]; ++v) {
        const Ends& of = on[static_cast<std::size_t>(visits[static_cast<std::size_t>(v)])];
        EXPECT_TRUE(colors.insert({{number_at(of.i), number_at(of.j)}, static_cast<int>(c)}).second);
      }
    }
    return colors;
  }
};

template <class Space>
class ContactColorsTest : public test::InSpace<Space> {};
TYPED_TEST_SUITE(ContactColorsTest, test::Spaces, test::SpaceName);

TYPED_TEST(ContactColorsTest, AreThoseOfAGreedyColouringWhereverBodiesLie) {
  std::vector<std::int32_t> in_order(bodies), in_disorder(bodies);
  std::iota(in_order.begin(), in_order.end(), 0);
  for (std::int32_t n = 0; n < bodies; ++n) in_disorder[static_cast<std::size_t>(n)] = (37 * n + 11) % bodies;
  Contacts<TypeParam> here(in_order), there(in_disorder);
  EXPECT_EQ(here.list.colors(), tiles - 1) << "a colour without contacts is none";
  here.color();
  there.color();
  const std::map<PairOfNumbers, int> colors = here.colors();
  EXPECT_EQ(std::ssize(colors), here.list.size());
  EXPECT_EQ(colors, there.colors());

  std::vector<BodyNumber> numbers;
  for (std::int32_t n = 0; n < bodies; ++n) numbers.push_back(BodyNumber{n});
  std::vector<Slot> by_rank;
  for (const Slot& slot : here.slots_on_host)
    if (slot.i != Slot::empty) by_rank.push_back(slot);
  std::ranges::sort(by_rank, {}, [&](const Slot& slot) {
    return rank_of(slot, {numbers.data(), std::ssize(numbers)});
  });
  std::vector<std::uint64_t> taken(bodies);
  for (const Slot& slot : by_rank) {
    std::uint64_t none = 0;
    std::uint64_t& of_i = slot.i < fixed ? none : taken[static_cast<std::size_t>(slot.i)];
    std::uint64_t& of_j = taken[static_cast<std::size_t>(slot.j)];
    int lowest = 0;
    while (((of_i | of_j) >> lowest & 1) != 0) ++lowest;
    of_i |= std::uint64_t{1} << lowest;
    of_j |= std::uint64_t{1} << lowest;
    ASSERT_EQ(colors.at({slot.i, slot.j}), lowest);
  }
}

TYPED_TEST(ContactColorsTest, NoContactsHaveNoColours) {
  Contacts<TypeParam> contacts(std::vector<std::int32_t>(bodies, 0));
  Array<std::int32_t, TypeParam> none;
  copy(none, std::vector<std::int32_t>(tiles, 0));
  contacts.list.make(none, 1);
  contacts.color();
  EXPECT_EQ(contacts.list.colors(), 0);
}

}  // namespace
}  // namespace scree::resident
