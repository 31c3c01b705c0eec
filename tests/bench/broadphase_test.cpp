// Tests of the broad-phase benchmark: the data sets follow the laws that they promise, the orders are
// permutations, and the measurements agree with brute force.
#include "bench/broadphase/data_sets.hpp"
#include "bench/broadphase/input.hpp"
#include "bench/broadphase/measurement.hpp"
#include "broadphase/aabb.hpp"
#include "core/error.hpp"
#include "core/math.hpp"
#include "tests/core/spaces.hpp"
#include "tests/sim/record/temporary_folder.hpp"

#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numeric>
#include <string>
#include <tuple>
#include <vector>

namespace scree::bench {
namespace {

constexpr double pairs_of_a = 12 / pi;  ///< pairs per object in an unbounded set A

std::vector<double> radii_of(const std::vector<Aabb>& boxes) {
  std::vector<double> radii;
  for (const Aabb& box : boxes) radii.push_back(0.5 * extent_of(box));
  return radii;
}

double ball_volume(double r) { return 4 * pi / 3 * r * r * r; }

double volume_of_balls(const std::vector<double>& radii) {
  return std::accumulate(radii.begin(), radii.end(), 0.0,
                         [](double sum, double r) { return sum + ball_volume(r); });
}

/// Returns the side of the cube that the centres fill, too small by about one part in n.
double side_of(const std::vector<Aabb>& boxes) {
  double most = 0;
  for (const Aabb& box : boxes)
    for (int a = 0; a < 3; ++a) most = std::max(most, std::abs(centre_of(box, a)));
  return 2 * most;
}

bool same_bytes(const std::vector<Aabb>& a, const std::vector<Aabb>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Aabb)) == 0;
}

std::string instance(std::string name) {
  const std::size_t r = name.find(":R");
  return r == std::string::npos ? name : name.replace(r, 2, ":1000");
}

BroadPhaseStats stats_of(const std::string& set, std::int64_t n) {
  const Objects<Host> objects = objects_of_data_set(set, n);
  const auto broad_phase = make_broad_phase<Host>({});
  broad_phase->find(objects.bounds.view(), objects.mobility.view());
  return broad_phase->stats();
}

double pairs_per_object(const std::string& set, std::int64_t n) {
  return static_cast<double>(stats_of(set, n).pairs) / static_cast<double>(n);
}

TEST(DataSetsTest, AreTheSameForAnyNumberOfThreads) {
  for (const std::string& name : data_set_names()) {
    const std::vector<Aabb> many = make_data_set(instance(name), 70000);
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    EXPECT_TRUE(same_bytes(many, make_data_set(instance(name), 70000))) << name;
    EXPECT_TRUE(std::ranges::all_of(many, is_proper)) << name;
  }
}

// The committed tables of measurements are of sets with these pairs.
TEST(DataSetsTest, HaveTheirPairs) {
  EXPECT_EQ(stats_of("A", 100000).pairs, 369702);
  EXPECT_EQ(stats_of("B", 100000).pairs, 108677);
  EXPECT_EQ(stats_of("C", 100000).pairs, 56214);
}

TEST(DataSetsTest, FillTheirShareOfTheCube) {
  for (const auto& [name, share] :
       {std::pair("A", 0.5), {"B", 0.3}, {"C", 0.3}, {"log:1000", 0.3}, {"volume:30", 0.3}}) {
    const std::vector<Aabb> boxes = make_data_set(name, 100000);
    EXPECT_NEAR(volume_of_balls(radii_of(boxes)) / std::pow(side_of(boxes), 3), share, 0.003 * share) << name;
  }
}

TEST(DataSetsTest, LogHasAsManyObjectsInEachOctave) {
  std::array<double, 5> counts{};
  for (const double r : radii_of(make_data_set("log:32", 50000)))
    ++counts[static_cast<std::size_t>(std::clamp(-std::log2(r), 0.0, 4.999))];
  for (const double count : counts) EXPECT_NEAR(count, 10000, 400);  // 4.5 standard deviations
}

TEST(DataSetsTest, VolumeHasAsMuchVolumeInEachOctave) {
  std::array<double, 4> volumes{};
  const std::vector<double> radii = radii_of(make_data_set("volume:16", 400000));
  EXPECT_GE(*std::ranges::min_element(radii), 0.9999 / 16);
  EXPECT_LE(*std::ranges::max_element(radii), 1.0001);
  for (const double r : radii)
    volumes[static_cast<std::size_t>(std::clamp(-std::log2(r), 0.0, 3.999))] += ball_volume(r);
  const double all = volume_of_balls(radii);
  for (const double volume : volumes) EXPECT_NEAR(volume / all, 0.25, 0.02);
}

// Objects at the border of the cube lack neighbours, which costs 3 % of the pairs at this number.
TEST(DataSetsTest, HaveThePairsOfA) {
  for (const char* name : {"A", "plummer", "boxes", "line", "clusters"})
    EXPECT_NEAR(pairs_per_object(name, 100000), pairs_of_a, 0.06 * pairs_of_a) << name;
}

