// Tests of the contacts of pairs of all shapes, against a loop over cases, by the search along axes and by
// libccd.
#include "core/geometry.hpp"
#include "core/parallel_loops.hpp"
#include "core/rng.hpp"
#include "narrowphase/any_contacts.hpp"
#include "narrowphase/box_box.hpp"
#include "narrowphase/box_plane.hpp"
#include "narrowphase/box_tube.hpp"
#include "narrowphase/candidates.hpp"
#include "narrowphase/libccd_contacts.hpp"
#include "narrowphase/sphere_box.hpp"
#include "narrowphase/sphere_plane.hpp"
#include "narrowphase/sphere_sphere.hpp"
#include "narrowphase/sphere_tube.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <tuple>

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
  table.id.push_back(BodyNumber{static_cast<std::int32_t>(table.id.size())});
}

/// Returns a crowd of spheres and boxes of three mobilities, with planes and tubes at both ends and in the
/// middle of the numbers.
Scene crowd(int count) {
  BodyTable table;
  const double extent = std::cbrt(static_cast<double>(count));
  const auto add_plane = [&table](const Vec3& turn) {
    add(table, Shape::plane, Mobility::fixed, Vec3::Zero(), rotation_of(turn), Vec3::Zero());
  };
  const auto add_tube = [&table, extent](const Vec3& turn, double radius, Mobility mobility) {
    add(table, Shape::tube, mobility, Vec3::Constant(0.5 * extent), rotation_of(turn),
        extent * Vec3(radius, radius, 0.4));
  };
  add_plane(Vec3::Zero());
  add_tube(Vec3(1, 2, 3), 0.1, Mobility::fixed);
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
    if (n == count / 2) add_tube(Vec3(0, 1, 0), 0.3, Mobility::prescribed);
    const Vec3 at = uniform(0, extent), size = uniform(0.2, 0.6);
    add(table, n % 2 ? Shape::box : Shape::sphere, mobility, at, rotation_of(uniform(-2, 2)), size);
  }
  add_plane(Vec3(-pi / 2, 0, 0));
  add_tube(Vec3(3, 0, 1), 0.5, Mobility::fixed);

  Scene scene;
  copy_bodies(scene.bodies, table);
  scene.margin.resize(table.count());
  for (std::int64_t i = 0; i < table.count(); ++i) scene.margin.view()[i] = 0.01 * static_cast<double>(i % 4);
  return scene;
}

/// Returns every pair i < j that has a free body, in order.
std::vector<Pair> all_pairs(const Bodies<Host>& bodies) {
  const ConstView<Mobility> mobility = bodies.mobility.view();
  std::vector<Pair> pairs;
  for (std::int32_t i = 0; i < bodies.count(); ++i) {
    for (std::int32_t j = i + 1; j < bodies.count(); ++j) {
      if (mobility[i] == Mobility::free || mobility[j] == Mobility::free) pairs.push_back({i, j});
    }
  }
  return pairs;
}

ConstView<Pair> view_of(const std::vector<Pair>& pairs) {
  return {pairs.data(), static_cast<std::int64_t>(pairs.size())};
}

/// Finds all contacts of some pairs, one pair after the other.
class PairContacts {
 public:
  explicit PairContacts(const NarrowPhaseSettings& settings, ConstView<ShapeData> shapes = {})
      : libccd_(settings), shapes_(shapes) {}

  std::vector<Manifold> find(const ConstBodyView& bodies, ConstView<Pair> pairs, ConstView<double> margin) {
    libccd_.start_search();
    std::vector<Manifold> all;
    for (const auto& [i, j] : pairs) {
      const auto shaped = [&bodies](std::int32_t k) {
        return ShapedSolid{bodies.shape[k], {bodies.position[k], bodies.orientation[k], bodies.size[k]}};
      };
      const auto data = [this](std::int32_t k) { return shapes_.size() > 0 ? &shapes_[k] : nullptr; };
      const Shape a = bodies.shape[i], b = bodies.shape[j];
      const PairShapes shapes{data(i), data(j)};
      const double reach = margin[i] + margin[j];
      Manifold found[max_pair_manifolds];
      const int count = libccd_.decides(a, b)
                            ? libccd_.find(shaped(i), shaped(j), shapes, reach, found)
                            : find_any_contacts(shaped(i), shaped(j), shapes, {.margin = reach}, found);
      if (libccd_.checks(a, b, i, j)) libccd_.check(shaped(i), shaped(j), shapes);
      for (int m = 0; m < count; ++m) {
        found[m].i = i;
        found[m].j = j;
        all.push_back(found[m]);
      }
    }
    stats_ = libccd_.take_stats();
    return all;
  }
  /// Returns the statistics of the last search.
  const NarrowPhaseStats& stats() const { return stats_; }

