// Sets of boxes for the tests of the broad phase, and the PCS by a plain double loop.
#pragma once

#include "broadphase/aabb.hpp"
#include "broadphase/broad_phase.hpp"
#include "core/array.hpp"
#include "core/rng.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <compare>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace scree::test {

using Boxes = std::vector<Aabb>;
using PairSet = std::vector<std::pair<std::int32_t, std::int32_t>>;

inline Aabb box(double x, double y, double z, double hx, double hy, double hz) {
  return {{static_cast<float>(x - hx), static_cast<float>(y - hy), static_cast<float>(z - hz)},
          {static_cast<float>(x + hx), static_cast<float>(y + hy), static_cast<float>(z + hz)}};
}
inline Aabb ball(double x, double y, double z, double r) { return box(x, y, z, r, r, r); }

/// Returns n balls in a cube of the given side around the origin; `radius` is called with each ball's random
/// numbers.
template <class Radius>
Boxes cloud(int n, double side, std::uint64_t seed, Radius radius) {
  Boxes boxes;
  for (int i = 0; i < n; ++i) {
    Random random(seed, static_cast<std::uint64_t>(i));
    const double x = random.uniform(-side / 2, side / 2);
    const double y = random.uniform(-side / 2, side / 2);
    const double z = random.uniform(-side / 2, side / 2);
    boxes.push_back(ball(x, y, z, radius(random)));
  }
  return boxes;
}
inline Boxes equal_cloud(int n, double side, double r, std::uint64_t seed = 1) {
  return cloud(n, side, seed, [r](Random&) { return r; });
}
/// Returns a cloud of balls whose radii are log-uniform from lo to hi.
inline Boxes log_cloud(int n, double side, double lo, double hi, std::uint64_t seed = 2) {
  return cloud(n, side, seed, [lo, hi](Random& random) { return lo * std::pow(hi / lo, random.uniform()); });
}

inline std::vector<Mobility> all_free(const Boxes& boxes) {
  return std::vector<Mobility>(boxes.size(), Mobility::free);
}

/// Returns the pairs by their definition: closed boxes that overlap, neither absent nor both fixed.
inline PairSet by_definition(const Boxes& boxes, const std::vector<Mobility>& mobility) {
  PairSet pairs;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (std::size_t j = i + 1; j < boxes.size(); ++j) {
      bool apart = mobility[i] == Mobility::fixed && mobility[j] == Mobility::fixed;
      for (int a = 0; a < 3 && !apart; ++a) {
        apart = boxes[i].hi[a] < boxes[j].lo[a] || boxes[j].hi[a] < boxes[i].lo[a];
      }
      if (!apart) pairs.emplace_back(i, j);
    }
  }
  return pairs;
}

/// Returns the pairs that a view in a space holds, in their order.
template <class Space>
PairSet set_of(ConstView<Pair> view) {
  std::vector<Pair> pairs(static_cast<std::size_t>(view.size()));
  copy_bytes<Host, Space>(pairs.data(), view.data(), pairs.size() * sizeof(Pair));
  PairSet set;
  for (const Pair& pair : pairs) set.emplace_back(pair.i, pair.j);
  return set;
}

/// Returns the pairs that a broad phase finds, in its order.
template <class Space>
PairSet found(BroadPhase<Space>& broad_phase, const Boxes& boxes, const std::vector<Mobility>& mobility) {
  Array<Aabb, Space> bounds;
  Array<Mobility, Space> mobilities;
  copy(bounds, boxes);
  copy(mobilities, mobility);
  return set_of<Space>(broad_phase.find(bounds.view(), mobilities.view()));
}
template <class Space>
PairSet found(const BroadPhaseSettings& settings, const Boxes& boxes, const std::vector<Mobility>& mobility) {
  return found(*make_broad_phase<Space>(settings), boxes, mobility);
}

inline PairSet sorted(PairSet pairs) {
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

/// Compares sorted sets of pairs. The text is short enough to read: the sizes, and the first pair in which
/// they differ.
inline ::testing::AssertionResult same_pairs(const PairSet& expected, const PairSet& actual) {
  if (expected == actual) return ::testing::AssertionSuccess();
  const auto differ = std::mismatch(expected.begin(), expected.end(), actual.begin(), actual.end());
  auto text = ::testing::AssertionFailure() << actual.size() << " pairs, expected " << expected.size();
  if (differ.first != expected.end()) {
    text << "; expected next (" << differ.first->first << ", " << differ.first->second << ")";
  }
  if (differ.second != actual.end()) {
    text << "; found next (" << differ.second->first << ", " << differ.second->second << ")";
  }
  return text;
}

/// Returns all methods and numbers of levels that have to agree with the definition.
inline std::vector<std::pair<std::string, BroadPhaseSettings>> every_method() {
  std::vector<std::pair<std::string, BroadPhaseSettings>> all = {
      {"brute force", {.method = BroadPhaseMethod::brute_force}},
      {"uniform grid", {.method = BroadPhaseMethod::uniform_grid}},
      {"sweep and prune", {.method = BroadPhaseMethod::sweep_and_prune}},
      {"bounding volume hierarchy", {.method = BroadPhaseMethod::lbvh}}};
  for (int levels = 0; levels <= 8; ++levels) {
    const std::string which = " grid, levels " + std::to_string(levels);
    all.emplace_back("hierarchical" + which,
                     BroadPhaseSettings{.method = BroadPhaseMethod::hierarchical_grid, .levels = levels});
    all.emplace_back("alternative" + which,
                     BroadPhaseSettings{.method = BroadPhaseMethod::alternative_grid, .levels = levels});
  }
  return all;
}

template <class Space>
void expect_definition(const Boxes& boxes, const std::vector<Mobility>& mobility) {
  const PairSet expected = by_definition(boxes, mobility);
  for (const auto& [name, settings] : every_method()) {
    EXPECT_TRUE(same_pairs(expected, sorted(found<Space>(settings, boxes, mobility)))) << name;
  }
}
template <class Space>
void expect_definition(const Boxes& boxes) {
  expect_definition<Space>(boxes, all_free(boxes));
}

}  // namespace scree::test
