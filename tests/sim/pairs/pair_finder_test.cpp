// Tests that the pairs kept for bodies in either space are those of bodies on Host, and so are the forces
// applied to them.
#include "sim/pairs/pair_finder.hpp"

#include "core/rng.hpp"
#include "core/tolerances.hpp"
#include "narrowphase/pair_contacts.hpp"
#include "sim/bodies/applied_forces.hpp"
#include "sim/pairs/new_pairs.hpp"
#include "sim/step/moving_state.hpp"
#include "tests/core/spaces.hpp"
#include "tests/sim/step/simulations.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <set>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace scree {
namespace {

template <class Space>
class InSpaceTest : public test::InSpace<Space> {};
TYPED_TEST_SUITE(InSpaceTest, test::Spaces, test::SpaceName);

Scene heap() {
  return scene_of(R"(
gravity: [0, 0, -10]
materials: {a: {density: 1000}}
time: {end: 1, step: 0.01}
bodies:
  - {plane: {normal: [0, 0, 1], offset: 0}, material: a}
  - {box: {size: [2, 2, 0.1]}, fixed: true, at: [0, 0, 0.5], material: a}
  - {sphere: {radius: 0.1}, name: ball, at: [-0.9, -0.9, 0.05], repeat: {count: [9, 9, 14], spacing: [0.201, 0.201, 0.201], jitter: 0.01}, material: a}
  - {plane: {normal: [1, 0, 0], offset: -1}, material: a}
forces:
  - {on: ball, force: [1, 2, 3], torque: [3, 2, 1], from: 0.1, until: 0.5}
  - {on: "ball[7]", force: [0, 0, 5], from: 0.2}
)");
}

/// The pairs and boxes of the bodies, with the broad phase in their own space.
template <class Space>
struct Found {
  std::vector<std::pair<std::int32_t, std::int32_t>> pairs;
  std::vector<BodyBox> boxes;
  std::size_t cells;
  std::int64_t pcs, made;

