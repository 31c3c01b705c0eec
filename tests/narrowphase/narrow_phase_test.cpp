// The narrow phase as a whole against a double loop over all pairs.
#include "narrowphase/narrow_phase.hpp"

#include "core/rng.hpp"
#include "narrowphase/box_box.hpp"
#include "narrowphase/box_plane.hpp"
#include "narrowphase/sphere_box.hpp"
#include "narrowphase/sphere_plane.hpp"
#include "narrowphase/sphere_sphere.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cstring>

namespace scree {
namespace {

struct Scene {
  Bodies<Host> bodies;
  Array<double, Host> margin;
};

void add(BodyTable& table, Shape shape, Mobility mobility, const Vec3& at, const Quat& turn,
         const Vec3& size) {
  table.position.push_back(at);
  table.orientation.push_back(turn);
  table.velocity.push_back(Vec3::Zero());
  table.spin.push_back(Vec3::Zero());
  table.size.push_back(size);
  table.inverse_mass.push_back(mobility == Mobility::free ? 1 : 0);
  table.inverse_inertia.push_back(Vec3::Zero());
  table.shape.push_back(shape);
  table.mobility.push_back(mobility);
  table.material.push_back(0);
  table.id.push_back(static_cast<std::int32_t>(table.id.size()));
}

/// Spheres and boxes of three mobilities in a crowd, with planes at both ends and in the middle of the
/// numbers.
Scene crowd(int count) {
  BodyTable table;
  const double extent = std::cbrt(static_cast<double>(count));
  const auto add_plane = [&table](const Vec3& turn) {
    add(table, Shape::plane, Mobility::fixed, Vec3::Zero(), rotation_of(turn), Vec3::Zero());
  };
  add_plane(Vec3::Zero());
  for (int n = 0; n < count; ++n) {
    Random random(9, static_cast<std::uint64_t>(n));
    const auto uniform = [&random](double low, double high) {
      const double x = random.uniform(low, high), y = random.uniform(low, high);
      return Vec3(x, y, random.uniform(low, high));
    };
    const Mobility mobility = n % 5 == 1    ? Mobility::fixed
                              : n % 11 == 2 ? Mobility::prescribed
                                            : Mobility::free;
    if (n == count / 2) add_plane(Vec3(0, pi / 2, 0));
    const Vec3 at = uniform(0, extent), size = uniform(0.2, 0.6);
    add(table, n % 2 ? Shape::box : Shape::sphere, mobility, at, rotation_of(uniform(-2, 2)), size);
  }
  add_plane(Vec3(-pi / 2, 0, 0));

  Scene scene;
  copy_bodies(scene.bodies, table);
  scene.margin.resize(table.count());
  for (std::int64_t i = 0; i < table.count(); ++i) scene.margin.view()[i] = 0.01 * static_cast<double>(i % 4);
  return scene;
}

/// Every pair i < j, in an order that is not sorted.
std::vector<Pair> all_pairs(std::int64_t count) {
  std::vector<Pair> pairs;
  for (std::int64_t d = count - 1; d > 0; --d) {
    for (std::int64_t i = 0; i + d < count; ++i) {
      pairs.push_back({static_cast<std::int32_t>(i), static_cast<std::int32_t>(i + d)});
    }
  }
  return pairs;
}

/// The contact of two bodies, by cases.
bool contact(const ConstBodyView& b, std::int64_t i, std::int64_t j, double margin, Manifold& m) {
  const auto solid = [&b](std::int64_t k) { return Solid{b.position[k], b.orientation[k], b.size[k]}; };
  if (b.mobility[i] != Mobility::free && b.mobility[j] != Mobility::free) return false;
  if (b.shape[i] > b.shape[j]) {
    const bool found = contact(b, j, i, margin, m);
    m.normal = -m.normal;
    return found;
  }
  if (b.shape[i] == Shape::sphere && b.shape[j] == Shape::sphere)
    return sphere_sphere(solid(i), solid(j), margin, m);
  if (b.shape[i] == Shape::sphere && b.shape[j] == Shape::box)
    return sphere_box(solid(i), solid(j), margin, m);
  if (b.shape[i] == Shape::sphere) return sphere_plane(solid(i), solid(j), margin, m);
  if (b.shape[j] == Shape::box) return box_box(solid(i), solid(j), margin, m);
  return box_plane(solid(i), solid(j), margin, m);
}

void expect_same(const Manifold& a, const Manifold& b) {
  ASSERT_EQ(a.i, b.i);
  ASSERT_EQ(a.j, b.j);
  ASSERT_EQ(a.normal, b.normal);
  ASSERT_EQ(a.count, b.count);
  for (int k = 0; k < a.count; ++k) {
    ASSERT_EQ(a.points[k].position, b.points[k].position);
    ASSERT_EQ(a.points[k].gap, b.points[k].gap);
    ASSERT_EQ(a.points[k].feature, b.points[k].feature);
  }
}

TEST(NarrowPhase, FindsWhatADoubleLoopFindsInOrder) {
  const Scene scene = crowd(300);
  const ConstBodyView bodies = view_of(scene.bodies);
  const std::vector<Pair> pairs = all_pairs(bodies.count());
  NarrowPhase narrow({});
  const auto found =
      narrow.find(bodies, {pairs.data(), static_cast<std::int64_t>(pairs.size())}, scene.margin.view());

  std::int64_t next = 0;
  for (std::int64_t i = 0; i < bodies.count(); ++i) {
    for (std::int64_t j = i + 1; j < bodies.count(); ++j) {
      Manifold m;
      if (!contact(bodies, i, j, scene.margin.view()[i] + scene.margin.view()[j], m)) continue;
      m.i = static_cast<std::int32_t>(i);
      m.j = static_cast<std::int32_t>(j);
      ASSERT_LT(next, found.size());
      expect_same(found[next++], m);
    }
  }
  EXPECT_EQ(next, found.size());
  EXPECT_GT(next, 300);
  EXPECT_GE(narrow.stats().tested, next);
}

TEST(NarrowPhase, ThreadsDoNotChangeTheResult) {
  const Scene scene = crowd(1500);
  const std::vector<Pair> pairs = all_pairs(scene.bodies.count());
  const ConstView<Pair> pair_view(pairs.data(), static_cast<std::int64_t>(pairs.size()));
  std::vector<Manifold> first;
  for (const int threads : {1, 2, 7}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(threads));
    NarrowPhase narrow({});
    for (int again = 0; again < 2; ++again) {  // with and without growing buffers
      const auto found = narrow.find(view_of(scene.bodies), pair_view, scene.margin.view());
      if (first.empty()) first.assign(found.begin(), found.end());
      ASSERT_EQ(found.size(), static_cast<std::int64_t>(first.size()));
      for (std::int64_t k = 0; k < found.size(); ++k)
        expect_same(found[k], first[static_cast<std::size_t>(k)]);
    }
  }
}

TEST(NarrowPhase, EveryMethodFindsTheSamePairs) {
  const Scene scene = crowd(300);
  const std::vector<Pair> pairs = all_pairs(scene.bodies.count());
  const ConstView<Pair> pair_view(pairs.data(), static_cast<std::int64_t>(pairs.size()));
  NarrowPhase sat({BoxBoxMethod::sat});
  const auto expected = sat.find(view_of(scene.bodies), pair_view, scene.margin.view());
  EXPECT_EQ(sat.stats().ccd_calls, 0);
  for (const BoxBoxMethod method : {BoxBoxMethod::automatic, BoxBoxMethod::ccd_gjk, BoxBoxMethod::ccd_mpr}) {
    NarrowPhase narrow({method});
    const auto found = narrow.find(view_of(scene.bodies), pair_view, scene.margin.view());
    ASSERT_EQ(found.size(), expected.size());
    for (std::int64_t k = 0; k < found.size(); ++k) {
      ASSERT_EQ(found[k].i, expected[k].i);
      ASSERT_EQ(found[k].j, expected[k].j);
    }
    EXPECT_EQ(narrow.stats().ccd_calls > 0, method != BoxBoxMethod::automatic);
    EXPECT_LE(narrow.stats().ccd_rejected, narrow.stats().ccd_calls);
  }
}

TEST(NarrowPhase, NothingInNothingOut) {
  Scene scene;
  NarrowPhase narrow({});
  EXPECT_EQ(narrow.find(view_of(std::as_const(scene.bodies)), {}, scene.margin.view()).size(), 0);
}

}  // namespace
}  // namespace scree
