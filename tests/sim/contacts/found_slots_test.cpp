// Tests of the slots that have a contact, which are brought together tile by tile.
#include "sim/contacts/found_slots.hpp"

#include "tests/core/spaces.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

namespace scree::solver {
namespace {

constexpr std::size_t tile = 256;

template <class Space>
class FoundSlotsTest : public test::InSpace<Space> {};
TYPED_TEST_SUITE(FoundSlotsTest, test::Spaces, test::SpaceName);

/// Returns the joined list of tiles that have found these slots.
template <class Space>
std::vector<std::int32_t> join(const std::vector<std::vector<std::int32_t>>& tiles) {
  FoundSlots<Space> found;
  found.start(std::ssize(tiles));
  std::vector<std::int32_t> places(tile * tiles.size(), -7), counts;
  for (std::size_t t = 0; t < tiles.size(); ++t) {
    std::ranges::copy(tiles[t], places.begin() + static_cast<std::ptrdiff_t>(t * tile));
    counts.push_back(static_cast<std::int32_t>(tiles[t].size()));
  }
  copy_bytes<Space, Host>(found.places(), places.data(), places.size() * sizeof(std::int32_t));
  copy_bytes<Space, Host>(found.counts(), counts.data(), counts.size() * sizeof(std::int32_t));
  found.join();
  std::vector<std::int32_t> all(static_cast<std::size_t>(found.all().size()));
  copy_bytes<Host, Space>(all.data(), found.all().data(), all.size() * sizeof(std::int32_t));
  return all;
}

TYPED_TEST(FoundSlotsTest, AreInTheOrderOfTheirTiles) {
  EXPECT_EQ(join<TypeParam>({{2, 5, 255}, {}, {512}, {}, {1024, 1279}}),
            (std::vector<std::int32_t>{2, 5, 255, 512, 1024, 1279}));
}

TYPED_TEST(FoundSlotsTest, AFullTileIsKeptWhole) {
  std::vector<std::int32_t> full, expected{3};
  for (std::int32_t k = 256; k < 512; ++k) full.push_back(k);
  expected.insert(expected.end(), full.begin(), full.end());
  expected.push_back(600);
  EXPECT_EQ(join<TypeParam>({{3}, full, {600}}), expected);
}

TYPED_TEST(FoundSlotsTest, NoneAreFound) { EXPECT_TRUE(join<TypeParam>({{}, {}}).empty()); }

}  // namespace
}  // namespace scree::solver
