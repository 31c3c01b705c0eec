// Sums over the contacts of each island.
#include "sim/resident/island_sums.hpp"

#include "core/parallel.hpp"
#include "tests/core/spaces.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <utility>
#include <vector>

namespace scree::resident {
namespace {

template <class Space>
class IslandSumsTest : public test::InSpace<Space> {};
TYPED_TEST_SUITE(IslandSumsTest, test::Spaces, test::SpaceName);

/// The sum of contact c is what lies at c.
struct NumberOf {
  ConstView<double> numbers;
  SCREE_HD double operator()(std::int64_t c) const { return numbers[c]; }
};

/// Bodies 0 to 5 are free, 6 is not. The solver has the bodies in another order, and the free ones first.
constexpr std::int32_t fixed = 6, bodies = 7;
constexpr std::int32_t end_of_body[bodies] = {3, 5, 0, 4, 1, 2, 6};

/// Contacts in two tiles of slots, at the front of each. The slots that have none lie before and between
/// those that have.
template <class Space>
class Problem {
 public:
  explicit Problem(const std::vector<std::vector<std::pair<std::int32_t, std::int32_t>>>& tiles) {
    const std::size_t all = tiles.size() * tile_size;
    std::vector<Slot> places(all);
    std::vector<Ends> ends(all);
    std::vector<std::uint8_t> slot(all);
    std::vector<double> numbers(all);
    std::vector<std::int32_t> found;
    ColorTiles colors{{0}};
    double number = 1;
    for (std::size_t t = 0; t < tiles.size(); ++t) {
      for (std::size_t k = 0; k < tiles[t].size(); ++k) {
        const auto [i, j] = tiles[t][k];
        const std::size_t c = t * tile_size + k, in_tile = 3 * k + 2;
        slot[c] = static_cast<std::uint8_t>(in_tile);
        places[t * tile_size + in_tile] = {.i = i, .j = j};
        ends[c] = {end_of_body[i], end_of_body[j]};
        numbers[c] = number;
        number *= 2;
      }
      found.push_back(static_cast<std::int32_t>(tiles[t].size()));
      colors.begin.push_back(static_cast<std::int64_t>(t) + 1);
    }
    std::vector<BodyRecord<double>> solver(bodies);
    for (std::int32_t k = 0; k < bodies; ++k) solver[end_of_body[k]].inverse_mass = k == fixed ? 0 : 1;
    copy(places_, places);
    copy(ends_, ends);
    copy(slot_, slot);
    copy(numbers_, numbers);
    copy(solver_, solver);
    Array<std::int32_t, Space> counts;
    copy(counts, found);
    list_.take(colors);
    list_.make(counts, 1);
  }

  IslandSums<Space, double> sums() {
    BallContacts<double> contacts;
    contacts.ends = ends_.data();
    contacts.slot = slot_.view();
    IslandSums<Space, double> all(bodies);
    all.add(list_, TermOfIsland<double, BallContacts<double>, NumberOf>{std::as_const(places_).view(),
                                                                        0,
                                                                        contacts,
                                                                        std::as_const(solver_).view(),
                                                                        {std::as_const(numbers_).view()}});
    return all;
  }

 private:
  Array<Slot, Space> places_;
  Array<Ends, Space> ends_;
  Array<std::uint8_t, Space> slot_;
  Array<double, Space> numbers_;
  Array<BodyRecord<double>, Space> solver_;
  ContactList<Space> list_;
};

template <class Space>
std::vector<double> sums_of(IslandSums<Space, double> sums) {
  std::vector<double> seen;
  EXPECT_TRUE(sums.all([&](double sum) {
    if (sum != 0) seen.push_back(sum);
    return true;
  }));
  return seen;
}

TYPED_TEST(IslandSumsTest, ContactsThatShareFreeBodiesAddUp) {
  // A chain 0-1-2 over both tiles, a pair 4-5, and 3 alone on what is not free, which connects nothing.
  Problem<TypeParam> problem({{{0, 1}, {3, fixed}, {4, 5}}, {{1, 2}, {fixed, 5}, {fixed, 0}}});
  EXPECT_EQ(sums_of(problem.sums()), (std::vector<double>{1 + 8 + 32, 2, 4 + 16}));
}

TYPED_TEST(IslandSumsTest, OneIslandAmongManyFails) {
  Problem<TypeParam> problem({{{0, 1}, {3, fixed}, {4, 5}}});
  const auto at_most = [&](double most) {
    return problem.sums().all([most](double sum) { return sum <= most; });
  };
  EXPECT_TRUE(at_most(4));
  EXPECT_FALSE(at_most(3.9));
}

TYPED_TEST(IslandSumsTest, NoContactsFailNothing) {
  Problem<TypeParam> problem({{}, {}});
  EXPECT_TRUE(sums_of(problem.sums()).empty());
}

}  // namespace
}  // namespace scree::resident