 private:
  LibccdContacts libccd_;
  ConstView<ShapeData> shapes_;
  NarrowPhaseStats stats_;
};

/// Returns the contacts of two bodies, by cases of their shapes.
std::vector<Manifold> contacts(const ConstBodyView& b, std::int64_t i, std::int64_t j, double margin) {
  const auto solid = [&b](std::int64_t k) { return Solid{b.position[k], b.orientation[k], b.size[k]}; };
  if (b.mobility[i] != Mobility::free && b.mobility[j] != Mobility::free) return {};
  if (b.shape[i] > b.shape[j]) {
    std::vector<Manifold> turned = contacts(b, j, i, margin);
    for (Manifold& m : turned) m.normal = -m.normal;
    return turned;
  }
  std::vector<Manifold> found(max_pair_manifolds);
  int count = 0;
  const auto several = [&](auto test) { count = test(solid(i), solid(j), margin, found.data()); };
  const auto one = [&](auto test) { count = test(solid(i), solid(j), margin, found[0]) ? 1 : 0; };
  const bool ball = b.shape[i] == Shape::sphere;
  if (b.shape[j] == Shape::sphere) one(sphere_sphere);
  if (b.shape[j] == Shape::box) one(ball ? sphere_box : box_box);
  if (b.shape[j] == Shape::plane) one(ball ? sphere_plane : box_plane);
  if (b.shape[j] == Shape::tube) several(ball ? sphere_tube : box_tube);
  found.resize(static_cast<std::size_t>(count));
  return found;
}

void expect_same(const Manifold& a, const Manifold& b) {
  ASSERT_EQ(a.i, b.i);
  ASSERT_EQ(a.j, b.j);
  ASSERT_EQ(a.part, b.part);
  ASSERT_EQ(a.normal, b.normal);
  ASSERT_EQ(a.count, b.count);
  for (int k = 0; k < a.count; ++k) {
    ASSERT_EQ(a.points[k].position, b.points[k].position);
    ASSERT_EQ(a.points[k].gap, b.points[k].gap);
    ASSERT_EQ(a.points[k].feature, b.points[k].feature);
  }
}

TEST(PairContacts, FindsWhatADoubleLoopFindsInOrder) {
  const Scene scene = crowd(300);
  const ConstBodyView bodies = view_of(scene.bodies);
  PairContacts narrow({});
  const auto found = narrow.find(bodies, view_of(all_pairs(scene.bodies)), scene.margin.view());

  std::size_t next = 0;
  for (std::int64_t i = 0; i < bodies.count(); ++i) {
    for (std::int64_t j = i + 1; j < bodies.count(); ++j) {
      const double margin = scene.margin.view()[i] + scene.margin.view()[j];
      for (Manifold& m : contacts(bodies, i, j, margin)) {
        m.i = static_cast<std::int32_t>(i);
        m.j = static_cast<std::int32_t>(j);
        ASSERT_LT(next, found.size());
        expect_same(found[next++], m);
      }
    }
  }
  EXPECT_EQ(next, found.size());
  EXPECT_GT(next, 300);
  const auto in_tubes = std::count_if(found.begin(), found.end(), [](const auto& m) { return m.part > 0; });
  EXPECT_GT(in_tubes, 10);
}

// Each of the first pairs has as many manifolds as a pair can have, and each of the pairs after them has one.
TEST(PairContacts, HoldsPairsFullOfManifolds) {
  Scene scene;
  BodyTable table;
  constexpr int count = 100;
  add(table, Shape::tube, Mobility::fixed, Vec3::Zero(), Quat::Identity(), Vec3(0.1, 0.1, 0.1));
  for (int n = 0; n < count; ++n)
    add(table, Shape::box, Mobility::free, Vec3::Zero(), Quat::Identity(), Vec3::Ones());
  copy_bodies(scene.bodies, table);
  scene.margin.resize(table.count());
  parallel::fill("margin", scene.margin, 0.0);
  std::vector<Pair> pairs;
  for (std::int32_t n = 1; n <= count; ++n) pairs.push_back({0, n});
  for (std::int32_t n = 2; n <= count; ++n) pairs.push_back({1, n});
  PairContacts narrow({});
  const auto found = narrow.find(view_of(std::as_const(scene.bodies)), view_of(pairs), scene.margin.view());
  ASSERT_EQ(found.size(), count * max_pair_manifolds + count - 1);
  for (std::size_t k = 1; k < found.size(); ++k) {
    ASSERT_LE(std::tuple(found[k - 1].i, found[k - 1].j, found[k - 1].part),
              std::tuple(found[k].i, found[k].j, found[k].part));
    if (found[k].i > 0) {
      ASSERT_EQ(found[k].part, 0);
    }
  }
}

