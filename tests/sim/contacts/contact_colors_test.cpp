// Tests of the colours of contacts: contacts of one colour share no free body, and most keep their colour.
#include "sim/contacts/contact_colors.hpp"

#include "core/parallel.hpp"
#include "core/rng.hpp"
#include "tests/core/spaces.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <set>
#include <utility>
#include <vector>

namespace scree::solver {
namespace {

template <class Space>
class ContactColorsTest : public test::InSpace<Space> {};
TYPED_TEST_SUITE(ContactColorsTest, test::Spaces, test::SpaceName);

constexpr std::int32_t bodies = 400, plane = 0, hub = 1, first_part = bodies + 1, parts = 40;

/// Slots between random balls, on a plane, and on the parts of a hub; some of the slots have a contact.
template <class Space>
class Crowd {
 public:
  explicit Crowd(std::uint64_t seed, std::int32_t first_number = 0) : random_(seed, 0) {
    BodyTable table;
    for (std::int32_t k = 0; k < bodies; ++k) {
      table.id.push_back(BodyNumber{(k + first_number) % bodies});
      table.mobility.push_back(k == plane ? Mobility::fixed : Mobility::free);
    }
    table.position.assign(bodies, Vec3::Zero());
    table.orientation.assign(bodies, Quat::Identity());
    table.velocity.assign(bodies, Vec3::Zero());
    table.spin.assign(bodies, Vec3::Zero());
    table.size.assign(bodies, Vec3::Ones());
    table.inverse_mass.assign(bodies, 1);
    table.inverse_inertia.assign(bodies, Vec3::Ones());
    table.shape.assign(bodies, Shape::sphere);
    table.material.assign(bodies, 0);
    copy_bodies(bodies_, table);
    std::set<std::pair<std::int32_t, std::int32_t>> pairs;
    const auto body = [&] {
      return hub + 1 + static_cast<std::int32_t>(random_.uniform() * (bodies - hub - 1));
    };
    while (pairs.size() < 1600) {
      const std::int32_t i = body(), j = body();
      if (i < j) pairs.insert({i, j});
    }
    for (std::int32_t k = 2; k < bodies; k += 3) pairs.insert({plane, k});
    for (std::int32_t k = 2; k < bodies; k += 2) pairs.insert({hub, k});
    std::int32_t on_hub = 0;
    for (const auto& [i, j] : pairs)
      slots_.push_back({.i = i, .j = j, .end_i = i == hub ? first_part + on_hub++ % parts : i, .end_j = j});
    copy(slots_in_space_, slots_);
    remembered_.resize(slots_in_space_.size());
    parallel::fill("test", remembered_, no_color);
  }

  /// Gives 60 % of the slots a contact at first. Later, about one slot in `one_in` gets a contact or loses
  /// its own.
  void change(int one_in) {
    if (found_.empty()) {
      for (std::size_t s = 0; s < slots_.size(); ++s)
        if (random_.uniform() < 0.6) found_.push_back(static_cast<std::int32_t>(s));
      return;
    }
    std::set<std::int32_t> now(found_.begin(), found_.end());
    for (std::size_t s = 0; s < slots_.size(); ++s) {
      if (random_.uniform() * one_in > 1) continue;
      if (const auto place = static_cast<std::int32_t>(s); !now.insert(place).second) now.erase(place);
    }
    found_.assign(now.begin(), now.end());
  }

  void lose_first() {
    lost_ = found_.front();
    found_.erase(found_.begin());
  }
  void regain_first() { found_.insert(found_.begin(), lost_); }

  /// Returns the slot of each contact, with empty ones at the end of each colour.
  std::vector<std::int32_t> color() {
    Array<std::int32_t, Space> found, slot;
    copy(found, found_);
    colors_.find(std::as_const(found).view(), std::as_const(slots_in_space_).view(),
                 view_of(std::as_const(bodies_)), first_part + parts, remembered_.view());
    slot.resize(colors_.ranges().places());
    colors_.place(slot.view());
    return to_vector(slot);
  }

  /// Returns the colour of each slot with a contact, and tests what colours promise.
  std::map<std::int32_t, int> expect_colors(const std::vector<std::int32_t>& slot) const {
    const ColorRanges& ranges = colors_.ranges();
    std::map<std::int32_t, int> color_of;
    EXPECT_EQ(ranges.contacts(), std::ssize(found_));
    for (int k = 0; k < ranges.colors(); ++k) {
      const auto at = static_cast<std::size_t>(k);
      EXPECT_EQ(ranges.begin[at] % simd::width, 0);
      EXPECT_GT(ranges.count[at], 0);
      std::set<std::int32_t> used;
      for (std::int64_t c = ranges.begin[at]; c < ranges.begin[at + 1]; ++c) {
        const std::int32_t place = slot[static_cast<std::size_t>(c)];
        EXPECT_EQ(place == Slot::empty, c >= ranges.begin[at] + ranges.count[at]);
        if (place == Slot::empty) continue;
        EXPECT_TRUE(c == ranges.begin[at] || slot[static_cast<std::size_t>(c - 1)] < place);
        const Slot& of = slots_[static_cast<std::size_t>(place)];
        EXPECT_TRUE(of.i == plane || used.insert(of.end_i).second) << of.end_i << " twice in " << k;
        EXPECT_TRUE(used.insert(of.end_j).second) << of.end_j << " twice in " << k;
        EXPECT_TRUE(color_of.insert({place, k}).second);
      }
    }
    for (const std::int32_t place : found_) EXPECT_TRUE(color_of.contains(place));
    return color_of;
  }

