// Tests of the parallel calls against serial loops, and of the sum against long double. All of them must give
// the same bits whatever the number of threads.
#include "core/parallel.hpp"

#include "core/rng.hpp"
#include "core/space_atomic.hpp"
#include "tests/core/spaces.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <exception>
#include <limits>
#include <numeric>
#include <vector>

namespace scree {
namespace {

template <class Space>
class ParallelTest : public test::InSpace<Space> {};
TYPED_TEST_SUITE(ParallelTest, test::Spaces, test::SpaceName);

// Sizes around the serial threshold, the leaf of the sum, and the square of the leaf.
constexpr std::int64_t sizes[] = {0, 1, 2, 255, 256, 257, 1000, 65535, 65536, 65537, 300000};

struct Square {
  std::int64_t* squares;
  SCREE_HD void operator()(std::int64_t i) const { squares[i] = i * i; }
};

// Values of many magnitudes and of both signs, so that any change of grouping shows in the last bits.
struct Wild {
  SCREE_HD double operator()(std::int64_t i) const {
    Random random(11, static_cast<std::uint64_t>(i));
    const double fraction = random.uniform(-1, 1);
    const int exponent = static_cast<int>(random.uniform(-30, 30));
    return ldexp(fraction, exponent);
  }
};

struct Load {
  const std::int64_t* values;
  SCREE_HD std::int64_t operator()(std::int64_t i) const { return values[i]; }
};

// Two threads meet at each place, and the second one reads what the first one has written.
struct Meet {
  std::int32_t* places;  // initially -1
  std::int64_t* written;
  std::int64_t* sums;
  std::int64_t count;
  SCREE_HD void operator()(std::int64_t i) const {
    const std::int64_t place = i % count;
    written[i] = 3 * i + 1;
    const std::int32_t other = exchange(&places[place], static_cast<std::int32_t>(i));
    if (other >= 0) sums[place] = written[i] + written[other];
  }
};

struct CountVisit {
  std::int64_t* times;
  SCREE_HD void operator()(std::int64_t i) const { ++times[i]; }
};

// Many threads update the same minimum, maximum, counter and list.
struct Tell {
  std::uint64_t* least;
  std::uint32_t* most;
  std::uint64_t* count;
  std::int64_t* list;
  SCREE_HD void operator()(std::int64_t i) const {
    const std::int64_t value = i * 7919 % 100003;  // 100003 is prime, so that each value below it comes once
    lower(least, static_cast<std::uint64_t>(value + 5));
    raise(most, static_cast<std::uint32_t>(value));
    list[count_up(count)] = value;
  }
};

// Runs f with exactly `threads` threads allowed, also on machines with fewer cores.
template <class F>
auto with_threads(int threads, F f) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(threads));
  tbb::task_arena arena(threads);
  return arena.execute(f);
}

TYPED_TEST(ParallelTest, ForEachVisitsEveryIndexOnce) {
  for (const std::int64_t n : sizes) {
    Array<std::int64_t, TypeParam> squares(n);
    parallel::for_each<TypeParam>("test.square", n, Square{squares.data()});
    const std::vector<std::int64_t> got = to_vector(squares);
    for (std::int64_t i = 0; i < n; ++i) ASSERT_EQ(got[static_cast<std::size_t>(i)], i * i) << "n = " << n;
  }
}

TYPED_TEST(ParallelTest, ForEachCountedVisitsWhatIsCountedOnce) {
  for (const std::int64_t n : {0, 1, 31, 70000, 200001}) {
    Array<std::int64_t, TypeParam> times(200001);
    Array<std::uint64_t, TypeParam> count;
    copy(count, std::vector<std::uint64_t>{static_cast<std::uint64_t>(n)});
    parallel::fill("test.fill", times, 0);
    parallel::for_each_counted<TypeParam>("test.counted", count.data(), CountVisit{times.data()});
    const std::vector<std::int64_t> got = to_vector(times);
    for (std::int64_t i = 0; i < std::ssize(got); ++i)
      ASSERT_EQ(got[static_cast<std::size_t>(i)], i < n ? 1 : 0) << "n = " << n;
  }
}