  Found(const Scene& scene, KeptPairs<Space>& kept, const Bodies<Space>& bodies) {
    Array<double, Space> margin;
    ResponseParameters parameters;
    parameters.gravity = scene.gravity;
    const SearchTime time{.now = 0, .substep = 0.01, .foresight = 0.01};
    if (!kept.cover(bodies, time, parameters, margin)) kept.make(bodies, time, parameters, margin);
    const ConstView<Pair> view = kept.pairs();
    std::vector<Pair> found(static_cast<std::size_t>(view.size()));
    copy_bytes<Host, Space>(found.data(), view.data(), found.size() * sizeof(Pair));
    for (const Pair& pair : found) pairs.emplace_back(pair.i, pair.j);
    boxes = kept.boxes();
    cells = kept.grid_occupancy().cells.size();
    pcs = kept.size();
    made = kept.times_made();
  }
};

TYPED_TEST(InSpaceTest, KeptPairsAreThoseOnHost) {
  const Scene scene = heap();
  const bool on_device = !std::is_same_v<TypeParam, Host>;
  BodyTable state = scene.bodies;
  KeptPairs<TypeParam> kept(scene.broadphase, on_device, Vec3::Zero());
  KeptPairs<Host> oracle({.method = BroadPhaseMethod::brute_force}, false, Vec3::Zero());
  for (int step = 0; step < 3; ++step) {
    Bodies<TypeParam> bodies;
    Bodies<Host> bodies_on_host;
    copy_bodies(bodies, state);
    copy_bodies(bodies_on_host, state);
    const Found<TypeParam> found(scene, kept, bodies);
    const Found<Host> expected(scene, oracle, bodies_on_host);
    ASSERT_GT(found.pairs.size(), 800) << "of some 1,100 bodies";
    EXPECT_EQ(found.pairs, expected.pairs);
    EXPECT_EQ(found.pcs, expected.pcs);
    EXPECT_EQ(found.made, step + 1);
    EXPECT_GT(found.cells, 100);
    ASSERT_EQ(found.boxes.size(), expected.boxes.size());
    for (std::size_t k = 0; k < found.boxes.size(); ++k) {
      EXPECT_EQ(found.boxes[k].lo, expected.boxes[k].lo);
      EXPECT_EQ(found.boxes[k].hi, expected.boxes[k].hi);
    }
    // More bodies leave their boxes than are compared with the others in either space, so that the pairs are
    // found anew.
    for (std::size_t k = 2; k + 1 < state.position.size(); k += 2) state.position[k].x() += 0.05;
    ASSERT_GT(state.position.size() / 2 - 2, static_cast<std::size_t>(NewPairs<TypeParam>::most_outside));
  }
}

/// Pairs are kept though some bodies have left their boxes, as long as these can touch no other body. The
/// oracle is the contacts of all pairs.
TYPED_TEST(InSpaceTest, PairsLastUntilOneOutsideItsBoxMayTouchAnother) {
  const Scene scene = scene_of(R"(
seed: 4
time: {end: 1, step: 0.01}
materials: {a: {density: 1000}}
bodies:
  - {plane: {normal: [0, 0, 1], offset: -1.2}, material: a}
  - {tube: {radius: 1.7, length: 3}, fixed: true, at: [0, 0, 0], material: a}
  - {box: {size: [1, 0.6, 0.1]}, fixed: true, at: [0, 0, 0], orientation: [1, 0.2, 0.2, 0], material: a}
  - {sphere: {radius: 0.08}, at: [-0.9, -0.9, -1], repeat: {count: [7, 7, 3], spacing: [0.3, 0.3, 0.5], jitter: 0.03}, material: a}
  - {box: {size: [0.2, 0.15, 0.1]}, at: [-0.9, -0.9, -0.8], repeat: {count: [7, 7, 3], spacing: [0.3, 0.3, 0.5], jitter: 0.03}, material: a}
)");
  const bool on_device = !std::is_same_v<TypeParam, Host>;
  KeptPairs<TypeParam> kept(scene.broadphase, on_device, Vec3::Zero());
  ResponseParameters parameters;
  parameters.gravity = Vec3::Zero();
  Bodies<TypeParam> bodies;
  Array<double, TypeParam> margin;
  int lasted = 0, ended = 0;
  for (std::uint64_t trial = 0; trial < 120; ++trial) {
    BodyTable state = scene.bodies;
    copy_bodies(bodies, state);
    kept.forget();
    EXPECT_FALSE(kept.cover(bodies, {}, parameters, margin));
    kept.make(bodies, {}, parameters, margin);
    Random random(47, trial);
    const double way = random.uniform(0.001, 0.05);
    for (int moved = 0; moved < 12;) {
      const auto k = static_cast<std::size_t>(random.uniform(0, static_cast<double>(state.position.size())));
      if (state.mobility[k] != Mobility::free) continue;
      const double x = random.uniform(-way, way), y = random.uniform(-way, way);
      state.position[k] += Vec3(x, y, random.uniform(-way, way));
      ++moved;
    }
    copy_bodies(bodies, state);
    if (!kept.cover(bodies, {}, parameters, margin)) {
      ++ended;
      continue;
    }
    ++lasted;
    std::vector<Pair> pairs(static_cast<std::size_t>(kept.pairs().size()));
    copy_bytes<Host, TypeParam>(pairs.data(), kept.pairs().data(), pairs.size() * sizeof(Pair));
    std::set<std::pair<std::int32_t, std::int32_t>> known;
    for (const Pair& pair : pairs) known.insert(std::minmax(pair.i, pair.j));
    const std::vector<double> reach = to_vector(margin);
    const auto solid = [&](std::size_t k) {
      return Solid{state.position[k], state.orientation[k], state.size[k]};
    };
    for (std::size_t i = 0; i < reach.size(); ++i) {
      for (std::size_t j = i + 1; j < reach.size(); ++j) {
        if (state.mobility[i] != Mobility::free && state.mobility[j] != Mobility::free) continue;
        Manifold manifolds[max_pair_manifolds];
        const bool touch = find_pair_contacts(state.shape[i], solid(i), state.shape[j], solid(j),
                                              reach[i] + reach[j], manifolds) > 0;
        const std::pair<std::int32_t, std::int32_t> pair(i, j);
        ASSERT_TRUE(!touch || known.contains(pair)) << "trial " << trial << ": " << i << ", " << j;
      }
    }
  }
  EXPECT_GT(lasted, 30);
  EXPECT_GT(ended, 20);
}

/// A ball falls alone, and has room for its whole travel as soon as it is paired with the ground.
TYPED_TEST(InSpaceTest, ABodyHasRoomForContactsWithANewPair) {
  Scene scene = scene_of(R"(
time: {end: 1, step: 0.1}
materials: {a: {density: 1000}}
bodies:
  - {plane: {normal: [0, 0, 1], offset: 0}, material: a}
  - {sphere: {radius: 0.5}, at: [0, 0, 209], velocity: [0, 0, -20], material: a}
)");
  ResponseParameters parameters;
  parameters.gravity = Vec3(0, 0, -10);
  KeptPairs<TypeParam> kept(scene.broadphase, !std::is_same_v<TypeParam, Host>, Vec3::Zero());
  Bodies<TypeParam> bodies;
  Array<double, TypeParam> margin, whole;
  const std::size_t ball = 1;
  for (int step = 0; step < 105; ++step) {
    copy_bodies(bodies, scene.bodies);
    const SearchTime time{.now = 0.1 * step, .substep = 0.1, .foresight = 0.1};
    if (!kept.cover(bodies, time, parameters, margin)) kept.make(bodies, time, parameters, margin);
    contact_margins(bodies, time.foresight, tolerance::contact_slack, parameters, {}, whole);
    const double share = to_vector(margin)[ball] / to_vector(whole)[ball];
    if (step == 0) {
      EXPECT_LT(share, 0.1) << "the boxes follow paths";
    }
    if (step == 104) {
      EXPECT_EQ(share, 1) << "the ball meets the ground in this substep";
    }
    scene.bodies.position[ball].z() -= 2;
  }
}

/// Moves bodies that flow together and are struck now and then, and checks at each substep, and after each
/// blow, that the pairs kept include all that meet in free flight. The oracle is the contacts of all pairs,
/// at several times of the substep.
template <class Space>
void expect_pairs_that_meet(const Period& period) {
  const std::string walls = R"(
  - {plane: {normal: [0, 0, 1], offset: -1.3}, material: a}
  - {tube: {radius: 2, length: 3.4}, fixed: true, at: [0, 0, 0], material: a}
)";
  const Scene scene = scene_of(R"(
seed: 4
time: {end: 1, step: 0.01}
materials: {a: {density: 1000}}
bodies:
)" + (period.exists ? "" : walls) +
                               R"(
  - {box: {size: [1, 0.6, 0.1]}, fixed: true, at: [0, 0, 0], orientation: [1, 0.2, 0.2, 0], material: a}
  - {sphere: {radius: 0.08}, at: [-0.9, -0.9, -1], repeat: {count: [7, 7, 3], spacing: [0.3, 0.3, 0.5], jitter: 0.03}, material: a}
  - {box: {size: [0.2, 0.15, 0.1]}, at: [-0.9, -0.9, -0.8], repeat: {count: [7, 7, 3], spacing: [0.3, 0.3, 0.5], jitter: 0.03}, material: a}
)");
  ResponseParameters parameters;
  parameters.gravity.setZero();
  KeptPairs<Space> kept(scene.broadphase, !std::is_same_v<Space, Host>, Vec3::Zero());
  Bodies<Space> bodies;
  Array<double, Space> margin;
  int lasted = 0, ended = 0, met = 0;
  const auto n = static_cast<std::int32_t>(scene.bodies.position.size());
  const auto check = [&](const BodyTable& state, double now, double h) {
    const SearchTime time{.now = now, .substep = h, .foresight = h};
    copy_bodies(bodies, state);
    bodies.period = period;
    const bool covered = kept.cover(bodies, time, parameters, margin);
    ++(covered ? lasted : ended);
    if (!covered) kept.make(bodies, time, parameters, margin);
    std::vector<Pair> pairs(static_cast<std::size_t>(kept.pairs().size()));
    copy_bytes<Host, Space>(pairs.data(), kept.pairs().data(), pairs.size() * sizeof(Pair));
    std::set<std::pair<std::int32_t, std::int32_t>> known;
    for (const Pair& pair : pairs) known.insert(std::minmax(pair.i, pair.j));
    for (int sample = -4; sample <= 4; ++sample) {
      const double s = sample * h / 8;
      const auto solid = [&](std::int32_t body) {
        const auto k = static_cast<std::size_t>(body);
        return Solid{state.position[k] + s * state.velocity[k],
                     rotation_of(s * state.spin[k]) * state.orientation[k], state.size[k]};
      };
      for (std::int32_t i = 0; i < n; ++i) {
        for (std::int32_t j = i + 1; j < n; ++j) {
          const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
          if (state.mobility[a] != Mobility::free && state.mobility[b] != Mobility::free) continue;
          const Solid first = solid(i);
          Solid second = solid(j);
          period.bring_near(first.position, second.position);
          const double reach =
              bounding_radius(state.shape[a], state.size[a]) + bounding_radius(state.shape[b], state.size[b]);
          if (!is_boundary(state.shape[a]) && (second.position - first.position).norm() > reach) continue;
          Manifold manifolds[max_pair_manifolds];
          if (find_pair_contacts(state.shape[a], first, state.shape[b], second, 0, manifolds) == 0) continue;
          ++met;
          ASSERT_TRUE(known.contains({i, j})) << now << " s: " << i << ", " << j << " at " << s << " s";
        }
      }
    }
  };
  for (std::uint64_t trial = 0; trial < 12; ++trial) {
    BodyTable state = scene.bodies;
    Random random(53, trial);
    const auto vector = [&random](double most) {
      const double x = random.uniform(-most, most), y = random.uniform(-most, most);
      return Vec3(x, y, random.uniform(-most, most));
    };
    // The bodies travel up to several times their size in a substep, and one in 12 against the flow.
    const Vec3 flow = vector(random.uniform(2, 20));
    for (std::size_t k = 0; k < state.position.size(); ++k) {
      if (state.mobility[k] != Mobility::free) continue;
      state.velocity[k] = (k % 12 == 0 ? Vec3(-flow) : flow) + vector(0.2);
      if (state.shape[k] == Shape::box) state.spin[k] = vector(k % 5 == 0 ? 20 : 3);
    }
    kept.forget();
    double now = static_cast<double>(trial);
    for (int step = 0; step < 8; ++step) {
      // The length of substeps changes, and `now` is in the middle of one.
      const double h = random.uniform() < 0.5 ? 0.01 : 0.005;
      check(state, now, h);
      for (int blow = 0; blow < 3; ++blow) {
        const auto k = static_cast<std::size_t>(random.uniform(0, n));
        if (state.mobility[k] != Mobility::free) continue;
        state.velocity[k] = blow == 0   ? Vec3(Vec3::Zero())
                            : blow == 1 ? Vec3(-0.5 * state.velocity[k])
                                        : vector(flow.norm());
      }
      check(state, now, h);
      if (testing::Test::HasFatalFailure()) return;
      for (std::size_t k = 0; k < state.position.size(); ++k) {
        state.position[k] += h * state.velocity[k];
        state.orientation[k] = rotation_of(h * state.spin[k]) * state.orientation[k];
      }
      now += h;
    }
  }
  EXPECT_GT(lasted, 40);
  EXPECT_GT(ended, 20);
  EXPECT_GT(met, 1000);
}

