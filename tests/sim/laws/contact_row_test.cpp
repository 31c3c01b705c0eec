// Tests of the local Coulomb problem against its own conditions: a solution is any state that satisfies them,
// however it is found.
#include "sim/laws/contact_row.hpp"

#include "core/rng.hpp"
#include "sim/laws/rotation.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace scree {
namespace {

// The rounding error of velocities of some m/s. Where the disc of friction is small beside the impulse that
// is cut to it, this is a thousand times that of one operation.
constexpr double rounding = 1e-12;
constexpr double still = 1e-9;  // (m/s); slower slip has no direction that friction could oppose

Vec3 random_vector(Random& random, double size) {
  return Vec3(random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size));
}

SolverBody random_box(Random& random) {
  const Quat q = rotation_of(random_vector(random, 3));
  const Vec3 inverse_inertia(random.uniform(1, 20), random.uniform(1, 20), random.uniform(1, 20));
  return {random_vector(random, 2), random_vector(random, 3), random.uniform(0.2, 3),
          world_inverse_inertia(q, inverse_inertia)};
}

struct Problem {
  SolverBody i, j;
  ContactRow row;
  RowCoupling coupling;
  Vec3 normal;
  double friction;

  void sweep() { sweep_rows(&row, &coupling, 1, normal, friction, i, j); }
};

Problem random_problem(std::uint64_t item, bool spheres) {
  Random random(11, item);
  Problem p{random_box(random),    random_box(random), {}, {}, random_vector(random, 1).normalized(),
            random.uniform(0, 1.2)};
  Vec3 arm_i = random_vector(random, 0.5);
  Vec3 arm_j = random_vector(random, 0.5);
  if (spheres) {
    arm_i = random.uniform(0.1, 1) * p.normal;
    arm_j = -random.uniform(0.1, 1) * p.normal;
    p.i.inverse_inertia = 2.5 * p.i.inverse_mass / arm_i.squaredNorm() * Mat3::Identity();
    p.j.inverse_inertia = 2.5 * p.j.inverse_mass / arm_j.squaredNorm() * Mat3::Identity();
  }
  p.row = make_row(p.normal, arm_i, arm_j, 0.0, p.i, p.j, p.coupling);
  p.row.target = random.uniform(-0.5, 0.5);
  return p;
}

/// Returns how far the state after the solve is from Signorini's and Coulomb's conditions (m/s).
double violation(const Problem& p) {
  const Vec3 u = p.row.relative_velocity(p.i, p.j);
  const Vec3& n = p.normal;
  const double un = u.dot(n) - p.row.target;
  const double pn = p.row.impulse.dot(n);
  const Vec3 pt = p.row.impulse - pn * n;
  const Vec3 ut = u - u.dot(n) * n;
  double worst = pn > 0 ? std::abs(un) : std::max(0.0, -un);
  const double radius = p.friction * pn;
  EXPECT_GE(pn, 0.0);
  EXPECT_LE(pt.norm(), radius * (1 + rounding));
  if (pn > 0 && pt.norm() < radius * (1 - rounding)) worst = std::max(worst, ut.norm());  // sticks
  if (pn > 0 && radius > 0 && ut.norm() > still) {  // slides: friction opposes it at full strength
    worst = std::max(worst, (pt / radius + ut / ut.norm()).norm() * ut.norm());
  }
  return worst;
}

TEST(ContactRow, OneSweepSolvesSpheresExactly) {
  for (std::uint64_t item = 0; item < 20000; ++item) {
    Problem p = random_problem(item, true);
    const double speed = p.row.relative_velocity(p.i, p.j).norm();
    p.sweep();
    ASSERT_LT(violation(p), rounding * (1 + speed)) << "problem " << item;
  }
}

/// Each pair is a free ball with a free ball, or with a body that never moves.
TEST(ContactRow, TheNaturalMapOfBallsIsTheLocalSolution) {
  for (std::uint64_t item = 0; item < 20000; ++item) {
    Problem p = random_problem(item, true);
    if (item % 2 == 0) {
      p.i.inverse_mass = 0;
      p.i.inverse_inertia.setZero();
    }
    const double target = p.row.target;
    p.row = make_row(p.normal, p.row.arm_i, p.row.arm_j, 0.0, p.i, p.j, p.coupling);
    Problem ball = p;
    ball.row = make_ball_row(p.row.arm_i, p.row.arm_j, 0.0, p.i, p.j);
    p.row.target = ball.row.target = target;
    const double speed = 1 + p.row.relative_velocity(p.i, p.j).norm();
    ASSERT_NEAR(ball.row.normal_mass, p.row.normal_mass, rounding * p.row.normal_mass);
    ASSERT_NEAR(ball.row.tangent_mass, p.row.tangent_mass, rounding * p.row.tangent_mass);
    p.sweep();
    ball.row.impulse =
        natural_map(ball.row, ball.normal, ball.friction, ball.row.relative_velocity(ball.i, ball.j));
    ASSERT_LT((ball.row.impulse - p.row.impulse).norm(), rounding * speed * p.row.normal_mass) << item;
  }
}

TEST(ContactRow, SweepsConvergeToCoulombForAnyBodies) {
  int slow = 0;
  for (std::uint64_t item = 0; item < 2000; ++item) {
    Problem p = random_problem(item, false);
    for (int sweep = 0; sweep < 2000; ++sweep) p.sweep();
    slow += violation(p) > still ? 1 : 0;
  }
  EXPECT_EQ(slow, 0);
}

TEST(ContactRow, ConservesMomentumAndMovesTheEnergyThatTheAccountSays) {
  for (std::uint64_t item = 0; item < 1000; ++item) {
    Problem p = random_problem(item, false);
    const auto energy = [&p] {
      double sum = 0;
      for (const SolverBody* b : {&p.i, &p.j}) {
        sum += 0.5 * b->velocity.squaredNorm() / b->inverse_mass +
               0.5 * b->spin.dot(b->inverse_inertia.inverse() * b->spin);
      }
      return sum;
    };
    const auto momentum = [&p] {
      return Vec3(p.i.velocity / p.i.inverse_mass + p.j.velocity / p.j.inverse_mass);
    };
    const double e0 = energy();
    const Vec3 p0 = momentum();
    const Vec3 u0 = p.row.relative_velocity(p.i, p.j);
    p.sweep();
    const Vec3 u1 = p.row.relative_velocity(p.i, p.j);
    EXPECT_LT((momentum() - p0).norm(), rounding * (1 + p0.norm()));
    EXPECT_NEAR(energy() - e0, p.row.impulse.dot(0.5 * (u0 + u1)), rounding * (1 + e0));
  }
}

TEST(ContactRow, ConeProjectionIsTheIdentityInsideAndOnTheDiscOutside) {
  const Vec3 n(0, 0, 1);
  EXPECT_EQ(project_on_cone(Vec3(0.3, 0.4, 1), n, 0.5), Vec3(0.3, 0.4, 1));
  EXPECT_LT((project_on_cone(Vec3(3, 4, 1), n, 0.5) - Vec3(0.3, 0.4, 1)).norm(), 1e-15);
  EXPECT_EQ(project_on_cone(Vec3(3, 4, -1), n, 0.5), Vec3(Vec3::Zero()));
}

}  // namespace
}  // namespace scree