TYPED_TEST(ParallelTest, WorksOnAfterAnAllocationThatFailed) {
  EXPECT_THROW((Array<double, TypeParam>(std::int64_t{1} << 50)), std::exception);
  Array<std::int64_t, TypeParam> squares(1000);
  parallel::for_each<TypeParam>("test.square", 1000, Square{squares.data()});
  EXPECT_EQ(to_vector(squares)[999], 999 * 999);
}

TYPED_TEST(ParallelTest, FillSetsEveryValue) {
  Array<std::int64_t, TypeParam> values;
  copy(values, std::vector<std::int64_t>(1000, -1));
  parallel::fill("test.fill", values, std::int64_t{7});
  EXPECT_EQ(to_vector(values), std::vector<std::int64_t>(1000, 7));
}

TYPED_TEST(ParallelTest, ExchangeHandsOnWhatWasWrittenBefore) {
  constexpr std::int64_t count = 100000;
  Array<std::int32_t, TypeParam> places(count);
  Array<std::int64_t, TypeParam> written(2 * count), sums(count);
  parallel::fill("places", places, -1);
  parallel::fill("sums", sums, std::int64_t{0});
  parallel::for_each<TypeParam>("meet", 2 * count, Meet{places.data(), written.data(), sums.data(), count});
  const std::vector<std::int64_t> all = to_vector(sums);
  for (std::int64_t k = 0; k < count; ++k)
    ASSERT_EQ(all[static_cast<std::size_t>(k)], 3 * (k + k + count) + 2);
}

// Each thread sets a bit of a word that it shares with others, or clears it.
struct SetOrClear {
  std::uint64_t* words;
  bool set;
  SCREE_HD void operator()(std::int64_t i) const {
    const std::uint64_t bit = std::uint64_t{1} << (i % 64);
    if (set) {
      set_bits(&words[i / 64], bit);
    } else if (i % 3 != 0) {
      clear_bits(&words[i / 64], bit);
    }
  }
};

TYPED_TEST(ParallelTest, BitsAreSetAndClearedOneByOne) {
  constexpr std::int64_t words = 1000;
  Array<std::uint64_t, TypeParam> bits(words);
  parallel::fill("bits", bits, 0);
  parallel::for_each<TypeParam>("set", 64 * words, SetOrClear{bits.data(), true});
  EXPECT_EQ(to_vector(bits), std::vector<std::uint64_t>(words, ~std::uint64_t{0}));
  parallel::for_each<TypeParam>("clear", 64 * words, SetOrClear{bits.data(), false});
  const std::vector<std::uint64_t> left = to_vector(bits);
  for (std::int64_t i = 0; i < 64 * words; ++i)
    ASSERT_EQ(left[static_cast<std::size_t>(i / 64)] >> (i % 64) & 1, i % 3 == 0 ? 1u : 0u) << i;
}

TYPED_TEST(ParallelTest, LowerRaiseAndCountMissNobody) {
  constexpr std::int64_t n = 100003;
  Array<std::uint64_t, TypeParam> least(1), count(1);
  Array<std::uint32_t, TypeParam> most(1);
  Array<std::int64_t, TypeParam> list(n);
  parallel::fill("least", least, ~std::uint64_t{0});
  parallel::fill("most", most, std::uint32_t{0});
  parallel::fill("count", count, std::uint64_t{0});
  parallel::for_each<TypeParam>("tell", n, Tell{least.data(), most.data(), count.data(), list.data()});
  EXPECT_EQ(to_vector(least)[0], 5u);
  EXPECT_EQ(to_vector(most)[0], static_cast<std::uint32_t>(n - 1));
  EXPECT_EQ(to_vector(count)[0], static_cast<std::uint64_t>(n));
  std::vector<std::int64_t> all = to_vector(list);
  std::sort(all.begin(), all.end());
  for (std::int64_t k = 0; k < n; ++k) ASSERT_EQ(all[static_cast<std::size_t>(k)], k);
}