  bool are_same() const { return colors_.are_same(); }
  void forget() { colors_.forget(); }
  std::vector<std::uint8_t> remembered() const { return to_vector(remembered_); }
  const std::vector<std::int32_t>& found() const { return found_; }
  const std::vector<Slot>& slots() const { return slots_; }

 private:
  Random random_;
  Bodies<Space> bodies_;
  std::vector<Slot> slots_;
  Array<Slot, Space> slots_in_space_;
  std::vector<std::int32_t> found_;
  std::int32_t lost_ = 0;
  Array<std::uint8_t, Space> remembered_;
  ContactColors<Space> colors_;
};

/// Returns the colours that are remembered.
std::map<std::int32_t, int> kept(const std::vector<std::uint8_t>& remembered) {
  std::map<std::int32_t, int> colors;
  for (std::size_t s = 0; s < remembered.size(); ++s)
    if (remembered[s] != no_color) colors[static_cast<std::int32_t>(s)] = remembered[s] % on_part;
  return colors;
}

TYPED_TEST(ContactColorsTest, ContactsOfAColourShareNoFreeBody) {
  Crowd<TypeParam> crowd(3);
  crowd.change(1);
  crowd.expect_colors(crowd.color());
}

TYPED_TEST(ContactColorsTest, MostKeepTheirs) {
  Crowd<TypeParam> crowd(4);
  crowd.change(1);
  crowd.color();
  const auto before = kept(crowd.remembered());
  ASSERT_EQ(before.size(), crowd.found().size());
  crowd.change(20);
  crowd.expect_colors(crowd.color());
  const auto after = kept(crowd.remembered());
  EXPECT_EQ(after.size(), crowd.found().size());
  std::size_t persisting = 0;
  for (const auto& [place, color] : after) {
    const auto was = before.find(place);
    if (was == before.end()) continue;
    EXPECT_EQ(was->second, color) << place;
    ++persisting;
  }
  EXPECT_GT(persisting, crowd.found().size() * 9 / 10);
  EXPECT_LT(persisting, crowd.found().size());
}

/// Colours that are kept leave gaps: all contacts are coloured anew before there are many more colours than
/// are needed.
TYPED_TEST(ContactColorsTest, TheirNumberDoesNotGrow) {
  Crowd<TypeParam> crowd(5);
  crowd.change(1);
  crowd.color();
  std::size_t most = 0;
  for (int k = 0; k < 100; ++k) {
    crowd.change(6);
    const auto colors = crowd.expect_colors(crowd.color());
    std::set<int> used;
    for (const auto& [place, color] : colors) used.insert(color);
    most = std::max(most, used.size());
  }
  EXPECT_LE(most, 20u);
}

TYPED_TEST(ContactColorsTest, TheSameContactsStayWhereTheyAre) {
  Crowd<TypeParam> crowd(8);
  crowd.change(1);
  const std::vector<std::int32_t> slot = crowd.color();
  EXPECT_FALSE(crowd.are_same());
  EXPECT_EQ(crowd.color(), slot);
  EXPECT_TRUE(crowd.are_same());
  // One contact goes and none comes, then it comes again: both times the contacts are not the same.
  crowd.lose_first();
  crowd.expect_colors(crowd.color());
  EXPECT_FALSE(crowd.are_same());
  crowd.regain_first();
  EXPECT_EQ(crowd.color(), slot);
  EXPECT_FALSE(crowd.are_same());
  crowd.forget();
  EXPECT_EQ(crowd.color(), slot);
  EXPECT_FALSE(crowd.are_same());
}

/// Which colours are taken is kept from call to call: it must be what the contacts would tell.
TYPED_TEST(ContactColorsTest, ChangesGiveTheColoursThatAllContactsWouldGive) {
  Crowd<TypeParam> crowd(9), other(9);
  for (int k = 0; k < 30; ++k) {
    crowd.change(10);
    other.change(10);
    other.forget();
    ASSERT_EQ(crowd.color(), other.color()) << k;
    ASSERT_EQ(crowd.remembered(), other.remembered()) << k;
  }
}

TYPED_TEST(ContactColorsTest, PartsOfHubsAreDealtAnew) {
  Crowd<TypeParam> crowd(6);
  crowd.change(1);
  crowd.color();
  const std::vector<std::uint8_t> remembered = crowd.remembered();
  int parts_seen = 0;
  for (const std::int32_t place : crowd.found()) {
    const auto s = static_cast<std::size_t>(place);
    const bool part = crowd.slots()[s].i == hub;
    parts_seen += part;
    EXPECT_EQ(color_with_new_parts(remembered[s]) == no_color, part);
  }
  EXPECT_GT(parts_seen, 50);
}

TYPED_TEST(ContactColorsTest, NoContactsHaveNoColours) {
  Crowd<TypeParam> crowd(7);
  EXPECT_TRUE(crowd.color().empty());
  crowd.change(1);
  crowd.expect_colors(crowd.color());
}

}  // namespace
}  // namespace scree::solver
