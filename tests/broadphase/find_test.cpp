// Tests that every method, at every number of levels and in every space, finds the pairs of the definition:
// for sizes, places and shapes at which broad phases are known to fail.
#include "broadphase/bounds.hpp"
#include "core/error.hpp"
#include "tests/broadphase/boxes.hpp"
#include "tests/core/spaces.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace scree {
namespace {

using namespace test;

template <class Space>
class Find : public test::InSpace<Space> {};
TYPED_TEST_SUITE(Find, test::Spaces, test::SpaceName);

// --- Output sizes

TYPED_TEST(Find, FewBodies) {
  for (const int n : {0, 1, 2, 3, 31, 32, 33}) {
    expect_definition<TypeParam>(equal_cloud(n, 4, 0.5));
    expect_definition<TypeParam>(equal_cloud(n, 1, 0.6));
    expect_definition<TypeParam>(equal_cloud(n, 1000, 0.5));
  }
}

TYPED_TEST(Find, OneBroadPhaseServesManyInputs) {
  const auto broad_phase = make_broad_phase<TypeParam>({});
  for (const int n : {1000, 0, 10, 2000, 1, 500}) {
    const Boxes boxes = log_cloud(n, 10, 0.01, 1, static_cast<std::uint64_t>(n));
    const PairSet expected = by_definition(boxes, all_free(boxes));
    EXPECT_TRUE(same_pairs(expected, sorted(found(*broad_phase, boxes, all_free(boxes)))));
    EXPECT_EQ(broad_phase->stats().pairs, static_cast<std::int64_t>(expected.size()));
    EXPECT_GE(broad_phase->stats().candidates, broad_phase->stats().pairs);
  }
}

TYPED_TEST(Find, AllInOneCell) { expect_definition<TypeParam>(equal_cloud(2000, 0.5, 0.5)); }

TYPED_TEST(Find, AllAtOnePoint) { expect_definition<TypeParam>(Boxes(700, ball(3, -2, 1, 0.5))); }

// --- Sizes

TYPED_TEST(Find, EqualSizes) { expect_definition<TypeParam>(equal_cloud(3000, 14.6, 0.5)); }

TYPED_TEST(Find, ThreeDecadesLogUniform) { expect_definition<TypeParam>(log_cloud(3000, 20, 0.003, 3)); }

TYPED_TEST(Find, ThreeDecadesInverseCube) {
  expect_definition<TypeParam>(cloud(3000, 2, 3, [](Random& random) {
    const double u = random.uniform();
    return 0.003 / std::sqrt(1 - u * (1 - 1e-6));  // the density is r^-3 from 0.003 to 3
  }));
}

TYPED_TEST(Find, TwelveDecades) { expect_definition<TypeParam>(log_cloud(1500, 1, 1e-12, 1)); }

TYPED_TEST(Find, GiantsAmongMany) {
  for (const double giant : {1e3, 1e6}) {
    for (const int giants : {1, 20}) {
      Boxes boxes = equal_cloud(2000, 13, 0.5);
      for (int k = 0; k < giants; ++k) boxes.push_back(ball(giant + 5 + 0.01 * k, 0, 0, giant));
      std::swap(boxes.front(), boxes.back());
      expect_definition<TypeParam>(boxes);
    }
  }
}

// Each of the large bodies touches some of the small ones. The search from the large bodies down goes row by
// row through the table of the small ones, which is dense, dense with wider cells, or hashed.
TYPED_TEST(Find, FiftyToOne) {
  for (const double side : {25.0, 40.0, 4000.0}) {
    Boxes boxes = equal_cloud(4000, side, 0.5);
    for (const Aabb& large : equal_cloud(12, side, 25, 9)) boxes.push_back(large);
    expect_definition<TypeParam>(boxes);
  }
}

TYPED_TEST(Find, FloorUnderAll) {
  Boxes boxes = equal_cloud(2000, 20, 0.5);
  boxes.push_back(box(0, 0, -10.5, 500, 500, 1));
  expect_definition<TypeParam>(boxes);
}

TYPED_TEST(Find, Points) {
  expect_definition<TypeParam>(equal_cloud(500, 10, 0));
  Boxes mixed = equal_cloud(500, 3, 0);
  for (const Aabb& large : equal_cloud(500, 3, 0.2, 4)) mixed.push_back(large);
  for (int k = 0; k < 50; ++k) mixed.push_back(mixed[static_cast<std::size_t>(k)]);
  expect_definition<TypeParam>(mixed);
  expect_definition<TypeParam>(Boxes(40, ball(0, 0, 0, 0)));
}

TYPED_TEST(Find, SizesAtPowersOfTwo) {
  Boxes boxes;
  for (int k = 0; k < 1500; ++k) {
    Random random(12, static_cast<std::uint64_t>(k));
    const auto size = static_cast<float>(std::ldexp(1.0, k % 4));
    const float side[] = {std::nextafter(size, 0.0f), size, std::nextafter(size, 100.0f)};
    Aabb one;
    for (int a = 0; a < 3; ++a) {
      one.lo[a] = static_cast<float>(std::floor(random.uniform(-20, 20)));
      one.hi[a] = one.lo[a] + side[k % 3];
    }
    boxes.push_back(one);
  }
  expect_definition<TypeParam>(boxes);
}

// --- Places

TYPED_TEST(Find, LatticeWithSpacingOfTheCell) {
  for (const float spacing : {1.0f, 0.1f, 1.0f / 3}) {
    Boxes boxes;
    for (int k = 0; k < 11 * 12 * 13; ++k) {
      const int at[] = {k % 11 - 5, k / 11 % 12 - 6, k / 132 - 6};
      Aabb one;
      for (int a = 0; a < 3; ++a) {
        one.lo[a] = static_cast<float>(at[a]) * spacing;
        one.hi[a] = static_cast<float>(at[a] + 1) * spacing;
      }
      boxes.push_back(one);
    }
    expect_definition<TypeParam>(boxes);
  }
}

TYPED_TEST(Find, TwoFarClusters) {
  Boxes boxes = equal_cloud(1000, 8, 0.5, 1);
  for (Aabb one : equal_cloud(1000, 8, 0.5, 2)) {
    for (int a = 0; a < 3; ++a) {
      one.lo[a] += 65536;
      one.hi[a] += 65536;
    }
    boxes.push_back(one);
  }
  expect_definition<TypeParam>(boxes);
}

// A Plummer sphere is dense in the middle and has far outliers.
TYPED_TEST(Find, PlummerCluster) {
  Boxes boxes;
  for (int k = 0; k < 2500; ++k) {
    Random random(13, static_cast<std::uint64_t>(k));
    const double r = 1 / std::sqrt(std::pow(random.uniform(1e-6, 1), -2.0 / 3) - 1 + 1e-9);
    const double z = random.uniform(-1, 1);
    const double angle = random.uniform(0, 6.28);
    const double across = std::sqrt(1 - z * z);
    boxes.push_back(ball(r * across * std::cos(angle), r * across * std::sin(angle), r * z, 0.03));
  }
  expect_definition<TypeParam>(boxes);
}

TYPED_TEST(Find, LinesAndPlanes) {
  Boxes line, diagonal, plane;
  for (int k = 0; k < 2000; ++k) {
    Random random(14, static_cast<std::uint64_t>(k));
    const double t = random.uniform(-800, 800);
    line.push_back(ball(0, t, 0, 0.5));
    diagonal.push_back(ball(t, t, t, 0.5));
    plane.push_back(ball(random.uniform(-20, 20), 7, random.uniform(-20, 20), 0.5));
  }
  expect_definition<TypeParam>(line);
  expect_definition<TypeParam>(diagonal);
  expect_definition<TypeParam>(plane);
}

TYPED_TEST(Find, FarFromTheOrigin) {
  for (const double offset : {-1e6, 1e6, -1e9, 1e9}) {
    Boxes boxes;
    for (int k = 0; k < 1500; ++k) {
      Random random(15, static_cast<std::uint64_t>(k));
      // The bounds are rounded outward to float: at 1e9 the neighbouring floats are 64 m away.
      Aabb one;
      for (int a = 0; a < 3; ++a) {
        const double x = offset + random.uniform(-600, 600);
        one.lo[a] = round_down(x - 1);
        one.hi[a] = round_up(x + 1);
      }
      boxes.push_back(one);
    }
    expect_definition<TypeParam>(boxes);
  }
}

TYPED_TEST(Find, OneOutlier) {
  for (const float far : {1e9f, -1e30f, FLT_MAX}) {
    Boxes boxes = equal_cloud(2000, 13, 0.5);
    boxes[77] = {{far, -far, 0}, {far, -far, 0}};
    boxes.push_back({{far, -far, 0}, {far, -far, 1}});
    expect_definition<TypeParam>(boxes);
    boxes[78] = {{next_below(far), -far, -1}, {next_above(far) < INFINITY ? next_above(far) : far, -far, 1}};
    expect_definition<TypeParam>(boxes);
  }
}

TYPED_TEST(Find, TheWholeRangeOfFloats) {
  Boxes boxes = equal_cloud(300, 5, 0.5);
  boxes.push_back({{-FLT_MAX, -FLT_MAX, -FLT_MAX}, {FLT_MAX, FLT_MAX, FLT_MAX}});
  boxes.push_back({{FLT_MAX, FLT_MAX, FLT_MAX}, {FLT_MAX, FLT_MAX, FLT_MAX}});
  boxes.push_back({{-FLT_MAX, -1, -1}, {FLT_MAX, 1, 1}});
  expect_definition<TypeParam>(boxes);
}

TYPED_TEST(Find, NegativeZero) {
  expect_definition<TypeParam>({{{-0.0f, -0.0f, -0.0f}, {1, 1, 1}},
                                {{-1, -1, -1}, {0, 0, 0}},
                                {{-1, -1, -1}, {-0.0f, -0.0f, -0.0f}},
                                {{0, 0, 0}, {1, 1, 1}},
                                {{-0.0f, 0, -0.0f}, {0, -0.0f, 0}}});
}

// --- Shapes

TYPED_TEST(Find, RodsAndPlates) {
  const auto thin = [](int axis, bool plate) {
    Boxes boxes;
    for (int k = 0; k < 1200; ++k) {
      Random random(16, static_cast<std::uint64_t>(k));
      double extent[3];
      for (int a = 0; a < 3; ++a) extent[a] = ((k + axis) % 3 == a) == plate ? 0.005 : 5;
      boxes.push_back(box(random.uniform(-20, 20), random.uniform(-20, 20), random.uniform(-20, 20),
                          extent[0], extent[1], extent[2]));
    }
    return boxes;
  };
  expect_definition<TypeParam>(thin(0, false));
  expect_definition<TypeParam>(thin(1, true));
}

TYPED_TEST(Find, NestedBoxes) {
  Boxes boxes;
  for (int k = 0; k < 400; ++k)
    boxes.push_back(box(0.1, 0.2, 0.3, std::pow(1.03, k), std::pow(1.02, k), 1 + k));
  expect_definition<TypeParam>(boxes);
}

TYPED_TEST(Find, ZeroThickness) {
  Boxes boxes;
  for (int k = 0; k < 900; ++k) {
    Random random(17, static_cast<std::uint64_t>(k));
    Aabb one;
    for (int a = 0; a < 3; ++a) {
      one.lo[a] = static_cast<float>(std::floor(random.uniform(-6, 6)));
      one.hi[a] = one.lo[a] + (k % 3 == a ? 0.0f : 1.0f);
    }
    boxes.push_back(one);
  }
  expect_definition<TypeParam>(boxes);
}

// The boxes of a pair meet in exactly one plane, or miss one another by one float, at cell borders of every
// kind: a grid in float arithmetic gets such pairs wrong.
TYPED_TEST(Find, TouchingWithinOneFloat) {
  Boxes boxes;
  for (int k = 0; k < 1000; ++k) {
    Random random(18, static_cast<std::uint64_t>(k));
    const auto size = static_cast<float>(random.uniform(0.9, 1.0));
    const auto x = static_cast<float>(random.uniform(-1000, 1000));
    const float y = static_cast<float>(k % 50) * 3;
    const float z = static_cast<float>(k / 50) * 3;
    const float touch = k % 2 == 0 ? x + size : next_above(x + size);
    boxes.push_back({{x, y, z}, {x + size, y + 1, z + 1}});
    boxes.push_back({{touch, y + 1, z}, {touch + size, y + 2, z + 1}});
  }
  expect_definition<TypeParam>(boxes);
}

// --- Which bodies take part

TYPED_TEST(Find, FixedBodiesDoNotMeetEachOther) {
  const Boxes boxes = log_cloud(1500, 8, 0.02, 2);
  std::vector<Mobility> mobility;
  for (int k = 0; k < 1500; ++k) {
    mobility.push_back(k % 3 == 0 ? Mobility::free : k % 3 == 1 ? Mobility::fixed : Mobility::prescribed);
  }
  expect_definition<TypeParam>(boxes, mobility);
  expect_definition<TypeParam>(boxes, std::vector<Mobility>(boxes.size(), Mobility::fixed));
}

TYPED_TEST(Find, AbsentBodiesAreLeftOut) {
  Boxes boxes = equal_cloud(1000, 9, 0.5);
  for (std::size_t k = 0; k < boxes.size(); k += 7) boxes[k] = absent_bounds();
  boxes.back() = {{-FLT_MAX, -FLT_MAX, -FLT_MAX}, {FLT_MAX, FLT_MAX, FLT_MAX}};
  expect_definition<TypeParam>(boxes);
  expect_definition<TypeParam>(Boxes(50, absent_bounds()));
}

TYPED_TEST(Find, BadBoundsNameTheBody) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  const Aabb bad[] = {
      {{NAN, 0, 0}, {1, 1, 1}},       {{0, 0, 0}, {1, NAN, 1}},
      {{0, -infinity, 0}, {1, 1, 1}}, {{0, 0, 0}, {1, 1, infinity}},
      {{0, 0, 2}, {1, 1, 1}},         {{infinity, infinity, infinity}, {-infinity, -infinity, 0}}};
  for (const auto& [name, settings] : every_method()) {
    for (const Aabb& one : bad) {
      Boxes boxes = equal_cloud(1000, 9, 0.5);
      boxes[777] = boxes[421] = one;
      try {
        found<TypeParam>(settings, boxes, all_free(boxes));
        FAIL() << name;
      } catch (const RunError& error) {
        EXPECT_NE(std::string(error.what()).find("body 421 "), std::string::npos) << error.what();
      }
    }
  }
}

}  // namespace
}  // namespace scree
