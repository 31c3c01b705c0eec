// Contacts of balls that are made in lanes, beside those that the narrow phase and the rows make one by one.
#include "sim/dynamics/ball_pairs.hpp"

#include "core/rng.hpp"
#include "sim/dynamics/contact_rows.hpp"
#include "sim/dynamics/contact_set.hpp"
#include "sim/dynamics/motion.hpp"
#include "sim/dynamics/response.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <utility>
#include <vector>

namespace scree {
namespace {

constexpr double step = 0.004;
constexpr double rounding = 1e-12;

/// A ball that moves as it is told, a floor, a fixed ball, one that turns in its place, and a crowd of free
/// balls around them.
BodyTable crowd(std::uint64_t seed) {
  BodyTable table;
  for (std::int32_t k = 0; k < 150; ++k) {
    Random random(seed, static_cast<std::uint64_t>(k));
    const auto vector = [&random](double size) {
      const double x = random.uniform(-size, size);
      const double y = random.uniform(-size, size);
      return Vec3(x, y, random.uniform(-size, size));
    };
    const bool plane = k == 1;
    const bool free = k > 3;
    table.position.push_back(plane ? Vec3(0, 0, -0.1) : vector(0.1));
    table.orientation.push_back(plane ? Quat::Identity() : rotation_of(vector(2)));
    table.velocity.push_back(plane || k == 2 ? Vec3(Vec3::Zero()) : vector(0.3));
    table.spin.push_back(free || k == 3 ? vector(3) : Vec3(Vec3::Zero()));
    table.size.push_back(Vec3::Constant(plane ? 0 : random.uniform(0.01, 0.03)));
    table.inverse_mass.push_back(free ? random.uniform(0.5, 2) : 0);
    table.inverse_inertia.push_back(Vec3::Constant(free ? random.uniform(1000, 3000) : 0));
    table.shape.push_back(plane ? Shape::plane : Shape::sphere);
    table.mobility.push_back(free              ? Mobility::free
                             : plane || k == 2 ? Mobility::fixed
                                               : Mobility::prescribed);
    table.material.push_back(k % 2);
    table.id.push_back(BodyNumber{k});
  }
  return table;
}

/// All pairs with a free body, in order.
std::vector<Pair> all_pairs(const BodyTable& table) {
  std::vector<Pair> pairs;
  const auto n = static_cast<std::int32_t>(table.count());
  for (std::int32_t i = 0; i < n; ++i) {
    for (std::int32_t j = i + 1; j < n; ++j) {
      if (table.inverse_mass[static_cast<std::size_t>(i)] + table.inverse_mass[static_cast<std::size_t>(j)] >
          0)
        pairs.push_back({i, j});
    }
  }
  return pairs;
}

/// One substep's response, with balls in lanes or without.
struct Substep {
  Bodies<Host> bodies;
  std::vector<PairLaw> table{{0, 0.3, 0.1}, {0, 0, 0}, {0, 0, 0.2}, {0, 0.6, 0.4}};
  std::vector<Pair> pairs;
  Array<double, Host> margin;
  ResponseParameters parameters;
  NarrowPhase narrow_phase{{}};
  ImpulseMemory memory;
  ContactSet set;
  Array<SolverBody, Host> solver;
  ResponseSolver response;
  Counters counters;

