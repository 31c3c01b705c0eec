// Tests of the kernels that turn bodies: against the scalar law lane by lane, and against one another bit by
// bit.
#include "sim/laws/simd/simd.hpp"

#include "core/rng.hpp"
#include "sim/laws/rotation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>

namespace scree {
namespace {

constexpr double rounding = 1e-12;

Vec3 random_vector(Random& random, double size) {
  const double x = random.uniform(-size, size), y = random.uniform(-size, size);
  return Vec3(x, y, random.uniform(-size, size));
}

/// The boxes have all proportions and turn slowly and fast; two of them turn farther than one step of the
/// splitting.
TEST(Lanes, TurnsAsOneBodyAloneDoes) {
  constexpr int far[] = {2, 5};
  for (const bool fourth_order : {false, true}) {
    simd::RotatingBodies first{};
    for (const auto& [name, kernels] : simd::supported_kernels()) {
      for (std::uint64_t item = 0; item < 500; ++item) {
        Random random(31, item);
        simd::RotatingBodies bodies{};
        Quat orientation[simd::width];
        Vec3 spin[simd::width];
        Vec3 inverse_inertia[simd::width];
        const double dt = random.uniform(-0.01, 0.01);
        for (int l = 0; l < simd::width; ++l) {
          const Vec3 axis = random_vector(random, 1);
          orientation[l] = Quat(random.uniform(-1, 1), axis.x(), axis.y(), axis.z()).normalized();
          const double x = random.uniform(1, 2);
          inverse_inertia[l] = {x, x * random.uniform(0.5, 1), x * random.uniform(0.3, 0.5)};
          const bool is_far = std::ranges::find(far, l) != std::end(far);
          const double turn = is_far ? 3 : std::pow(10.0, random.uniform(-8, -1));
          spin[l] = (turn / std::abs(dt)) * random_vector(random, 1).normalized();
          const auto put = [l](simd::LaneVec& lanes, const Vec3& value) {
            lanes.x.at[l] = value.x();
            lanes.y.at[l] = value.y();
            lanes.z.at[l] = value.z();
          };
          bodies.w.at[l] = orientation[l].w();
          put(bodies.v, orientation[l].vec());
          put(bodies.spin, spin[l]);
          put(bodies.inverse_inertia, inverse_inertia[l]);
        }
        kernels->turn(bodies, dt, fourth_order);
        ASSERT_EQ(bodies.far, 1 << far[0] | 1 << far[1]) << name << item;
        for (int l = 0; l < simd::width; ++l) {
          const auto take = [l](const simd::LaneVec& lanes) {
            return Vec3(lanes.x.at[l], lanes.y.at[l], lanes.z.at[l]);
          };
          if ((bodies.far >> l & 1) == 0)
            rotate_freely(orientation[l], spin[l], inverse_inertia[l], dt,
                          fourth_order ? RotationOrder::fourth : RotationOrder::second);
          const double speed = spin[l].norm();
          ASSERT_LT((take(bodies.spin) - spin[l]).norm(), rounding * speed) << name << item;
          ASSERT_LT((take(bodies.v) - orientation[l].vec()).norm(), rounding) << name << item;
          ASSERT_NEAR(bodies.w.at[l], orientation[l].w(), rounding) << name << item;
          ASSERT_LT(std::abs(bodies.drift.at[l]), rounding * speed * speed / inverse_inertia[l].z());
        }
        if (item > 0) continue;
        if (name == simd::supported_kernels().front().name) first = bodies;
        EXPECT_EQ(std::memcmp(&first.spin, &bodies.spin, sizeof bodies.spin), 0) << name;
        EXPECT_EQ(std::memcmp(&first.v, &bodies.v, sizeof bodies.v), 0) << name;
      }
    }
  }
}

}  // namespace
}  // namespace scree
