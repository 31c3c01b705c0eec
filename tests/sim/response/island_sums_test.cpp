// Tests of sums over the contacts of each island.
#include "sim/response/island_sums.hpp"

#include "core/parallel.hpp"
#include "tests/core/spaces.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <utility>
#include <vector>

namespace scree::solver {
namespace {

template <class Space>
class IslandSumsTest : public test::InSpace<Space> {};
TYPED_TEST_SUITE(IslandSumsTest, test::Spaces, test::SpaceName);

/// The term of contact c is the number at c.
struct NumberOf {
  ConstView<double> numbers;
  SCREE_HD double operator()(std::int64_t c) const { return numbers[c]; }
};

/// Bodies 0 to 5 are free and body 6 is not. The solver has them in another order, with the free ones first.
constexpr std::int32_t fixed = 6, bodies = 7;
constexpr std::int32_t end_of_body[bodies] = {3, 5, 0, 4, 1, 2, 6};

/// Contacts in blocks that are not full. Slots without a contact lie between those with one.
template <class Space>
class Problem {
 public:
  explicit Problem(const std::vector<std::vector<std::pair<std::int32_t, std::int32_t>>>& blocks) {
    const std::size_t contacts = blocks.size() * simd::width;
    std::vector<Ends> ends(contacts);
    std::vector<std::int32_t> slot(contacts, Slot::empty);
    std::vector<double> numbers(contacts);
    std::vector<Slot> places;
    double number = 1;
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      for (std::size_t k = 0; k < blocks[b].size(); ++k) {
        const auto [i, j] = blocks[b][k];
        const std::size_t c = b * simd::width + k;
        places.push_back({});
        slot[c] = static_cast<std::int32_t>(places.size());
        places.push_back({.i = i, .j = j});
        ends[c] = {end_of_body[i], end_of_body[j]};
        numbers[c] = number;
        number *= 2;
      }
    }
    std::vector<BodyRecord<double>> solver(bodies);
    for (std::int32_t k = 0; k < bodies; ++k) solver[end_of_body[k]].inverse_mass = k == fixed ? 0 : 1;
    copy(places_, places);
    copy(ends_, ends);
    copy(slot_, slot);
    copy(numbers_, numbers);
    copy(solver_, solver);
  }

  IslandSums<Space, double> sums() {
    BallContacts<double> contacts;
    contacts.ends = ends_.data();
    contacts.slot = slot_.view();
    IslandSums<Space, double> all(bodies);
    all.add(TermOfIsland<double, BallContacts<double>, NumberOf>{std::as_const(places_).view(),
                                                                 0,
                                                                 contacts,
                                                                 std::as_const(solver_).view(),
                                                                 {std::as_const(numbers_).view()}});
    return all;
  }

 private:
  Array<Slot, Space> places_;
  Array<Ends, Space> ends_;
  Array<std::int32_t, Space> slot_;
  Array<double, Space> numbers_;
  Array<BodyRecord<double>, Space> solver_;
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
  // There is a chain 0-1-2 over both blocks, a pair 4-5, and body 3 alone on the fixed body, which connects
  // nothing.
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
}  // namespace scree::solver