  explicit Substep(const BodyTable& start) : pairs(all_pairs(start)) {
    copy_bodies(bodies, start);
    parameters.gravity = Vec3(0, 0, -9.81);
    contact_margins(bodies, step, 0.02, parameters, margin);
  }
  ContactLaws laws() const {
    return {bodies.shape.view(),    bodies.size.view(), bodies.mobility.view(),
            bodies.material.view(), {table.data(), 4},  2};
  }
  Ledger respond(bool in_lanes) {
    const ConstBodyView views = view_of(std::as_const(bodies));
    const ConstView<Pair> candidates(pairs.data(), std::ssize(pairs));
    BallPairs& balls = memory.balls;
    if (in_lanes) balls.take(views, candidates, laws(), parameters);
    balls.find(views, std::as_const(margin).view(), nullptr);
    const Manifolds manifolds = narrow_phase.find(
        views, in_lanes ? balls.others(candidates, nullptr) : candidates, std::as_const(margin).view());
    load_solver_bodies(bodies, solver);
    color_contacts(balls, manifolds.headers, std::as_const(bodies.mobility).view(), set.coloring);
    prepare_contacts(manifolds, laws(), memory, 1, parameters, set);
    Ledger ledger =
        response.solve(manifolds, step, parameters, balls, 1, view_of(bodies), solver, set, counters);
    memory.remember(manifolds, set, bodies.count());
    set.list_all(solver.view());
    return ledger;
  }
  /// A contact, or null.
  const Contact* find(std::int32_t i, std::int32_t j) const {
    for (const Contact& c : set.contacts.view()) {
      if (c.i == i && c.j == j) return &c;
    }
    return nullptr;
  }
};

TEST(BallPairs, MakeTheSameContacts) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const BodyTable start = crowd(seed);
    Substep lanes(start);
    Substep rows(start);
    lanes.parameters.iterations = rows.parameters.iterations = 1;
    lanes.respond(true);
    rows.respond(false);
    ASSERT_EQ(lanes.set.contacts.size(), rows.set.contacts.size());
    ASSERT_GT(lanes.set.pairs, 300);
    ASSERT_LT(lanes.set.pairs, lanes.set.contacts.size());  // the ball that turns in its place
    for (const Contact& c : std::as_const(rows.set.contacts).view()) {
      const Contact* found = lanes.find(c.i, c.j);
      ASSERT_NE(found, nullptr) << c.i << ", " << c.j;
      EXPECT_EQ(found->aligned, c.aligned);
      EXPECT_EQ(found->free_ends, c.free_ends);
      EXPECT_EQ(found->friction, c.friction);
      EXPECT_NEAR(found->size, c.size, rounding);
      EXPECT_LT((found->normal - c.normal).norm(), rounding);
      const ContactRow& a = lanes.set.rows.view()[found->first_row];
      const ContactRow& b = rows.set.rows.view()[c.first_row];
      EXPECT_NEAR(a.gap, b.gap, rounding);
      EXPECT_NEAR(a.bend, b.bend, 1e-9);
      EXPECT_NEAR(a.target, b.target, 1e-10);
      EXPECT_NEAR(a.normal_mass, b.normal_mass, rounding);
      EXPECT_NEAR(a.tangent_mass, b.tangent_mass, rounding);
    }
  }
}

/// Against rolling, in and out of the lanes: within their discs, across their normals, with what they take
/// from the bodies' spins booked; and remembered for the next substep.
TEST(BallPairs, CouplesAreThoseOfTheOtherContacts) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const BodyTable start = crowd(seed);
    Substep lanes(start);
    Substep rows(start);
    lanes.parameters.rolling_friction = rows.parameters.rolling_friction = true;
    lanes.parameters.iterations = rows.parameters.iterations = 400;
    lanes.parameters.tolerance = rows.parameters.tolerance = 1e-12;
    const Ledger ledger = lanes.respond(true);
    rows.respond(false);
    Ledger expected;
    int rolling = 0;
    for (const Contact& c : std::as_const(lanes.set.contacts).view()) {
      const std::int64_t place = &c - lanes.set.contacts.data();
      const Vec3 couple = lanes.set.couples.view()[place];
      const ContactRow& row = lanes.set.rows.view()[c.first_row];
      const double most = c.rolling_reach * row.impulse.dot(c.normal);
      ASSERT_LE(couple.norm(), most * (1 + rounding));
      ASSERT_NEAR(couple.dot(c.normal), 0, rounding * most);
      rolling += couple.norm() > 0;
      const auto i = static_cast<std::size_t>(c.i);
      const auto j = static_cast<std::size_t>(c.j);
      const Vec3 before =
          row.relative_velocity(start.velocity[i], start.spin[i], start.velocity[j], start.spin[j]);
      const SolverBody& body_i = lanes.solver.view()[c.i];
      const SolverBody& body_j = lanes.solver.view()[c.j];
      expected = expected + account(row, c.normal, before, body_i, body_j) +
                 account_couple(couple, start.spin[j] - start.spin[i], body_i, body_j);
      if (c.rolling_reach > 0) {
        const ManifoldHeader header{c.i, c.j, 0, 1, 0, c.normal};
        ASSERT_LE((lanes.memory.recall_couple(header) - couple).norm(), rounding * most);
      }
    }
    EXPECT_GT(rolling, 50);
    const double moved = std::abs(expected.restitution) + std::abs(expected.friction);
    EXPECT_NEAR(ledger.friction, expected.friction, 1e-9 * moved);
    EXPECT_NEAR(ledger.work, expected.work, 1e-9 * moved);
    for (std::int64_t k = 0; k < start.count(); ++k)
      ASSERT_LT((lanes.bodies.spin.view()[k] - rows.bodies.spin.view()[k]).norm(), 1e-6) << k;
  }
}

