// Tests of Anderson's acceleration, against the number of steps that theory gives for linear iterations.
#include "sim/response/anderson.hpp"

#include "core/rng.hpp"

#include <Eigen/QR>
#include <gtest/gtest.h>

#include <cmath>

namespace scree {
namespace {

using Vector = AndersonAcceleration::Vector;
using Matrix = Eigen::MatrixXd;

Matrix random_rotation(Random& random, Eigen::Index rows) {
  Matrix a(rows, rows);
  for (double& value : a.reshaped()) value = random.uniform(-1, 1);
  return a.householderQr().householderQ();
}

/// Returns how many steps an iteration takes until it moves by less than `tolerance`, and at most 1000.
template <class Map>
int number_of_steps(const Map& map, const Vector& start, const Vector& weights, double tolerance) {
  AndersonAcceleration acceleration;
  Vector x = start;
  for (int step = 1; step < 1000; ++step) {
    const Vector image = map(x);
    if (!((image - x).norm() > tolerance)) return step;
    x = acceleration.next(x, image, weights);
  }
  return 1000;
}

TEST(Anderson, EndsALinearIterationInAStepForEachOfItsRates) {
  for (std::uint64_t item = 0; item < 100; ++item) {
    Random random(41, item);
    constexpr Eigen::Index rows = 30;
    const int rates = 1 + static_cast<int>(random.uniform(0, 6));
    // Rates near 1, at which the iteration alone takes thousands of steps, and beyond -1, at which it
    // diverges.
    Vector rate = Vector::Zero(rows);
    for (Eigen::Index k = 0; k < rates; ++k)
      rate[k] = random.uniform(0, 1) < 0.3 ? -1.5 - 0.1 * k : 0.99 - 0.1 * k;
    const Matrix q = random_rotation(random, rows);
    const Vector end = Vector::Ones(rows);
    const auto map = [&](const Vector& x) -> Vector {
      return end + q * (rate.asDiagonal() * (q.transpose() * (x - end)));
    };
    Vector weights(rows);
    for (double& weight : weights) weight = random.uniform(0.5, 2);
    EXPECT_LE(number_of_steps(map, Vector::Zero(rows), weights, 1e-7), rates + 4) << item;
  }
}

TEST(Anderson, EndsAnIterationOfOneNumberLikeTheSecantMethod) {
  const auto map = [](const Vector& x) -> Vector { return x.array().cos(); };
  EXPECT_LE(number_of_steps(map, Vector::Zero(1), Vector::Ones(1), 1e-15), 9);  // 88 steps alone
}

TEST(Anderson, IsTheSameInOtherUnits) {
  const auto map = [](const Vector& x) -> Vector {
    return (0.9 * x.array()).sin() + 0.3 * x.array().reverse();
  };
  AndersonAcceleration here, there;
  Vector x(3), weights(3);
  x << 1, 2, 3;
  weights << 1, 0.5, 0;
  for (int step = 0; step < 12; ++step) {
    const Vector image = map(x);
    const Vector next = here.next(x, image, weights);
    EXPECT_EQ(there.next(8 * x, 8 * image, 2 * weights), 8 * next) << step;
    x = next;
  }
}

TEST(Anderson, TakesTheImageWhereNothingTells) {
  AndersonAcceleration acceleration;
  const Vector x = Vector::Constant(2, 3.0), image = Vector::Constant(2, 5.0);
  EXPECT_EQ(acceleration.next(x, image, Vector::Ones(2)), image);  // the first step
  EXPECT_EQ(acceleration.next(x, image, Vector::Ones(2)), image);  // the same step again
  EXPECT_EQ(acceleration.next(image, x, Vector::Zero(2)), x);      // no row has weight
  acceleration.forget();
  EXPECT_EQ(acceleration.next(image, 2 * image, Vector::Ones(2)), 2 * image);
}

}  // namespace
}  // namespace scree
