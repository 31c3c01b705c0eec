// Tests of free rotation, against Euler's equations integrated by RK4 in long double with tiny steps.
#include "sim/laws/rotation.hpp"

#include "core/rng.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace scree {
namespace {

using Long3 = std::array<long double, 3>;

/// Returns the spin in the body frame after time t: I w' = (I w) x w.
Long3 euler_rk4(Long3 w, const Long3& inertia, long double t, int steps) {
  const auto rate = [&inertia](const Long3& s) {
    return Long3{(inertia[1] - inertia[2]) * s[1] * s[2] / inertia[0],
                 (inertia[2] - inertia[0]) * s[2] * s[0] / inertia[1],
                 (inertia[0] - inertia[1]) * s[0] * s[1] / inertia[2]};
  };
  const auto step_to = [](const Long3& s, const Long3& d, long double h) {
    return Long3{s[0] + h * d[0], s[1] + h * d[1], s[2] + h * d[2]};
  };
  const long double h = t / steps;
  for (int k = 0; k < steps; ++k) {
    const Long3 a = rate(w);
    const Long3 b = rate(step_to(w, a, h / 2));
    const Long3 c = rate(step_to(w, b, h / 2));
    const Long3 d = rate(step_to(w, c, h));
    for (int i = 0; i < 3; ++i) w[i] += h / 6 * (a[i] + 2 * b[i] + 2 * c[i] + d[i]);
  }
  return w;
}

const Vec3 inertia(0.004166666666666667, 0.014166666666666667, 0.016666666666666667);

Vec3 body_spin_after(double t, int steps, RotationOrder order) {
  Quat q(0.5, 0.1, -0.7, 0.2);
  q.normalize();
  Vec3 spin = q * Vec3(1.5, 4.0, -2.0);
  const Vec3 inverse = inertia.cwiseInverse();
  for (int k = 0; k < steps; ++k) rotate_freely(q, spin, inverse, t / steps, order);
  return q.conjugate() * spin;
}

/// The splitting, which a cube does not need: for a body a hair from a cube it converges to the turn at
/// constant spin.
TEST(Rotation, OfACubeIsWhatTheSplittingConvergesTo) {
  const Vec3 cube = Vec3::Constant(240);
  const Vec3 hair = cube.cwiseProduct(Vec3(1, 1 + 1e-15, 1 - 1e-15));
  ASSERT_FALSE(has_equal_moments(hair));
  const auto turned = [](const Vec3& inverse_inertia, int steps, RotationOrder order) {
    Quat q(0.5, 0.1, -0.7, 0.2);
    q.normalize();
    Vec3 spin(1.5, 4.0, -2.0);
    for (int k = 0; k < steps; ++k) rotate_freely(q, spin, inverse_inertia, 1.0 / steps, order);
    return q;
  };
  const Quat exact = turned(cube, 1, RotationOrder::second);
  const auto error = [&](int steps, RotationOrder order) {
    return exact.angularDistance(turned(hair, steps, order));
  };
  EXPECT_NEAR(std::log2(error(100, RotationOrder::second) / error(200, RotationOrder::second)), 2, 0.05);
  EXPECT_NEAR(std::log2(error(20, RotationOrder::fourth) / error(40, RotationOrder::fourth)), 4, 0.1);
  EXPECT_LT(error(2000, RotationOrder::fourth), 1e-12);
}

TEST(Rotation, ConvergesToEulersEquationsWithItsOrder) {
  const Long3 exact = euler_rk4({1.5L, 4.0L, -2.0L}, {inertia.x(), inertia.y(), inertia.z()}, 2.0L, 40000);
  const Vec3 reference(static_cast<double>(exact[0]), static_cast<double>(exact[1]),
                       static_cast<double>(exact[2]));
  const auto error = [&](int steps, RotationOrder order) {
    return (body_spin_after(2.0, steps, order) - reference).norm();
  };
  const auto expect_order = [&](RotationOrder order, double number, double largest_error) {
    EXPECT_LT(error(800, order), largest_error);
    EXPECT_NEAR(std::log2(error(400, order) / error(800, order)), number, 0.05);
  };
  expect_order(RotationOrder::second, 2.0, 1e-3);
  expect_order(RotationOrder::fourth, 4.0, 1e-7);
}

TEST(Rotation, KeepsWorldAngularMomentumToRounding) {
  Quat q = Quat::Identity();
  Vec3 spin(0.01, 10, 0);
  const Vec3 inverse = inertia.cwiseInverse();
  const Vec3 before = spin_momentum(q, spin, inverse);
  for (int k = 0; k < 10000; ++k) rotate_freely(q, spin, inverse, 1e-3);
  EXPECT_LT((spin_momentum(q, spin, inverse) - before).norm(), 1e-12 * before.norm());
  EXPECT_NEAR(q.norm(), 1.0, 1e-14);
}

TEST(Rotation, EqualMomentsKeepTheSpinBitForBit) {
  Quat q = Quat::Identity();
  Vec3 spin(3, -4, 5);
  const Vec3 inverse(7, 7, 7);
  for (int k = 0; k < 1000; ++k) rotate_freely(q, spin, inverse, 0.01);
  EXPECT_EQ(spin, Vec3(3, -4, 5));
  // The turn is that of 10 s at |spin| about a fixed axis.
  const Quat exact(Eigen::AngleAxisd(10 * spin.norm(), spin.normalized()));
  EXPECT_NEAR(std::abs(q.dot(exact)), 1.0, 1e-13);
}

TEST(Rotation, EnergyAndMomentumVanishForBodiesThatAreNotFree) {
  EXPECT_EQ(rotational_energy(Quat::Identity(), Vec3(1, 2, 3), Vec3::Zero()), 0.0);
  EXPECT_EQ(spin_momentum(Quat::Identity(), Vec3(1, 2, 3), Vec3::Zero()), Vec3(Vec3::Zero()));
}

TEST(Rotation, KeepsEnergyAndMomentumHoweverThinAndFast) {
  // Thin rods that tumble hardly spin at first, and spin a hundred times faster when their axis comes round.
  for (std::uint64_t item = 0; item < 50000; ++item) {
    Random random(29, item);
    const Vec3 half(random.uniform(0.02, 1), random.uniform(0.02, 1), random.uniform(0.02, 1));
    const Vec3 square = half.cwiseProduct(half);
    const Vec3 inverse = (Vec3::Constant(square.sum()) - square).cwiseInverse();
    Quat q = Quat(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1))
                 .normalized();
    const double size = std::pow(10.0, random.uniform(-3, 3));
    Vec3 spin = size * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    if (item % 3 == 0) spin = q * Vec3(size, 1e-4 * size, 1e-6 * size);
    if (item % 3 == 1) spin = q * Vec3(1e-5 * size, size, 1e-5 * size);
    const double energy = rotational_energy(q, spin, inverse);
    const Vec3 momentum = spin_momentum(q, spin, inverse);
    rotate_freely(q, spin, inverse, random.uniform(-0.01, 0.01));
    ASSERT_NEAR(rotational_energy(q, spin, inverse), energy, 1e-13 * energy) << item;
    // The largest measured change is 1.1e-13, where the moments differ the most.
    ASSERT_LT((spin_momentum(q, spin, inverse) - momentum).norm(), 2e-13 * momentum.norm()) << item;
  }
}

TEST(Rotation, ManySmallTurnsAreOneFarTurn) {
  // The body turns by 0.2 rad in turns about the mean spin, beside the splitting of fourth order.
  const double end = 0.05;
  const auto turn = [end](int steps) {
    struct State {
      Quat q{0.5, 0.1, -0.7, 0.2};
      Vec3 spin{1.5, 3.0, -2.0};
      double drift = 0;
    } state;
    state.q.normalize();
    for (int k = 0; k < steps; ++k) {
      state.drift +=
          rotate_freely(state.q, state.spin, inertia.cwiseInverse(), end / steps, RotationOrder::fourth);
    }
    return state;
  };
  const auto small = turn(200000);
  const auto far = turn(800);
  EXPECT_LT(small.q.angularDistance(far.q), 1e-12);  // measured: 9e-14
  EXPECT_LT((small.spin - far.spin).norm(), 2e-11);  // measured: 5e-12
  EXPECT_EQ(small.drift, 0.0);                       // no turn takes the splitting
  const double energy = rotational_energy(far.q, far.spin, inertia.cwiseInverse());
  EXPECT_NEAR(rotational_energy(small.q, small.spin, inertia.cwiseInverse()), energy, 1e-11 * energy);
}

}  // namespace
}  // namespace scree