TEST(BallPairs, BooksAreThoseOfTheirImpulses) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const BodyTable start = crowd(seed);
    Substep s(start);
    s.parameters.iterations = 40;
    const Ledger ledger = s.respond(true);
    Ledger expected;
    std::vector<Vec3> velocity = start.velocity;
    for (std::size_t k = 0; k < velocity.size(); ++k) {
      if (start.mobility[k] == Mobility::free) velocity[k] += step * s.parameters.gravity;
    }
    for (const Contact& c : std::as_const(s.set.contacts).view()) {
      const ContactRow& row = s.set.rows.view()[c.first_row];
      const auto i = static_cast<std::size_t>(c.i);
      const auto j = static_cast<std::size_t>(c.j);
      const Vec3 before =
          row.relative_velocity(start.velocity[i], start.spin[i], start.velocity[j], start.spin[j]);
      expected = expected + account(row, c.normal, before, s.solver.view()[c.i], s.solver.view()[c.j]);
      velocity[i] -= start.inverse_mass[i] * row.impulse;
      velocity[j] += start.inverse_mass[j] * row.impulse;
    }
    const double moved = std::abs(expected.restitution) + std::abs(expected.friction);
    EXPECT_NEAR(ledger.restitution, expected.restitution, rounding * moved);
    EXPECT_NEAR(ledger.friction, expected.friction, rounding * moved);
    EXPECT_NEAR(ledger.work, expected.work, rounding * moved);
    for (std::size_t k = 0; k < velocity.size(); ++k)
      EXPECT_LT((s.bodies.velocity.view()[static_cast<std::int64_t>(k)] - velocity[k]).norm(), rounding);
  }
}

TEST(BallPairs, RememberByPairWhateverTheCandidates) {
  Substep s(crowd(7));
  s.respond(true);
  const ConstBodyView views = view_of(std::as_const(s.bodies));
  std::vector<Pair> fewer;
  for (const Pair& pair : s.pairs) {
    if (pair.i % 3 != 0) fewer.push_back(pair);
  }
  s.memory.balls.take(views, {fewer.data(), std::ssize(fewer)}, s.laws(), s.parameters);
  int loaded = 0;
  for (const Contact& c : std::as_const(s.set.contacts).view()) {
    if (!c.aligned) continue;
    const Vec3 impulse = c.i % 3 != 0 ? s.set.impulse_of(c) : Vec3(Vec3::Zero());
    EXPECT_EQ(s.memory.index().is_loaded(c.i, c.j, 0), !impulse.isZero(0));
    const std::int32_t candidate = s.memory.balls.index().candidate_of(c.i, c.j);
    ASSERT_EQ(candidate != lanes::none, c.i % 3 != 0);
    if (candidate == lanes::none) continue;
    EXPECT_EQ(s.memory.balls.impulse(candidate), impulse);
    loaded += impulse.isZero(0) ? 0 : 1;
  }
  EXPECT_GT(loaded, 50);
}

