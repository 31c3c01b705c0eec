// Contacts one after the other: all that were found, colour by colour; coloured anew in fewer colours.
#include "sim/resident/contact_list.hpp"

#include "core/rng.hpp"
#include "core/space_tiles.hpp"
#include "tests/core/spaces.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <vector>

namespace scree::resident {
namespace {

constexpr std::int64_t tile = parallel::tile;

template <class Space>
class ContactLists : public test::InSpace<Space> {};
TYPED_TEST_SUITE(ContactLists, test::Spaces, test::SpaceName);

/// Forty colours of 3 tiles each, of which every tile has found some places at its front.
struct Found {
  static constexpr std::int64_t colors = 40, tiles_of_color = 3;

  ColorTiles tiles;
  std::vector<std::int32_t> counts;
  std::vector<std::int32_t> places;  // in their order

  Found() {
    Random random(3, 0);
    for (std::int64_t c = 0; c <= colors; ++c) tiles.begin.push_back(7 + tiles_of_color * c);
    for (std::int64_t t = 0; t < colors * tiles_of_color; ++t) {
      counts.push_back(t % 5 == 0 ? 0 : static_cast<std::int32_t>(random.uniform() * 100));
      for (std::int32_t k = 0; k < counts.back(); ++k)
        places.push_back(static_cast<std::int32_t>(tile * t) + k);
    }
  }
  template <class Space>
  ContactList<Space> list() const {
    ContactList<Space> list;
    Array<std::int32_t, Space> found;
    copy(found, counts);
    list.take(tiles);
    list.make(found);
    return list;
  }
};

template <class Space>
std::vector<std::int32_t> places_of(const ContactList<Space>& list) {
  std::vector<std::int32_t> places(static_cast<std::size_t>(list.size()));
  copy_bytes<Host, Space>(places.data(), list.places().data(), places.size() * sizeof(std::int32_t));
  return places;
}

TYPED_TEST(ContactLists, HaveAllThatWereFoundByColour) {
  const Found found;
  const ContactList<TypeParam> list = found.list<TypeParam>();
  EXPECT_EQ(places_of(list), found.places);
  ASSERT_EQ(list.begin().size(), static_cast<std::size_t>(Found::colors + 1));
  std::int64_t sum = 0;
  for (std::size_t c = 0; c < Found::colors; ++c) {
    EXPECT_EQ(list.begin()[c], sum);
    for (std::size_t t = 0; t < Found::tiles_of_color; ++t)
      sum += found.counts[Found::tiles_of_color * c + t];
  }
  EXPECT_EQ(list.begin().back(), sum);
}

TYPED_TEST(ContactLists, AreColouredAnewInAsManyColoursAsABodyHasContacts) {
  constexpr std::int32_t bodies = 1500, parts = 100;  // of which the first is a wall
  const Found found;
  Random random(5, 0);
  std::vector<Ends> ends(static_cast<std::size_t>(Found::colors * Found::tiles_of_color * tile));
  std::vector<int> contacts(bodies + parts, 0);
  for (Ends& at : ends) {
    at.j = 1 + static_cast<std::int32_t>(random.uniform() * (bodies + parts - 1));
    at.i = random.uniform() < 0.2 ? 0 : static_cast<std::int32_t>(random.uniform() * at.j);
  }
  for (const std::int32_t place : found.places) {
    ++contacts[static_cast<std::size_t>(ends[static_cast<std::size_t>(place)].i)];
    ++contacts[static_cast<std::size_t>(ends[static_cast<std::size_t>(place)].j)];
  }
  std::vector<Mobility> mobility(bodies, Mobility::free);
  mobility[0] = Mobility::fixed;
  ContactList<TypeParam> list = found.list<TypeParam>();
  Array<Ends, TypeParam> device_ends;
  Array<Mobility, TypeParam> device_mobility;
  copy(device_ends, ends);
  copy(device_mobility, mobility);
  list.recolor(std::as_const(device_ends).view(), std::as_const(device_mobility).view(), bodies + parts);

  const std::vector<std::int32_t> places = places_of(list);
  std::vector<std::int32_t> sorted = places;
  std::ranges::sort(sorted);
  EXPECT_EQ(sorted, found.places);
  ASSERT_EQ(list.begin().back(), list.size());
  for (std::size_t c = 0; c + 1 < list.begin().size(); ++c) {
    std::set<std::int32_t> seen;
    for (std::int64_t k = list.begin()[c]; k < list.begin()[c + 1]; ++k) {
      const Ends& at = ends[static_cast<std::size_t>(places[static_cast<std::size_t>(k)])];
      for (const std::int32_t body : {at.i, at.j}) {
        if (body > 0) {
          ASSERT_TRUE(seen.insert(body).second) << "body " << body << " twice in colour " << c;
        }
      }
    }
  }
  const int most = *std::max_element(contacts.begin() + 1, contacts.end());
  EXPECT_LT(list.begin().size(), Found::colors);
  EXPECT_LE(list.begin().size() - 1, static_cast<std::size_t>(2 * most - 1));
}

TYPED_TEST(ContactLists, MayBeEmpty) {
  ContactList<TypeParam> list;
  list.take({.begin = {0}});
  list.make({});
  list.recolor({}, {}, 0);
  EXPECT_EQ(list.size(), 0);
  EXPECT_EQ(list.begin(), std::vector<std::int64_t>{0});
}

}  // namespace
}  // namespace scree::resident
