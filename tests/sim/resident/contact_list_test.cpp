// Lists of contacts: tile by tile and colour by colour, without what is empty.
#include "sim/resident/contact_list.hpp"

#include "tests/core/spaces.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

namespace scree::resident {
namespace {

template <class Space>
class ContactListTest : public test::InSpace<Space> {};
TYPED_TEST_SUITE(ContactListTest, test::Spaces, test::SpaceName);

std::vector<std::int32_t> on_host(ConstView<std::int32_t> list, auto space) {
  std::vector<std::int32_t> all(static_cast<std::size_t>(list.size()));
  copy_bytes<Host, decltype(space)>(all.data(), list.data(), all.size() * sizeof(std::int32_t));
  return all;
}

TYPED_TEST(ContactListTest, HasWhatTilesFoundColourByColour) {
  // Three colours of two tiles, one and two; nothing is of the second.
  const ColorTiles colors{{7, 9, 10, 12}};
  Array<std::int32_t, TypeParam> found;
  copy(found, std::vector<std::int32_t>{3, 0, 0, 9, 1});
  ContactList<TypeParam> list;
  list.take(colors);
  EXPECT_EQ(list.size(), 0);
  EXPECT_EQ(list.visits_begin(), std::vector<std::int64_t>{0});

  list.make(found, 1);
  const std::vector<std::int32_t> contacts{0, 1, 2, 768, 769, 770, 771, 772, 773, 774, 775, 776, 1024};
  EXPECT_EQ(on_host(list.places(), TypeParam{}), contacts);
  EXPECT_EQ(on_host(list.visits(), TypeParam{}), contacts);
  EXPECT_EQ(list.visits_begin(), (std::vector<std::int64_t>{0, 3, 13}));

  list.make(found, 8);
  EXPECT_EQ(on_host(list.places(), TypeParam{}), contacts);
  EXPECT_EQ(on_host(list.visits(), TypeParam{}), (std::vector<std::int32_t>{0, 768, 776, 1024}));
  EXPECT_EQ(list.visits_begin(), (std::vector<std::int64_t>{0, 1, 4}));
}

TYPED_TEST(ContactListTest, NothingFoundIsNoColour) {
  Array<std::int32_t, TypeParam> found;
  copy(found, std::vector<std::int32_t>{0, 0});
  ContactList<TypeParam> list;
  list.take({{0, 1, 2}});
  list.make(found, 1);
  EXPECT_EQ(list.size(), 0);
  EXPECT_EQ(list.visits_begin(), std::vector<std::int64_t>{0});
}

}  // namespace
}  // namespace scree::resident