TEST(DataSetsTest, BoxesAreWithinTheirAspect) {
  for (const Aabb& box : make_data_set("boxes", 1000)) {
    for (int a = 0; a < 3; ++a) {
      const double extent = static_cast<double>(box.hi[a]) - static_cast<double>(box.lo[a]);
      EXPECT_GT(extent, 0.0999);
      EXPECT_LT(extent, std::sqrt(3.0));
    }
  }
}

TEST(DataSetsTest, OneMeetsAll) {
  const std::vector<Aabb> a = make_data_set("A", 20000);
  const auto met_in_a =
      std::count_if(a.begin() + 1, a.end(), [&](const Aabb& box) { return overlap(a[0], box); });
  EXPECT_EQ(stats_of("giant", 20000).pairs, stats_of("A", 20000).pairs - met_in_a + 19999);
  EXPECT_EQ(stats_of("point", 1000).pairs, 1000 * 999 / 2);
  const double of_slab = pairs_per_object("slab", 20000) - pairs_per_object("A", 20000);
  EXPECT_NEAR(of_slab, 1.5 / 27.6, 0.01) << "those whose centres are within 1.5 of the bottom";
}

TEST(DataSetsTest, UnknownOnesAreRefused) {
  for (const char* name :
       {"D", "", "log", "log:", "log:R", "log:0.5", "log:x", "log:nan", "log:inf", "A:2", ":2"})
    EXPECT_THROW(make_data_set(name, 10), InputError) << name;
  EXPECT_THROW(make_data_set("A", 0), InputError);
  EXPECT_THROW(make_data_set("A", std::int64_t{1} << 31), InputError);
}

TEST(PermutationTest, MovesEveryItemToItsOwnPlace) {
  for (const std::int64_t n : {1, 2, 3, 4, 5, 15, 16, 17, 1000, 4096, 70000}) {
    std::vector<int> hits(static_cast<std::size_t>(n));
    const Permutation permutation(n, 5);
    for (std::int64_t i = 0; i < n; ++i) ++hits[static_cast<std::size_t>(permutation(i))];
    EXPECT_TRUE(std::ranges::all_of(hits, [](int count) { return count == 1; })) << n;
  }
}

TEST(PermutationTest, IsAnotherOneForEachSeed) {
  std::array<int, 10> first{}, step{};
  for (std::uint64_t seed = 0; seed < 5000; ++seed) {
    const Permutation permutation(1000, seed);
    ++first[static_cast<std::size_t>(permutation(0) / 100)];
    ++step[static_cast<std::size_t>((permutation(501) - permutation(500) + 1000) % 1000 / 100)];
  }
  for (const int count : first) EXPECT_NEAR(count, 500, 100);
  for (const int count : step) EXPECT_NEAR(count, 500, 100);
}

template <class Space>
class BroadPhaseBenchTest : public test::InSpace<Space> {
 protected:
  static Objects<Space> objects(const std::string& set, std::int64_t n) {
    const Objects<Host> made = objects_of_data_set(set, n);
    Objects<Space> objects;
    copy(objects.bounds, made.bounds);
    copy(objects.mobility, made.mobility);
    return objects;
  }
};
TYPED_TEST_SUITE(BroadPhaseBenchTest, test::Spaces, test::SpaceName);

TYPED_TEST(BroadPhaseBenchTest, RowsAreInOrderAndComplete) {
  using Place = std::tuple<double, double, double>;
  Objects<TypeParam> given = this->objects("A", 3000);
  std::vector<Aabb> boxes = to_vector(given.bounds);
  std::vector<Mobility> mobility = to_vector(given.mobility);
  boxes[7] = absent_bounds();
  mobility[11] = Mobility::fixed;
  copy(given.bounds, boxes);
  copy(given.mobility, mobility);
  Objects<TypeParam> rows;
  sort_into_rows(given, rows);
  const std::vector<Aabb> sorted = to_vector(rows.bounds);
  EXPECT_TRUE(is_absent(sorted.back()));
  std::array<double, 3> lowest;
  lowest.fill(HUGE_VAL);
  double extents = 0;
  for (std::size_t k = 0; k + 1 < sorted.size(); ++k) {
    for (int a = 0; a < 3; ++a)
      lowest[static_cast<std::size_t>(a)] =
          std::min(lowest[static_cast<std::size_t>(a)], centre_of(sorted[k], a));
    extents += extent_of(sorted[k]);
  }
  const double width = extents / static_cast<double>(sorted.size() - 1);
  std::vector<Place> places;
  const auto cell = [&](const Aabb& box, std::size_t a) {
    return std::floor((centre_of(box, static_cast<int>(a)) - lowest[a]) / width);
  };
  for (std::size_t k = 0; k + 1 < sorted.size(); ++k)
    places.emplace_back(cell(sorted[k], 2), cell(sorted[k], 1), cell(sorted[k], 0));
  EXPECT_TRUE(std::ranges::is_sorted(places));
  const auto bytes = [](const Aabb& a, const Aabb& b) { return std::memcmp(&a, &b, sizeof(Aabb)) < 0; };
  const std::vector<Mobility> moved = to_vector(rows.mobility);
  const auto fixed = std::ranges::find(moved, Mobility::fixed) - moved.begin();
  EXPECT_EQ(std::memcmp(&sorted[static_cast<std::size_t>(fixed)], &boxes[11], sizeof(Aabb)), 0);
  std::vector<Aabb> all = sorted;
  std::ranges::sort(all, bytes);
  std::ranges::sort(boxes, bytes);
  EXPECT_TRUE(same_bytes(all, boxes));
}

