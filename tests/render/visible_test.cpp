#include "render/gl/visible.hpp"

#include "core/rng.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace scree::render::gl {
namespace {

constexpr int width = 160, height = 120;

// Returns random discs over a region larger than the picture. As for spheres, their near and far sides
// differ.
std::vector<Disc> crowd(std::uint64_t seed, int count, double least, double most) {
  std::vector<Disc> discs;
  for (int k = 0; k < count; ++k) {
    Random random(seed, static_cast<std::uint64_t>(k));
    Disc disc{.body = k};
    disc.x = static_cast<float>(random.uniform(-30, width + 30));
    disc.y = static_cast<float>(random.uniform(-30, height + 30));
    disc.inner = static_cast<float>(random.uniform(least, most));
    disc.outer = disc.inner * static_cast<float>(random.uniform(1, 1.7));
    disc.far = static_cast<float>(random.uniform(10, 20));
    disc.near = disc.far - 0.02f * disc.outer;
    discs.push_back(disc);
  }
  return discs;
}

bool holds(const Disc& disc, float radius, double x, double y) {
  return std::hypot(x - disc.x, y - disc.y) < radius;
}

// Returns whether a disc may show at a point of the picture: it holds the point, and no disc in front of its
// nearest side covers the point for certain.
bool may_show_at(const std::vector<Disc>& discs, const Disc& disc, double x, double y) {
  if (!holds(disc, disc.outer, x, y)) return false;
  return std::none_of(discs.begin(), discs.end(), [&](const Disc& other) {
    return other.far < disc.near && holds(other, other.inner, x, y);
  });
}

TEST(VisibleDiscs, NoneIsMissing) {
  for (const auto& [count, least, most] : {std::tuple(400, 4.0, 12.0), std::tuple(3000, 1.0, 4.0),
                                           std::tuple(60, 20.0, 90.0), std::tuple(2000, 0.1, 30.0)}) {
    const std::vector<Disc> discs = crowd(7, count, least, most);
    const std::vector<std::int32_t> found = visible_discs(discs, width, height);
    EXPECT_TRUE(std::is_sorted(found.begin(), found.end()));
    for (double y = 0.5; y < height; y += 3) {
      for (double x = 0.5; x < width; x += 3) {
        for (const Disc& disc : discs) {
          if (!may_show_at(discs, disc, x, y)) continue;
          ASSERT_TRUE(std::binary_search(found.begin(), found.end(), disc.body)) << disc.body;
        }
      }
    }
  }
}

TEST(VisibleDiscs, MostOfAHeapAreLeftOut) {
  const std::vector<Disc> discs = crowd(3, 20000, 4, 6);
  EXPECT_LT(visible_discs(discs, width, height).size(), 3000u);
}

TEST(VisibleDiscs, WhatIsOutsideThePictureIsLeftOut) {
  EXPECT_TRUE(visible_discs({}, width, height).empty());
  Disc disc{.x = -20, .y = 50, .outer = 10, .inner = 10, .near = 1, .far = 2, .body = 5};
  EXPECT_TRUE(visible_discs({disc}, width, height).empty());
  disc.outer = 25;
  EXPECT_EQ(visible_discs({disc}, width, height), std::vector<std::int32_t>{5});
}

TEST(VisibleDiscs, OneFarOffDoesNotSpoilTheOrder) {
  std::vector<Disc> discs = crowd(3, 20000, 4, 6);
  discs.push_back(
      {.x = 80, .y = 60, .outer = 1e-3f, .inner = 1e-3f, .near = 1e9f, .far = 1e9f, .body = 20000});
  EXPECT_LT(visible_discs(discs, width, height).size(), 3000u);
}

}  // namespace
}  // namespace scree::render::gl
