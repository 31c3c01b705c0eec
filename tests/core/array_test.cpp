// Tests of owned arrays and of the copies between spaces.
#include "core/array.hpp"

#include "tests/core/spaces.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <type_traits>
#include <utility>
#include <vector>

namespace scree {
namespace {

template <class Space>
class ArrayTest : public test::InSpace<Space> {};
TYPED_TEST_SUITE(ArrayTest, test::Spaces, test::SpaceName);

std::vector<int> counting(int n) {
  std::vector<int> values(static_cast<std::size_t>(n));
  std::iota(values.begin(), values.end(), 1);
  return values;
}

TYPED_TEST(ArrayTest, StartsEmpty) {
  Array<int, TypeParam> array;
  EXPECT_TRUE(array.empty());
  EXPECT_EQ(array.size(), 0);
  EXPECT_EQ(to_vector(array), std::vector<int>{});
}

TYPED_TEST(ArrayTest, KeepsItsStorageWhenItShrinksAndGrowsBack) {
  Array<int, TypeParam> array(1000);
  const int* storage = array.data();
  array.resize(10);
  EXPECT_EQ(array.size(), 10);
  array.resize(1000);
  EXPECT_EQ(array.data(), storage);
}

TYPED_TEST(ArrayTest, GrowsGeometrically) {
  Array<char, TypeParam> array(1);
  int moves = 0;
  for (std::int64_t n = 2; n <= 100000; ++n) {
    const char* before = array.data();
    array.resize(n);
    if (array.data() != before) ++moves;
  }
  // The bound: log_1.5(100000) = 28.4, and some more moves while half of the size still rounds to nothing.
  EXPECT_LT(moves, 35);
}

TYPED_TEST(ArrayTest, CopiesRoundTrip) {
  const std::vector<int> values = counting(1237);
  Array<int, TypeParam> there;
  copy(there, values);
  Array<int, TypeParam> beside;
  copy(beside, there);
  Array<int, Host> back;
  copy(back, beside);
  EXPECT_EQ(to_vector(there), values);
  EXPECT_EQ(std::vector<int>(back.data(), back.data() + back.size()), values);
}

TYPED_TEST(ArrayTest, CopyTakesTheSizeOfItsSource) {
  Array<int, TypeParam> target(500);
  copy(target, counting(3));
  EXPECT_EQ(to_vector(target), counting(3));
  copy(target, std::vector<int>{});
  EXPECT_TRUE(target.empty());
}

TYPED_TEST(ArrayTest, MoveHandsOverTheStorage) {
  Array<int, TypeParam> from;
  copy(from, counting(7));
  const int* storage = from.data();
  Array<int, TypeParam> to(std::move(from));
  EXPECT_EQ(to.data(), storage);
  Array<int, TypeParam> assigned(3);
  assigned = std::move(to);
  EXPECT_EQ(assigned.data(), storage);
  EXPECT_EQ(to_vector(assigned), counting(7));
}

TEST(HostArray, IsAlignedToCacheLines) {
  for (std::int64_t n : {1, 3, 64, 1001}) {
    Array<char, Host> array(n);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(array.data()) % 64, 0u);
  }
}

TEST(HostArray, ViewsSeeAndChangeTheElements) {
  Array<int, Host> array;
  copy(array, counting(4));
  for (int& value : array.view()) value *= 2;
  const ConstView<int> seen = array.view();
  EXPECT_EQ(std::vector<int>(seen.begin(), seen.end()), (std::vector<int>{2, 4, 6, 8}));
}

TYPED_TEST(ArrayTest, PeakOfMemoryKnowsWhatWasFreed) {
  constexpr std::size_t bytes = std::size_t{64} << 20;
  TypeParam::synchronize();
  TypeParam::forget_peak();
  const MemoryUse before = TypeParam::memory_use();
  if (before.now == 0 && std::is_same_v<TypeParam, Host>) GTEST_SKIP() << "the system does not tell";
  {
    const std::vector<char> touched(bytes, 'x');
    Array<char, TypeParam> array;
    copy(array, touched);
    EXPECT_GE(TypeParam::memory_use().now, before.now + bytes);
  }
  EXPECT_GE(TypeParam::memory_use().peak, before.now + bytes);
  TypeParam::forget_peak();
  const MemoryUse after = TypeParam::memory_use();
  EXPECT_LT(after.peak, after.now + bytes / 2);
}

}  // namespace
}  // namespace scree