TYPED_TEST(ParallelTest, SumAgreesWithLongDouble) {
  for (const std::int64_t n : sizes) {
    long double exact = 0;
    long double magnitude = 0;
    for (std::int64_t i = 0; i < n; ++i) {
      exact += static_cast<long double>(Wild{}(i));
      magnitude += std::fabs(static_cast<long double>(Wild{}(i)));
    }
    const double sum = parallel::sum<double, TypeParam>("test.sum", n, Wild{});
    // The depth of the tree is at most 256 additions on each of at most three levels.
    const double bound = 3 * 256 * std::numeric_limits<double>::epsilon() * static_cast<double>(magnitude);
    EXPECT_NEAR(sum, static_cast<double>(exact), bound) << "n = " << n;
  }
}

TYPED_TEST(ParallelTest, SumHasTheSameBitsForAnyNumberOfThreads) {
  for (const std::int64_t n : sizes) {
    const auto bits = [n] {
      return std::bit_cast<std::uint64_t>(parallel::sum<double, TypeParam>("test.sum", n, Wild{}));
    };
    const std::uint64_t one = with_threads(1, bits);
    EXPECT_EQ(with_threads(2, bits), one) << "n = " << n;
    EXPECT_EQ(with_threads(4, bits), one) << "n = " << n;
  }
}

TYPED_TEST(ParallelTest, SumHasTheBitsOfTheDocumentedTree) {
  const std::int64_t n = 70000;
  std::vector<double> level(static_cast<std::size_t>(n));
  for (std::int64_t i = 0; i < n; ++i) level[static_cast<std::size_t>(i)] = Wild{}(i);
  while (level.size() > 1) {
    std::vector<double> next;
    for (std::size_t first = 0; first < level.size(); first += 256) {
      const std::size_t last = std::min(level.size(), first + 256);
      next.push_back(std::accumulate(level.begin() + static_cast<std::ptrdiff_t>(first) + 1,
                                     level.begin() + static_cast<std::ptrdiff_t>(last), level[first]));
    }
    level = next;
  }
  EXPECT_EQ((parallel::sum<double, TypeParam>("test.sum", n, Wild{})), level[0]);
}

TYPED_TEST(ParallelTest, MaxFindsTheLargest) {
  const double lowest = -HUGE_VAL;
  for (const std::int64_t n : sizes) {
    double largest = lowest;
    for (std::int64_t i = 0; i < n; ++i) largest = std::max(largest, Wild{}(i));
    EXPECT_EQ((parallel::max<double, TypeParam>("test.max", n, Wild{}, lowest)), largest) << "n = " << n;
  }
}

TYPED_TEST(ParallelTest, MaxOfNegativeValuesIsNotItsStart) {
  Array<std::int64_t, TypeParam> values;
  copy(values, std::vector<std::int64_t>{-5, -3, -9});
  const auto lowest = std::numeric_limits<std::int64_t>::min();
  EXPECT_EQ((parallel::max<std::int64_t, TypeParam>("test.max", 3, Load{values.data()}, lowest)), -3);
}

TYPED_TEST(ParallelTest, MinFindsTheSmallest) {
  for (const std::int64_t n : sizes) {
    double smallest = 3;
    for (std::int64_t i = 0; i < n; ++i) smallest = std::min(smallest, Wild()(i));
    EXPECT_EQ((parallel::min<double, TypeParam>("test.min", n, Wild(), 3)), smallest) << "n = " << n;
  }
}

struct SomeOfSeven {
  SCREE_HD std::int32_t operator()(std::int64_t i) const {
    return i * i % 7 == 4 ? static_cast<std::int32_t>(i) : -1;
  }
};