TEST(BallPairs, ForgetWhatNoLongerTouches) {
  Substep s(crowd(8));
  s.respond(true);
  const std::vector<std::int32_t> touched = s.memory.balls.touching();
  for (Vec3& x : s.bodies.position.view()) x *= 1000;
  s.respond(true);
  for (const std::int32_t candidate : touched) EXPECT_EQ(s.memory.balls.impulse(candidate), Vec3(0, 0, 0));
}

/// What a kernel makes of eight contacts, with every byte.
struct Made {
  lanes::BallBatch batch;
  lanes::BallParting parting;
  lanes::Losses losses;
  lanes::Lane square;
  double deepest;
};

TEST(BallPairs, AreTheSameBitsOnEveryInstructionSet) {
  constexpr int bodies = 2 * lanes::width;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Random random(seed, 0);
    const auto vector = [&random](double size) {
      const double x = random.uniform(-size, size);
      const double y = random.uniform(-size, size);
      return Vec3(x, y, random.uniform(-size, size));
    };
    std::vector<lanes::Ball> balls;
    std::vector<lanes::Reach> reach;
    std::vector<lanes::Body> mean, free, after;
    std::vector<double> inertia;
    std::vector<lanes::Triple> up, kick;
    for (int k = 0; k < bodies; ++k) {
      const bool plane = k % 7 == 3;
      const Vec3 normal = plane ? vector(1).normalized() : Vec3(Vec3::Zero());
      balls.push_back({vector(0.1), plane ? 0 : random.uniform(0.01, 0.1), vector(1), plane ? 0 : 1.3});
      reach.push_back({balls.back().position, balls.back().radius + 0.01});
      inertia.push_back(plane ? 0 : 2000);
      up.push_back({normal.x(), normal.y(), normal.z()});
      kick.push_back({0, 0, plane ? 0 : -0.04});
      for (std::vector<lanes::Body>* list : {&mean, &free, &after})
        list->push_back({vector(1), balls.back().inverse_mass, vector(2), inertia.back()});
    }
    std::vector<lanes::Two> pairs;
    for (int k = 0; k < lanes::look; ++k) pairs.push_back({k % bodies, (3 * k + 1) % bodies});
    Made start{};
    for (int l = 0; l < lanes::width; ++l) {
      const Vec3 p = vector(0.1);
      start.batch.ends.i[l] = 2 * l;
      start.batch.ends.j[l] = 2 * l + 1;
      start.batch.friction.at[l] = random.uniform(0, 1);
      start.batch.impulse.impulse.x.at[l] = p.x();
      start.batch.impulse.impulse.y.at[l] = p.y();
      start.batch.impulse.impulse.z.at[l] = p.z();
      start.parting.flying[l] = l % 3 == 0;
    }
    const Period period = period_of(Vec3::Zero(), Vec3(0.15, 0, 0.3));
    const lanes::BallSource source{.balls = balls.data(),
                                   .inverse_inertia = inertia.data(),
                                   .up = up.data(),
                                   .kick = kick.data(),
                                   .forces = seed % 2 == 0,
                                   .step = step,
                                   .noise = 1e-7,
                                   .period = seed % 3 == 0 ? &period : nullptr};
    std::vector<Made> made;
    std::vector<std::uint64_t> touching;
    for (const auto& [name, kernels] : lanes::supported_kernels()) {
      Made m = start;
      kernels->prepare_balls(source, m.batch, m.parting);
      kernels->book_balls(m.batch, mean.data(), m.losses);
      kernels->square_of_balls(m.batch, free.data(), after.data(), m.square);
      m.deepest = kernels->fly_balls(m.batch, m.parting, after.data(), step);
      made.push_back(m);
      touching.push_back(kernels->touch_balls(reach.data(), pairs.data(), source.period) ^
                         kernels->touch_planes(reach.data(), up.data(), pairs.data()));
    }
    for (std::size_t k = 1; k < made.size(); ++k) {
      EXPECT_EQ(std::memcmp(&made[k], &made[0], sizeof(Made)), 0) << seed;
      EXPECT_EQ(touching[k], touching[0]) << seed;
    }
  }
}

}  // namespace
}  // namespace scree