TEST(PairContacts, EveryMethodFindsTheSamePairs) {
  const Scene scene = crowd(300);
  const std::vector<Pair> pairs = all_pairs(scene.bodies);
  const ConstView<Pair> pair_view = view_of(pairs);
  PairContacts sat({BoxBoxMethod::sat});
  const auto expected = sat.find(view_of(scene.bodies), pair_view, scene.margin.view());
  EXPECT_EQ(sat.stats().ccd_calls, 0);
  for (const BoxBoxMethod method : {BoxBoxMethod::automatic, BoxBoxMethod::ccd_gjk, BoxBoxMethod::ccd_mpr}) {
    PairContacts narrow({method});
    const auto found = narrow.find(view_of(scene.bodies), pair_view, scene.margin.view());
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t k = 0; k < found.size(); ++k) {
      ASSERT_EQ(found[k].i, expected[k].i);
      ASSERT_EQ(found[k].j, expected[k].j);
    }
    EXPECT_EQ(narrow.stats().ccd_calls > 0, method != BoxBoxMethod::automatic);
    EXPECT_LE(narrow.stats().ccd_rejected, narrow.stats().ccd_calls);
  }
}

/// A crowd with every shape except surfaces.
struct Particles {
  Scene scene;
  Hull hull;
  std::vector<ShapeData> data;

  explicit Particles(int count) {
    const std::array<Vec3, 5> corners = {Vec3(0.5, 0, 0), Vec3(-0.4, 0.3, 0), Vec3(-0.4, -0.4, 0.1),
                                         Vec3(0, 0, 0.5), Vec3(0.1, 0.1, -0.4)};
    hull = make_hull(corners);
    BodyTable table;
    const double extent = 0.8 * std::cbrt(static_cast<double>(count));
    for (int n = 0; n < count; ++n) {
      Random random(12, static_cast<std::uint64_t>(n));
      const auto uniform = [&random](double low, double high) {
        const double x = random.uniform(low, high), y = random.uniform(low, high);
        return Vec3(x, y, random.uniform(low, high));
      };
      const std::array<std::pair<Shape, Vec3>, 5> kinds = {{{Shape::sphere, Vec3::Constant(0.4)},
                                                            {Shape::box, Vec3(0.3, 0.4, 0.5)},
                                                            {Shape::capsule, Vec3(0.2, 0.2, 0.5)},
                                                            {Shape::cylinder, Vec3(0.4, 0.4, 0.2)},
                                                            {Shape::polyhedron, hull.half_extent()}}};
      const auto& [shape, size] = kinds[static_cast<std::size_t>(n % 5)];
      add(table, shape, Mobility::free, uniform(0, extent), rotation_of(uniform(-2, 2)), size);
      data.push_back({.hull = shape == Shape::polyhedron ? &hull : nullptr});
    }
    copy_bodies(scene.bodies, table);
    scene.margin.resize(count);
    parallel::fill("margin", scene.margin, 0.01);
  }

  PairContacts by(const NarrowPhaseSettings& settings) const {
    return PairContacts(settings, {data.data(), static_cast<std::int64_t>(data.size())});
  }
};

TEST(PairContacts, EveryMethodOfConvexParticlesFindsTheSamePairs) {
  const Particles particles(300);
  const Scene& scene = particles.scene;
  const std::vector<Pair> pairs = all_pairs(scene.bodies);
  PairContacts axes = particles.by({.convex = ConvexMethod::axes});
  const auto expected = axes.find(view_of(scene.bodies), view_of(pairs), scene.margin.view());
  EXPECT_GT(expected.size(), 300);
  EXPECT_EQ(axes.stats().ccd_calls, 0);
  for (const ConvexMethod method : {ConvexMethod::automatic, ConvexMethod::ccd_gjk, ConvexMethod::ccd_mpr}) {
    PairContacts narrow = particles.by({.convex = method});
    const auto found = narrow.find(view_of(scene.bodies), view_of(pairs), scene.margin.view());
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t k = 0; k < found.size(); ++k) {
      ASSERT_EQ(found[k].i, expected[k].i);
      ASSERT_EQ(found[k].j, expected[k].j);
      if (method == ConvexMethod::automatic) expect_same(found[k], expected[k]);
    }
    EXPECT_EQ(narrow.stats().ccd_calls > 100, method != ConvexMethod::automatic);
    EXPECT_LT(narrow.stats().ccd_rejected, std::max<std::int64_t>(1, narrow.stats().ccd_calls));
  }
}

