// Tests of the one list of body fields: it is complete, and all functions over fields follow it.
#include "core/bodies.hpp"

#include "core/rng.hpp"
#include "tests/core/spaces.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <numeric>
#include <set>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace scree {
namespace {

BodyTable some_bodies(std::int32_t n) {
  BodyTable bodies;
  for (std::int32_t k = 0; k < n; ++k) {
    Random random(5, static_cast<std::uint64_t>(k));
    const auto vector = [&random] {
      const double x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(-1, 1);
      return Vec3(x, y, z);
    };
    bodies.position.push_back(vector());
    bodies.orientation.push_back(rotation_of(vector()));
    bodies.velocity.push_back(vector());
    bodies.spin.push_back(vector());
    bodies.size.push_back(vector().cwiseAbs());
    bodies.inverse_mass.push_back(random.uniform());
    bodies.inverse_inertia.push_back(vector().cwiseAbs());
    bodies.shape.push_back(k % 2 ? Shape::box : Shape::sphere);
    bodies.mobility.push_back(k % 3 ? Mobility::free : Mobility::fixed);
    bodies.material.push_back(k % 5);
    bodies.id.push_back(BodyNumber{k});
  }
  return bodies;
}

template <class T>
std::vector<std::string> elements_as_bytes(const std::vector<T>& field) {
  std::vector<std::string> elements;
  for (const T& element : field) elements.emplace_back(reinterpret_cast<const char*>(&element), sizeof(T));
  return elements;
}

void expect_same_bits(const BodyTable& a, const BodyTable& b) {
  for_each_field([](const char* name, const auto& x,
                    const auto& y) { EXPECT_EQ(elements_as_bytes(x), elements_as_bytes(y)) << name; },
                 a, b);
}

TEST(BodyFields, ListNamesEveryMemberOnce) {
  BodyTable bodies;
  // This stops compiling when the struct gains or loses a member.
  auto& [a, b, c, d, e, f, g, h, i, j, k, period, place_of] = bodies;
  EXPECT_FALSE(period.exists);    // not a field: all bodies share one period
  EXPECT_TRUE(place_of.empty());  // not a field: it is indexed by number
  const std::set<const void*> members = {&a, &b, &c, &d, &e, &f, &g, &h, &i, &j, &k};
  std::set<const void*> visited;
  std::set<std::string> names;
  for_each_field(
      [&](const char* name, const auto& field) {
        visited.insert(&field);
        names.insert(name);
      },
      bodies);
  EXPECT_EQ(visited, members);
  EXPECT_EQ(names.size(), members.size());
}

// These two fail where nvcc takes View<Vec3> and View<const Vec3> for the same type, as it once did.
static_assert(std::is_same_v<decltype(BodyView::position), View<Vec3>>);
static_assert(std::is_same_v<decltype(ConstBodyView::position), View<const Vec3>>);

TEST(BodyTable, PermuteMovesEveryField) {
  const BodyTable original = some_bodies(101);
  std::vector<std::int32_t> order(101);
  for (std::int32_t k = 0; k < 101; ++k) order[static_cast<std::size_t>(k)] = (k * 37 + 5) % 101;
  BodyTable permuted = original;
  permute(permuted, order);
  for_each_field(
      [&order](const char* name, const auto& before, const auto& after) {
        const auto was = elements_as_bytes(before), is = elements_as_bytes(after);
        for (std::size_t k = 0; k < order.size(); ++k) {
          EXPECT_EQ(is[k], was[static_cast<std::size_t>(order[k])]) << name << '[' << k << ']';
        }
      },
      original, permuted);
}

TEST(BodyTable, HashIsThatOfEqualBodies) {
  EXPECT_EQ(hash_of(some_bodies(20)), hash_of(some_bodies(20)));
  EXPECT_NE(hash_of(some_bodies(20)), hash_of(some_bodies(21)));
}

TEST(BodyTable, HashSeesOneBitInAnyField) {
  BodyTable bodies = some_bodies(20);
  std::set<std::uint64_t> hashes = {hash_of(bodies)};
  std::size_t changes = 0;
  for_each_field(
      [&](const char*, auto& field) {
        for (const std::size_t k : {std::size_t{0}, field.size() - 1}) {
          const auto saved = field[k];
          char first;
          std::memcpy(&first, static_cast<const void*>(&field[k]), 1);
          first ^= 1;
          std::memcpy(static_cast<void*>(&field[k]), &first, 1);
          hashes.insert(hash_of(bodies));
          ++changes;
          field[k] = saved;
        }
      },
      bodies);
  EXPECT_EQ(changes, 22u);
  EXPECT_EQ(hashes.size(), changes + 1);
}

TEST(BodyTable, HashSeesExchangedFields) {
  BodyTable bodies = some_bodies(20);
  const std::uint64_t before = hash_of(bodies);
  bodies.velocity.swap(bodies.spin);
  EXPECT_NE(hash_of(bodies), before);
}

TEST(BodySizes, OfEachShape) {
  const Vec3 size(3, 4, 12);
  EXPECT_EQ(bounding_radius(Shape::box, size), 13.0);
  EXPECT_EQ(smallest_size(Shape::box, size), 3.0);
  EXPECT_EQ(bounding_radius(Shape::sphere, size), 3.0);
  EXPECT_EQ(smallest_size(Shape::sphere, size), 3.0);
  EXPECT_EQ(bounding_radius(Shape::plane, size), HUGE_VAL);
  EXPECT_EQ(smallest_size(Shape::plane, size), HUGE_VAL);
  EXPECT_EQ(bounding_radius(Shape::tube, Vec3(3, 3, 4)), 5.0);
  EXPECT_EQ(smallest_size(Shape::tube, size), HUGE_VAL);
}

TEST(BodySizes, EqualMoments) {
  EXPECT_TRUE(has_equal_moments(Vec3(2, 2, 2)));
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 moments(2, 2, 2);
    moments[axis] = 1;
    EXPECT_FALSE(has_equal_moments(moments)) << "axis " << axis;
  }
}

template <class Space>
class BodiesTest : public test::InSpace<Space> {};
TYPED_TEST_SUITE(BodiesTest, test::Spaces, test::SpaceName);

TYPED_TEST(BodiesTest, RoundTripKeepsEveryBit) {
  const BodyTable original = some_bodies(777);
  Bodies<TypeParam> there;
  copy_bodies(there, original);
  EXPECT_EQ(there.count(), 777);
  BodyTable back;
  copy_bodies(back, there);
  expect_same_bits(back, original);
  EXPECT_EQ(hash_of(back), hash_of(original));
}

TYPED_TEST(BodiesTest, ViewsAreOfTheArrays) {
  Bodies<TypeParam> there;
  copy_bodies(there, some_bodies(3));
  const BodyView views = view_of(there);
  const ConstBodyView const_views = view_of(std::as_const(there));
  for_each_field(
      [](const char* name, const auto& field, const auto& view, const auto& const_view) {
        EXPECT_EQ(view.data(), field.data()) << name;
        EXPECT_EQ(const_view.data(), field.data()) << name;
        EXPECT_EQ(view.size(), 3) << name;
        EXPECT_EQ(const_view.size(), 3) << name;
      },
      there, views, const_views);
}

}  // namespace
}  // namespace scree