TYPED_TEST(ParallelTest, SelectKeepsTheOrder) {
  Array<std::int32_t, TypeParam> found;
  for (const std::int64_t n : sizes) {
    std::vector<std::int32_t> expected;
    for (std::int64_t i = 0; i < n; ++i)
      if (SomeOfSeven()(i) >= 0) expected.push_back(static_cast<std::int32_t>(i));
    parallel::select("test.select", n, SomeOfSeven(), -1, found);
    EXPECT_EQ(to_vector(found), expected) << "n = " << n;
  }
}

TYPED_TEST(ParallelTest, ExclusiveScanOffsets) {
  for (const std::int64_t n : sizes) {
    std::vector<std::uint32_t> counts(static_cast<std::size_t>(n));
    for (std::size_t i = 0; i < counts.size(); ++i)
      counts[i] = static_cast<std::uint32_t>(i * 2654435761u % 7);
    Array<std::uint32_t, TypeParam> there;
    copy(there, counts);
    Array<std::int64_t, TypeParam> offsets;
    const std::int64_t total = parallel::exclusive_scan("test.scan", there, offsets);

    std::vector<std::int64_t> expected(counts.size() + 1, 0);
    for (std::size_t i = 0; i < counts.size(); ++i) expected[i + 1] = expected[i] + counts[i];
    EXPECT_EQ(to_vector(offsets), expected) << "n = " << n;
    EXPECT_EQ(total, expected.back());
  }
}

TYPED_TEST(ParallelTest, ExclusiveScanCountsBeyond32Bits) {
  const std::uint32_t large = 4000000000u;
  Array<std::uint32_t, TypeParam> counts;
  copy(counts, std::vector<std::uint32_t>(1000, large));
  Array<std::int64_t, TypeParam> offsets;
  EXPECT_EQ(parallel::exclusive_scan("test.scan", counts, offsets), 1000 * std::int64_t{large});
  EXPECT_EQ(to_vector(offsets)[2], 2 * std::int64_t{large});
}

// Sorts n pairs whose keys have `bits` random bits and whose values hold the initial order.
template <class Space, class Key>
void check_sort(std::int64_t n, int bits) {
  std::vector<Key> keys(static_cast<std::size_t>(n));
  std::vector<std::int32_t> order(keys.size());
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const auto word = philox({static_cast<std::uint32_t>(i), 0, 0, 0}, {3, 5});
    const std::uint64_t random = (std::uint64_t{word[0]} << 32) | word[1];
    keys[i] = static_cast<Key>(random >> (64 - bits));
    order[i] = static_cast<std::int32_t>(i);
  }
  std::vector<std::int32_t> expected = order;
  std::stable_sort(expected.begin(), expected.end(), [&keys](std::int32_t a, std::int32_t b) {
    return keys[static_cast<std::size_t>(a)] < keys[static_cast<std::size_t>(b)];
  });

  Array<Key, Space> keys_there, keys_alone;
  Array<std::int32_t, Space> values;
  copy(keys_there, keys);
  copy(values, order);
  parallel::sort_by_key("test.sort", keys_there, values, bits);
  EXPECT_EQ(to_vector(values), expected) << "n = " << n << ", bits = " << bits;
  copy(keys_alone, keys);
  parallel::sort("test.sort", keys_alone, bits);
  std::sort(keys.begin(), keys.end());
  EXPECT_EQ(to_vector(keys_there), keys) << "n = " << n << ", bits = " << bits;
  EXPECT_EQ(to_vector(keys_alone), keys) << "n = " << n << ", bits = " << bits;
}

TYPED_TEST(ParallelTest, SortIsStable) {
  for (const std::int64_t n : sizes) {
    for (const int bits : {1, 5, 17, 32}) check_sort<TypeParam, std::uint32_t>(n, bits);
    for (const int bits : {1, 33, 64}) check_sort<TypeParam, std::uint64_t>(n, bits);
  }
}

}  // namespace
}  // namespace scree
