// Tests of the bodies that a scene makes, against closed forms and brute force.
#include "core/error.hpp"
#include "sim/scene/distribution.hpp"
#include "sim/scene/scatter.hpp"
#include "sim/scene/scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <numeric>
#include <string>
#include <tuple>

namespace scree {
namespace {

Scene scene_of(const std::string& bodies, const std::string& more = "") {
  return parse_scene(
      "format: 1\ntime: {end: 1, step: 0.1}\nmaterials:\n"
      "  glass: {density: 2500, restitution: 0.64, friction: 0.09, rolling_friction: 0.04}\n"
      "  steel: {density: 8000, restitution: 0.25, friction: 0.36, rolling_friction: 0.01}\n" +
          more + "bodies:\n" + bodies,
      "test.yaml");
}

TEST(SceneBodies, SphereHasTheInertiaOfASolidBall) {
  const Scene scene = scene_of("  - {sphere: {radius: 0.5}, material: glass}\n");
  const double mass = 2500 * 4.0 / 3.0 * pi * 0.125;
  EXPECT_NEAR(1 / scene.bodies.inverse_mass[0], mass, 1e-12 * mass);
  for (int k = 0; k < 3; ++k)
    EXPECT_NEAR(1 / scene.bodies.inverse_inertia[0][k], 0.4 * mass * 0.25, 1e-12 * mass);
  EXPECT_TRUE(has_equal_moments(scene.bodies.inverse_inertia[0]));
  EXPECT_EQ(scene.bodies.size[0].x(), 0.5);
}

TEST(SceneBodies, BoxHasTheInertiaOfACuboid) {
  const Scene scene = scene_of("  - {box: {size: [1, 2, 3]}, mass: 12, material: glass}\n");
  EXPECT_NEAR(1 / scene.bodies.inverse_mass[0], 12, 1e-12);
  EXPECT_EQ(scene.bodies.size[0], Vec3(0.5, 1, 1.5));
  const Vec3 inertia = scene.bodies.inverse_inertia[0].cwiseInverse();
  EXPECT_LT((inertia - Vec3(4 + 9, 9 + 1, 1 + 4)).norm(), 1e-12);  // m/12 (b^2 + c^2)
  const Scene dense =
      scene_of("  - {box: {size: [1, 2, 3]}, material: steel}\n  - {box: {size: 2}, material: glass}\n");
  EXPECT_NEAR(1 / dense.bodies.inverse_mass[0], 8000 * 6, 1e-8);
  EXPECT_NEAR(1 / dense.bodies.inverse_mass[1], 2500 * 8, 1e-8);
  EXPECT_TRUE(has_equal_moments(dense.bodies.inverse_inertia[1]));
}

TEST(SceneBodies, OnlyFreeBodiesHaveFiniteMass) {
  const Scene scene = scene_of(
      "  - {box: {size: 1}, fixed: true, material: glass}\n"
      "  - {box: {size: 1}, motion: {velocity: [1, 2, 3], spin: [0, 0, 4]}, material: glass}\n"
      "  - {box: {size: 1}, fixed: false, material: glass}\n");
  EXPECT_EQ(scene.bodies.mobility[0], Mobility::fixed);
  EXPECT_EQ(scene.bodies.mobility[1], Mobility::prescribed);
  EXPECT_EQ(scene.bodies.mobility[2], Mobility::free);
  for (int k = 0; k < 2; ++k) {
    EXPECT_EQ(scene.bodies.inverse_mass[k], 0);
    EXPECT_EQ(scene.bodies.inverse_inertia[k], Vec3(0, 0, 0));
  }
  EXPECT_GT(scene.bodies.inverse_mass[2], 0);
  ASSERT_EQ(scene.motions.size(), 1u);
  EXPECT_EQ(scene.motions[0].body, 1);
  EXPECT_EQ(scene.bodies.velocity[1], Vec3(1, 2, 3));
  EXPECT_EQ(scene.bodies.spin[1], Vec3(0, 0, 4));
}

TEST(SceneBodies, TubeHasItsRadiusAndHalfItsLength) {
  const Scene scene = scene_of(
      "  - {tube: {radius: 0.5, length: 0.3}, fixed: true, material: glass}\n"
      "  - {tube: {radius: 2, length: 8}, at: [9, 0, 0], motion: {spin: [0, 0, 1]}, material: glass}\n");
  EXPECT_EQ(scene.bodies.shape[0], Shape::tube);
  EXPECT_EQ(scene.bodies.mobility[0], Mobility::fixed);
  EXPECT_EQ(scene.bodies.size[0], Vec3(0.5, 0.5, 0.15));
  EXPECT_EQ(scene.bodies.mobility[1], Mobility::prescribed);
  EXPECT_EQ(scene.bodies.size[1], Vec3(2, 2, 4));
  EXPECT_EQ(scene.bodies.inverse_mass[1], 0);
}

TEST(SceneBodies, PlaneTurnsZToItsUnitNormal) {
  for (const Vec3& normal : {Vec3(0, 0, 1), Vec3(0, 0, -3), Vec3(3, 4, 0), Vec3(-1, 2, -5)}) {
    const Scene scene =
        scene_of("  - {plane: {normal: [" + std::to_string(normal.x()) + ", " + std::to_string(normal.y()) +
                 ", " + std::to_string(normal.z()) + "], offset: 2}, material: glass}\n");
    const Vec3 unit = normal.normalized();
    EXPECT_LT((scene.bodies.position[0] - 2 * unit).norm(), 1e-15);
    EXPECT_LT((scene.bodies.orientation[0] * Vec3::UnitZ() - unit).norm(), 1e-15);
    EXPECT_NEAR(scene.bodies.orientation[0].norm(), 1, 1e-15);
    EXPECT_EQ(scene.bodies.mobility[0], Mobility::fixed);
  }
}

TEST(SceneBodies, OrientationsAreUnitAndTurnByTheRightHand) {
  const Scene scene = scene_of(
      "  - {box: {size: 1}, rotate: {axis: [0, 0, 9], degrees: 90}, material: glass}\n"
      "  - {box: {size: 1}, rotate: {axis: [2, 0, 0], radians: 0.5}, material: glass}\n"
      "  - {box: {size: 1}, orientation: [1e200, 0, 0, 1e200], material: glass}\n");
  EXPECT_LT((scene.bodies.orientation[0] * Vec3::UnitX() - Vec3::UnitY()).norm(), 1e-15);
  EXPECT_LT((scene.bodies.orientation[1] * Vec3::UnitY() - Vec3(0, std::cos(0.5), std::sin(0.5))).norm(),
            1e-15);
  EXPECT_LT((scene.bodies.orientation[2] * Vec3::UnitX() - Vec3::UnitY()).norm(), 1e-15);
}

TEST(SceneBodies, RepeatRunsXFastest) {
  const Scene scene = scene_of(
      "  - {sphere: {radius: 0.1}, material: steel}\n"
      "  - {sphere: {radius: 0.1}, name: b, at: [10, 0, 0], material: glass,\n"
      "     repeat: {count: [2, 3, 4], spacing: [1, 2, 3]}}\n");
  ASSERT_EQ(scene.bodies.count(), 25);
  int k = 0;
  for (int z = 0; z < 4; ++z)
    for (int y = 0; y < 3; ++y)
      for (int x = 0; x < 2; ++x, ++k) {
        const std::int32_t id = scene.body_names.at("b[" + std::to_string(k) + "]");
        EXPECT_EQ(id, 1 + k);
        EXPECT_EQ(scene.bodies.id[static_cast<std::size_t>(id)], BodyNumber{id});
        EXPECT_EQ(scene.bodies.position[static_cast<std::size_t>(id)], Vec3(10 + x, 2 * y, 3 * z));
        EXPECT_EQ(scene.bodies.material[static_cast<std::size_t>(id)], 0);
      }
  EXPECT_EQ(scene.body_names.size(), 24u);
  EXPECT_EQ(scene.bodies.material[0], 1);
}

TEST(SceneBodies, JitterStaysInItsBoxAndFillsIt) {
  const Scene scene = scene_of(
      "  - {sphere: {radius: 0.1}, material: glass, repeat: {count: [10, 10, 10], spacing: [0, 0, 0], "
      "jitter: 0.5}}\n");
  Vec3 low = Vec3::Constant(1), high = Vec3::Constant(-1);
  for (const Vec3& at : scene.bodies.position) {
    low = low.cwiseMin(at);
    high = high.cwiseMax(at);
  }
  EXPECT_GE(low.minCoeff(), -0.5);
  EXPECT_LE(high.maxCoeff(), 0.5);
  EXPECT_LT(low.maxCoeff(), -0.48);
  EXPECT_GT(high.minCoeff(), 0.48);
}

// Random choices depend only on the seed and on the body's number.
TEST(SceneBodies, DrawsDoNotDependOnOtherBodies) {
  const std::string drawn =
      "  - {sphere: {radius: {uniform: [0.1, 0.2]}}, material: glass, "
      "repeat: {count: [5, 1, 1], spacing: [1, 0, 0], jitter: 0.1}}\n";
  const Scene a = scene_of("  - {sphere: {radius: 0.1}, material: glass}\n" + drawn);
  const Scene b = scene_of("  - {box: {size: {choose: [1, 2]}}, material: steel}\n" + drawn);
  const Scene c = scene_of("  - {sphere: {radius: 0.1}, material: glass}\n" + drawn, "seed: 1\n");
  for (std::size_t k = 1; k < 6; ++k) {
    EXPECT_EQ(a.bodies.position[k], b.bodies.position[k]);
    EXPECT_EQ(a.bodies.size[k], b.bodies.size[k]);
    EXPECT_NE(a.bodies.position[k], c.bodies.position[k]);
    EXPECT_NE(a.bodies.size[k], c.bodies.size[k]);
  }
}

/// Compares the mean radius of 40,000 bodies with `mean`; `deviation` is the standard deviation of one
/// radius.
void expect_mean(const std::string& radius, double mean, double deviation) {
  const Scene scene = scene_of("  - {sphere: {radius: " + radius +
                               "}, material: glass, repeat: {count: [40000, 1, 1], spacing: [9, 0, 0]}}\n");
  double sum = 0;
  for (const Vec3& size : scene.bodies.size) sum += size.x();
  // The seed is fixed; 4 standard errors leave room for an unlucky one.
  EXPECT_NEAR(sum / 40000, mean, 4 * deviation / std::sqrt(40000)) << radius;
}

TEST(SceneBodies, DistributionsHaveTheirMeans) {
  expect_mean("{uniform: [1, 3]}", 2, std::sqrt(4.0 / 12));
  expect_mean("{choose: [1, 2, 6]}", 3, std::sqrt(14.0 / 3));
  // The moments of x^-q on [a, b] have a closed form: E x^n is the ratio of the integrals of x^(n-q) and
  // x^-q.
  for (const double q : {0.0, 1.0, 2.5, 3.5, -2.0}) {
    const double a = 1, b = 5;
    const auto integral = [&](double power) {
      return power == -1 ? std::log(b / a) : (std::pow(b, power + 1) - std::pow(a, power + 1)) / (power + 1);
    };
    const double mean = integral(1 - q) / integral(-q);
    const double square = integral(2 - q) / integral(-q);
    expect_mean("{powerlaw: [1, 5, " + std::to_string(q) + "]}", mean, std::sqrt(square - mean * mean));
  }
}

TEST(SceneBodies, PowerlawQuantileInvertsItsDistribution) {
  const long double a = 0.01L, b = 10;
  for (const double q : {-50.0, -1.0, 0.0, 0.999999999, 1.0, 1.000000001, 3.0, 80.0})
    for (const double u : {0.0, 1e-9, 0.25, 0.5, 0.999}) {
      const double x = powerlaw_quantile(static_cast<double>(a), static_cast<double>(b), q, u);
      ASSERT_GE(x, 0.01);
      ASSERT_LE(x, 10);
      const long double s = 1 - static_cast<long double>(q);
      const long double share = s == 0 ? std::log(x / a) / std::log(b / a)
                                       : std::expm1(s * std::log(x / a)) / std::expm1(s * std::log(b / a));
      // Where the law is steep, a rounding error of x changes its share by s times as much.
      EXPECT_NEAR(static_cast<double>(share), u, 1e-13 * (1 + std::abs(static_cast<double>(s)))) << q;
    }
  EXPECT_TRUE(std::isfinite(powerlaw_quantile(1e-9, 1e9, 1000, 0.5)));
  EXPECT_TRUE(std::isfinite(powerlaw_quantile(1e-9, 1e9, -1000, 0.5)));
}

// Brute force over all pairs states independently what scatter promises.
TEST(SceneBodies, ScatteredBodiesKeepClear) {
  const Scene scene = scene_of(
      "  - {plane: {normal: [0, 1, 4], offset: 0.3}, material: glass}\n"
      "  - {sphere: {radius: 0.3}, at: [0.5, 0.5, 1], material: glass}\n"
      "  - {box: {size: [3, 0.1, 0.5]}, at: [0.5, 1, 1.4], rotate: {axis: [1, 2, 3], radians: 1}, fixed: "
      "true, "
      "material: glass}\n"
      "  - {sphere: {radius: {powerlaw: [0.01, 0.1, 3]}}, material: glass, "
      "scatter: {count: 1500, from: [0, 0, 0], to: [1, 2, 2]}}\n"
      "  - {box: {size: {uniform: [0.02, 0.1]}}, material: steel, name: box, "
      "scatter: {count: 300, from: [0, 0, 0], to: [1, 2, 2]}}\n");
  const BodyTable& bodies = scene.bodies;
  ASSERT_EQ(bodies.count(), 1803);
  for (std::size_t i = 3; i < 1803; ++i) {
    const double reach = bounding_radius(bodies.shape[i], bodies.size[i]);
    const Vec3& at = bodies.position[i];
    ASSERT_TRUE((at.array() >= 0).all() && (at.array() <= Eigen::Array3d(1, 2, 2)).all());
    ASSERT_NEAR(bodies.orientation[i].norm(), 1, 1e-14);
    EXPECT_GE((at - bodies.position[0]).dot(Vec3(0, 1, 4).normalized()), reach - 1e-12);
    EXPECT_GE((at - bodies.position[1]).norm(), reach + 0.3 - 1e-12);
    // The distance to the box is that to its nearest point, found by clamping in the box's own frame.
    const Vec3 local = bodies.orientation[2].inverse() * (at - bodies.position[2]);
    const Vec3 nearest = local.cwiseMax(-bodies.size[2]).cwiseMin(bodies.size[2]);
    EXPECT_GE((local - nearest).norm(), reach - 1e-12);
    for (std::size_t j = 3; j < i; ++j) {
      // Of two boxes, the sphere around the later one is clear of the earlier box itself, and so of the
      // largest sphere inside that.
      const double other = bounding_radius(bodies.shape[j], bodies.size[j]);
      const bool boxes = bodies.shape[i] == Shape::box && bodies.shape[j] == Shape::box;
      const double clearance =
          boxes ? std::min(reach + bodies.size[j].minCoeff(), other + bodies.size[i].minCoeff())
                : reach + other;
      ASSERT_GE((at - bodies.position[j]).norm(), clearance - 1e-12) << i << " " << j;
    }
  }
  EXPECT_EQ(scene.body_names.at("box[299]"), 1802);
}

TEST(SceneBodies, ScatterTakesFlatAndThinRegions) {
  for (const char* to : {"[300, 300, 0]", "[3000, 0, 0]", "[3000, 0.001, 0.001]", "[100, 100, 1e-6]"}) {
    const Scene scene = scene_of(
        std::string(
            "  - {sphere: {radius: 0.5}, material: glass, scatter: {count: 1000, from: [0, 0, 0], to: ") +
        to + "}}\n");
    for (std::size_t i = 0; i < 1000; ++i)
      for (std::size_t j = 0; j < i; ++j)
        ASSERT_GE((scene.bodies.position[i] - scene.bodies.position[j]).norm(), 1 - 1e-12) << to;
  }
}

// Cells of such regions are too small for their inverses, and such obstacles are too far away for differences
// of coordinates.
TEST(SceneBodies, ScatterTakesRegionsAndObstaclesAtTheEndsOfNumbers) {
  const Scene scene = scene_of(
      "  - {sphere: {radius: 1e308}, at: [1.7e308, 0, 0], fixed: true, material: glass}\n"
      "  - {sphere: {radius: 1}, scatter: {count: 1, from: [-1e308, 0, 0], to: [-1e308, 5e-324, 0]}, "
      "material: glass}\n");
  EXPECT_EQ(scene.bodies.position[1].x(), -1e308);
}

// The bounds of a thousand obstacles reach over all cells: a list of them for each cell would have 600,000
// entries.
TEST(SceneBodies, ScatterKeepsClearOfAThousandObstaclesInOnePlace) {
  const Scene scene = scene_of(
      "  - {box: {size: 100}, fixed: true, repeat: {count: [1000, 1, 1], spacing: [0, 0, 0]}, material: "
      "glass}\n"
      "  - {sphere: {radius: 0.5}, scatter: {count: 300, from: [40, -20, -20], to: [80, 20, 20]}, "
      "material: glass}\n");
  for (std::size_t b = 1000; b < 1300; ++b)
    EXPECT_GE(distance_to(scene.bodies, 0, scene.bodies.position[b]), 0.5);
}

TEST(SceneBodies, RandomOrientationsAreUniform) {
  const Scene scene = scene_of(
      "  - {sphere: {radius: 0.001}, material: glass, scatter: {count: 20000, from: [0, 0, 0], to: [9, 9, "
      "9]}}\n");
  Mat3 mean = Mat3::Zero();
  double angle = 0;
  for (const Quat& q : scene.bodies.orientation) {
    mean += q.toRotationMatrix() / 20000;
    angle += Eigen::AngleAxisd(q).angle() / 20000;
  }
  // The entries of a random rotation have mean 0 and variance 1/3; its angle has mean pi/2 + 2/pi.
  EXPECT_LT(mean.cwiseAbs().maxCoeff(), 5 * std::sqrt(1.0 / 3 / 20000));
  EXPECT_NEAR(angle, pi / 2 + 2 / pi, 0.02);
}

TEST(SceneBodies, LawsAreGeometricMeansUnlessListed) {
  const std::string body = "  - {sphere: {radius: 1}, material: glass}\n";
  const Scene scene = scene_of(body);
  EXPECT_NEAR(scene.law(0, 0).friction, 0.09, 1e-15);
  EXPECT_NEAR(scene.law(0, 1).friction, 0.18, 1e-15);
  EXPECT_NEAR(scene.law(1, 0).restitution, 0.4, 1e-15);
  EXPECT_NEAR(scene.law(1, 1).restitution, 0.25, 1e-15);
  EXPECT_NEAR(scene.law(0, 1).rolling_friction, 0.02, 1e-15);
  const Scene rolling = scene_of(body, "contacts: [{between: [steel, glass], rolling_friction: 0.3}]\n");
  EXPECT_EQ(rolling.law(1, 0).rolling_friction, 0.3);
  EXPECT_NEAR(rolling.law(1, 0).friction, 0.18, 1e-15);
  const Scene listed = scene_of(body, "contacts: [{between: [steel, glass], friction: 0.7}]\n");
  EXPECT_NEAR(listed.law(0, 1).rolling_friction, 0.02, 1e-15);
  EXPECT_EQ(listed.law(0, 1).friction, 0.7);
  EXPECT_EQ(listed.law(1, 0).friction, 0.7);
  EXPECT_NEAR(listed.law(0, 1).restitution, 0.4, 1e-15);
  EXPECT_NEAR(listed.law(0, 0).friction, 0.09, 1e-15);
}

TEST(SceneBodies, AliasesAreExpanded) {
  const Scene scene =
      scene_of("  - {sphere: &ball {radius: 2}, material: glass}\n  - {sphere: *ball, material: steel}\n");
  EXPECT_EQ(scene.bodies.size[1].x(), 2);
}

TEST(SceneBodies, ForcesFindTheirBodies) {
  const Scene scene = scene_of(
      "  - {sphere: {radius: 0.1}, name: a, at: [9, 0, 0], material: glass}\n"
      "  - {sphere: {radius: 0.1}, name: b, material: glass, repeat: {count: [3, 1, 1], spacing: [1, 0, "
      "0]}}\n",
      "forces:\n  - {on: a, force: [1, 2, 3]}\n  - {on: b, torque: [0, 0, 4], from: 0.2, until: 0.5}\n"
      "  - {on: \"b[1]\", force: [0, 0, 1], until: 5}\n");
  ASSERT_EQ(scene.forces.size(), 3u);
  const auto& [a, b, b1] = std::tie(scene.forces[0], scene.forces[1], scene.forces[2]);
  EXPECT_EQ(a.on.first, 0);
  EXPECT_EQ(a.on.count, 1);
  EXPECT_EQ(a.force, Vec3(1, 2, 3));
  EXPECT_EQ(a.torque, Vec3(0, 0, 0));
  EXPECT_EQ(a.during.from, 0);
  EXPECT_EQ(a.during.until, HUGE_VAL);
  EXPECT_EQ(b.on.first, 1);
  EXPECT_EQ(b.on.count, 3);
  EXPECT_EQ(b.torque, Vec3(0, 0, 4));
  EXPECT_EQ(b.during.from, 0.2);
  EXPECT_EQ(b.during.until, 0.5);
  EXPECT_EQ(b1.on.first, 2);
  EXPECT_EQ(b1.on.count, 1);
}

TEST(SceneBodies, ScatterStaysInsideATube) {
  BodyTable bodies;
  for_each_field([](const char*, auto& field) { field.resize(201); }, bodies);
  bodies.shape[0] = Shape::tube;
  bodies.mobility[0] = Mobility::fixed;
  bodies.size[0] = Vec3(0.5, 0.5, 1);
  bodies.position[0] = Vec3(3, 0, 0);
  bodies.orientation[0] = Quat(Eigen::AngleAxisd(pi / 2, Vec3::UnitY()));  // the tube is along x
  for (std::size_t k = 1; k <= 200; ++k) {
    bodies.shape[k] = Shape::sphere;
    bodies.orientation[k] = Quat::Identity();
    bodies.size[k] = Vec3(0.05, 0, 0);
  }
  std::vector<std::int32_t> balls(200);
  std::iota(balls.begin(), balls.end(), 1);
  ASSERT_EQ(
      scatter(bodies, balls, {.from = Vec3(2.2, -0.5, -0.5), .to = Vec3(3.8, 0.5, 0.5), .seed = 7}, {0}),
      200);
  for (std::size_t k = 1; k <= 200; ++k) {
    const Vec3 x = bodies.position[k];
    EXPECT_LE(std::hypot(x.y(), x.z()), 0.45 + 1e-12);
    EXPECT_LE(std::abs(x.x() - 3), 0.95 + 1e-12);
  }
}

TEST(SceneBodies, ScatterPassesATubeThatIsElsewhere) {
  const auto beside = [](const std::string& tube) {
    return scene_of("  - {tube: {radius: 1, length: 4}, fixed: true, material: glass, " + tube +
                    "}\n  - {sphere: {radius: 0.1}, material: glass, scatter: {count: 50, from: [1, -1, -1], "
                    "to: [3, 1, 1]}}\n");
  };
  EXPECT_EQ(beside("at: [-0.001, 0, 0]").bodies.position.size(), 51U);
  EXPECT_EQ(beside("at: [-1.5, 0, 0], rotate: {axis: [0, 1, 0], degrees: 30}").bodies.position.size(), 51U);
  const Scene held = beside("at: [-0.5, 0, 0], rotate: {axis: [0, 1, 0], degrees: 90}");
  for (std::size_t k = 1; k < held.bodies.position.size(); ++k)
    EXPECT_LE(held.bodies.position[k].x(), 1.4 + 1e-12);
}

// These are a fifth of the 100,000 items that may take 15 s, since sanitizers need five times as long.
TEST(SceneBodies, TwentyThousandItemsLoadInFifteenSeconds) {
  std::string bodies;
  for (int k = 0; k < 20000; ++k)
    bodies += "  - {sphere: {radius: 0.05}, name: b" + std::to_string(k) + ", at: [" + std::to_string(k) +
              ", 0, 0.5], velocity: [1, 0, 0], material: glass}\n";
  const std::clock_t start = std::clock();
  EXPECT_EQ(scene_of(bodies).bodies.count(), 20000);
  EXPECT_LT(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC, 15);
}

}  // namespace
}  // namespace scree