TYPED_TEST(InSpaceTest, PairsAlongPathsIncludeAllThatMeet) { expect_pairs_that_meet<TypeParam>({}); }

TYPED_TEST(InSpaceTest, PairsAlongPathsIncludeAllThatMeetThroughAPeriod) {
  Period period = period_of(Vec3(-1.05, -1.05, -2), Vec3(2.1, 2.1, 0));
  period.most_margin = 0.6;
  expect_pairs_that_meet<TypeParam>(period);
}

TYPED_TEST(InSpaceTest, ForcesActFromTheirStartToTheirEnd) {
  const Scene scene = heap();
  Bodies<TypeParam> bodies;
  copy_bodies(bodies, scene.bodies);
  AppliedForces<TypeParam> forces(scene, TimeGrid(scene.time));
  ResponseParameters parameters;
  const std::size_t seventh = 2 + 7;
  const auto expect = [&](std::int64_t step, const Vec3& force, const Vec3& torque) {
    forces.act(step, bodies, parameters);
    std::vector<Vec3> acceleration(scene.bodies.position.size()), torques(acceleration.size());
    ASSERT_EQ(parameters.acceleration.size(), static_cast<std::int64_t>(acceleration.size()));
    const std::size_t bytes = acceleration.size() * sizeof(Vec3);
    copy_bytes<Host, TypeParam>(acceleration.data(), parameters.acceleration.data(), bytes);
    copy_bytes<Host, TypeParam>(torques.data(), parameters.torque.data(), bytes);
    EXPECT_LT((acceleration[seventh] / scene.bodies.inverse_mass[seventh] - force).norm(), 1e-14) << step;
    EXPECT_EQ(torques[seventh], torque) << step;
    EXPECT_EQ(acceleration[0], Vec3(Vec3::Zero()));
  };
  expect(9, Vec3(0, 0, 0), Vec3(0, 0, 0));
  expect(10, Vec3(1, 2, 3), Vec3(3, 2, 1));
  expect(19, Vec3(1, 2, 3), Vec3(3, 2, 1));
  expect(20, Vec3(1, 2, 8), Vec3(3, 2, 1));
  expect(50, Vec3(0, 0, 5), Vec3(0, 0, 0));

  forces.start_substep(bodies);
  BodyTable moved = scene.bodies;
  for (Vec3& position : moved.position) position += Vec3(0.5, 0, 0.25);
  copy_bodies(bodies, moved);
  EXPECT_NEAR(forces.work(bodies), 5 * 0.25, 1e-13);

  // After forget(), the masses of bodies that have changed are read again.
  moved.inverse_mass[seventh] = 0;
  copy_bodies(bodies, moved);
  forces.forget();
  forces.act(51, bodies, parameters);
  Vec3 acceleration;
  copy_bytes<Host, TypeParam>(&acceleration, parameters.acceleration.data() + seventh, sizeof(Vec3));
  EXPECT_EQ(acceleration, Vec3(Vec3::Zero()));
}

TYPED_TEST(InSpaceTest, AMovingStateIsGoneBackTo) {
  const Scene scene = heap();
  Bodies<TypeParam> bodies;
  copy_bodies(bodies, scene.bodies);
  MovingState<TypeParam> state;
  state.save(bodies);
  BodyTable moved = scene.bodies;
  for (std::size_t k = 0; k < moved.position.size(); ++k) {
    moved.position[k].x() += 1;
    moved.velocity[k].y() += 1;
    moved.spin[k].z() += 1;
    moved.orientation[k] = rotation_of(Vec3(1, 2, 3));
  }
  copy_bodies(bodies, moved);
  state.restore(bodies);
  BodyTable restored;
  copy_bodies(restored, bodies);
  EXPECT_NE(hash_of(restored), hash_of(moved));
  EXPECT_EQ(hash_of(restored), hash_of(scene.bodies));
}

}  // namespace
}  // namespace scree