TEST(PairContacts, ACrosscheckAsksAboutConvexParticlesTooAndChangesNothing) {
  const Particles particles(300);
  const Scene& scene = particles.scene;
  const std::vector<Pair> pairs = all_pairs(scene.bodies);
  PairContacts unchecked = particles.by({}), checked = particles.by({.crosscheck = 1});
  const auto expected = unchecked.find(view_of(scene.bodies), view_of(pairs), scene.margin.view());
  const auto found = checked.find(view_of(scene.bodies), view_of(pairs), scene.margin.view());
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t k = 0; k < found.size(); ++k) expect_same(found[k], expected[k]);
  // The crosscheck tests all pairs except those of a sphere with a sphere, box or capsule, which have closed
  // forms.
  const ConstBodyView b = view_of(scene.bodies);
  const auto asked = std::count_if(pairs.begin(), pairs.end(), [&](const Pair& pair) {
    const auto [low, high] = std::minmax(b.shape[pair.i], b.shape[pair.j]);
    return low != Shape::sphere || high > Shape::capsule;
  });
  EXPECT_EQ(checked.stats().crosscheck.asked, asked);
  EXPECT_EQ(checked.stats().crosscheck.ccd_shallower.total(), 0);
  EXPECT_EQ(unchecked.stats().crosscheck.asked, 0);
}

TEST(PairContacts, ACrosscheckAsksTheShareAndChangesNothing) {
  const Scene scene = crowd(1500);
  const std::vector<Pair> pairs = all_pairs(scene.bodies);
  const ConstView<Pair> pair_view = view_of(pairs);
  PairContacts unchecked({});
  const auto expected = unchecked.find(view_of(scene.bodies), pair_view, scene.margin.view());
  EXPECT_EQ(unchecked.stats().crosscheck.asked, 0);

  const auto box_pairs = std::count_if(pairs.begin(), pairs.end(), [&](const Pair& pair) {
    const ConstBodyView b = view_of(scene.bodies);
    return b.shape[pair.i] == Shape::box && b.shape[pair.j] == Shape::box &&
           (b.mobility[pair.i] == Mobility::free || b.mobility[pair.j] == Mobility::free);
  });
  PairContacts narrow({.crosscheck = 0.01});
  std::int64_t last = -1;
  for (int search = 0; search < 3; ++search) {
    const auto found = narrow.find(view_of(scene.bodies), pair_view, scene.margin.view());
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t k = 0; k < found.size(); ++k) expect_same(found[k], expected[k]);
    const std::int64_t asked = narrow.stats().crosscheck.asked;
    EXPECT_NEAR(static_cast<double>(asked), 0.01 * static_cast<double>(box_pairs),
                5 * std::sqrt(0.01 * static_cast<double>(box_pairs)));
    EXPECT_NE(asked, last);  // the next search chooses other pairs
    last = asked;
  }
}

TEST(PairContacts, ACrosscheckOfEveryPairFindsLibccdAtFaultAlone) {
  const Scene scene = crowd(1500);
  const std::vector<Pair> pairs = all_pairs(scene.bodies);
  PairContacts narrow({.crosscheck = 1});
  narrow.find(view_of(scene.bodies), view_of(pairs), scene.margin.view());
  const CrosscheckStats& check = narrow.stats().crosscheck;
  EXPECT_GT(check.ccd_deeper.total(), 100);  // MPR's portal is not the shortest way out of a deep overlap
  EXPECT_EQ(check.ccd_shallower.total(), 0);
  EXPECT_EQ(check.touching.total(), 0);
}

TEST(Disagreements, CountByDecadeFromTheLeastThatCounts) {
  Disagreements d;
  for (const double size : {-1.0, 0.0, 9.9e-7, 1.1e-6, 9.9e-6, 1.1e-5, 0.99, 1.1, 1e9, HUGE_VAL})
    d.note(size);
  EXPECT_EQ(d.count, (std::array<std::int64_t, Disagreements::decades>{2, 1, 0, 0, 0, 1, 3}));
  EXPECT_EQ(d.total(), 7);
  Disagreements sum = d;
  sum += d;
  EXPECT_EQ(sum.total(), 14);
}

}  // namespace
}  // namespace scree
