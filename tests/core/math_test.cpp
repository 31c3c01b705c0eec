// Tests of rotations against long double, and of the tangent frame by its definition.
#include "core/math.hpp"

#include "core/rng.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace scree {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

Vec3 random_direction(std::uint64_t item) {
  Random random(17, item);
  const double z = random.uniform(-1, 1);
  const double angle = random.uniform(0, 2 * pi);
  const double r = std::sqrt(1 - z * z);
  return Vec3(r * std::cos(angle), r * std::sin(angle), z).normalized();
}

TEST(RotationOf, AgreesWithLongDouble) {
  using Vec3l = Eigen::Matrix<long double, 3, 1>;
  // The angles lie on either side of the switch to the series (a half angle of 1e-4), and go far beyond one
  // turn.
  for (const double angle :
       {1e-300, 1e-20, 1e-9, 1e-5, 1.99e-4, 2.01e-4, 1e-3, 0.1, 1.0, 3.0, pi, 6.0, 50.0}) {
    for (std::uint64_t item = 0; item < 50; ++item) {
      const Vec3 v = angle * random_direction(item);
      const Vec3l exact = v.cast<long double>();
      const long double norm = exact.norm();
      const Vec3l imaginary = std::sin(norm / 2) * exact / norm;
      const Quat q = rotation_of(v);
      // The rounding error of the angle itself grows with its size.
      const double bound = 4 * epsilon * std::max(1.0, angle);
      EXPECT_NEAR(q.w(), static_cast<double>(std::cos(norm / 2)), bound) << angle;
      for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(q.vec()[k], static_cast<double>(imaginary[k]), bound * std::min(1.0, angle)) << angle;
      }
      EXPECT_NEAR(q.norm(), 1.0, 4 * epsilon);
    }
  }
}

TEST(RotationOf, ZeroIsTheIdentity) {
  EXPECT_EQ(rotation_of(Vec3::Zero()).coeffs(), Quat::Identity().coeffs());
}

TEST(RotationOf, TurnsRightHanded) {
  const Vec3 turned = rotation_of(Vec3(0, 0, pi / 2)) * Vec3::UnitX();
  EXPECT_NEAR((turned - Vec3::UnitY()).norm(), 0.0, 4 * epsilon);
}

TEST(TangentOf, IsUnitAndAtRightAngles) {
  std::vector<Vec3> normals;
  for (int axis = 0; axis < 3; ++axis) {
    normals.push_back(Vec3::Unit(axis));
    normals.push_back(-Vec3::Unit(axis));
  }
  // These normals are close to the pole where the simpler formula of Frisvad (2012) breaks down, or on either
  // side of the equator.
  for (const double tilt : {1e-3, 1e-8, 1e-15}) {
    normals.push_back(Vec3(tilt, -tilt, -1).normalized());
    normals.push_back(Vec3(0.6, 0.8, tilt).normalized());
    normals.push_back(Vec3(0.6, 0.8, -tilt).normalized());
  }
  for (std::uint64_t item = 0; item < 10000; ++item) normals.push_back(random_direction(item));
  for (const Vec3& n : normals) {
    const Vec3 t = tangent_of(n);
    EXPECT_NEAR(t.dot(n), 0.0, 4 * epsilon) << n.transpose();
    EXPECT_NEAR(t.norm(), 1.0, 4 * epsilon) << n.transpose();
  }
}

TEST(RotatedDiagonal, HasItsEigenvectorsAlongTheTurnedAxes) {
  const Vec3 d(2, 3, 5);
  for (std::uint64_t item = 0; item < 100; ++item) {
    const Mat3 R = rotation_of(3 * random_direction(item)).toRotationMatrix();
    const Mat3 tensor = rotated_diagonal(R, d);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR((tensor * R.col(axis) - d[axis] * R.col(axis)).norm(), 0.0, 50 * epsilon);
    }
  }
}

}  // namespace
}  // namespace scree