TYPED_TEST(BroadPhaseBenchTest, ChecksumDependsOnThePairsAlone) {
  const Objects<TypeParam> b = this->objects("B", 2000);
  const BroadPhaseSettings brute = {.method = BroadPhaseMethod::brute_force};
  const Measurement expected = measure<TypeParam>(b, {brute}, {.order = Order::given, .repeats = 1}).front();
  for (const Order order : {Order::random, Order::rows, Order::given}) {
    const auto results = measure<TypeParam>(b, {{.levels = 0}, {.levels = 1}, {.levels = 3}, brute},
                                            {.order = order, .repeats = 2});
    for (const Measurement& actual : results) {
      EXPECT_EQ(actual.checksum, expected.checksum);
      EXPECT_EQ(actual.stats.pairs, expected.stats.pairs);
    }
  }
  const Objects<TypeParam> others = this->objects("log:101", 2000);
  EXPECT_NE(measure<TypeParam>(others, {brute}, {.repeats = 1}).front().checksum, expected.checksum);
  EXPECT_TRUE(agree<TypeParam>(b, {}, brute));
}

TYPED_TEST(BroadPhaseBenchTest, MeasuresTimesCallsAndMemory) {
  const Measurement result =
      measure<TypeParam>(this->objects("A", 100000), {{}}, {.repeats = 3, .profiles = 2}).front();
  EXPECT_EQ(result.problem, "");
  ASSERT_EQ(result.times.size(), 3u);
  EXPECT_TRUE(std::ranges::is_sorted(result.times));
  EXPECT_GT(result.times.front(), 0);
  for (const char* stage : {"initialize", "sort", "traverse"}) {
    const std::string label = std::string("broadphase.") + stage;
    const auto is_of_stage = [&](const timing::Entry& call) { return call.label.starts_with(label); };
    EXPECT_TRUE(std::ranges::any_of(result.calls, is_of_stage)) << stage;
  }
  EXPECT_GT(result.memory, 100000.0 * sizeof(std::int32_t)) << "at least an order of the objects";
  EXPECT_GT(copy_bandwidth<TypeParam>(1 << 24), 1e8);
}

TYPED_TEST(BroadPhaseBenchTest, SaysWhatFailed) {
  Objects<TypeParam> objects = this->objects("A", 10);
  std::vector<Aabb> boxes = to_vector(objects.bounds);
  boxes[3].lo[0] = std::nanf("");
  copy(objects.bounds, boxes);
  const std::vector<Measurement> results = measure<TypeParam>(objects, {{}, {.levels = 1}}, {});
  ASSERT_EQ(results.size(), 2u);
  for (const Measurement& result : results) {
    EXPECT_NE(result.problem.find("the bounds of body"), std::string::npos);
    EXPECT_TRUE(result.problem.ends_with("; its position, speed or size is too large")) << result.problem;
  }
}

TEST(BenchInputTest, ScenesGiveTheBoxesOfTheirFirstStep) {
  const TemporaryFolder folder;
  write_text(folder / "fall.yaml", R"(format: 1
gravity: [0, 0, -10]
time: {end: 1, step: 0.01}
materials: {stone: {density: 1000}}
bodies:
  - {plane: {normal: [0, 0, 1]}, material: stone}
  - {sphere: {radius: 0.5}, at: [0, 0, 10], velocity: [20, 0, 0], material: stone}
  - {box: {size: [1, 1, 1]}, at: [0, 0, 5], fixed: true, material: stone}
)");
  EXPECT_TRUE(names_scene("fall.yaml"));
  EXPECT_FALSE(names_scene("A"));
  const Objects<Host> objects = objects_of_scene((folder / "fall.yaml").string());
  ASSERT_EQ(objects.bounds.size(), 3);
  EXPECT_TRUE(is_absent(objects.bounds.data()[0]));
  const Aabb& ball = objects.bounds.data()[1];
  EXPECT_GT(static_cast<double>(ball.hi[0]) - static_cast<double>(ball.lo[0]), 1 + 2 * 0.2)
      << "the travel of a step, both ways";
  EXPECT_EQ(objects.mobility.data()[1], Mobility::free);
  EXPECT_EQ(objects.mobility.data()[2], Mobility::fixed);
}

}  // namespace
}  // namespace scree::bench
