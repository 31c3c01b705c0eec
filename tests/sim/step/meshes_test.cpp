// Tests of runs on meshes: a floor is flat however its corners were written, and supports carry what lies on
// them.
#include "core/rng.hpp"
#include "sim/scene/measure.hpp"
#include "tests/sim/step/simulations.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <unistd.h>
#include <vector>

namespace scree {
namespace {

using Triangle = std::array<Vec3, 3>;

double measured(Simulation& run, const char* name) {
  return evaluate(parse_measure(name, run.scene()), run.observe(),
                  [&run](std::int32_t id) { return run.body(id); });
}

class Meshes : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  /// Writes a mesh file and returns its name. Each triangle has corners of its own, each off by up to `noise`
  /// along each axis.
  std::string written(const std::vector<Triangle>& triangles, double noise) const {
    Random random(1, 0);
    const std::filesystem::path file = folder_ / "mesh.obj";
    std::ofstream stream(file);
    for (const Triangle& t : triangles) {
      for (const Vec3& c : t)
        stream << fmt::format("v {} {} {}\n", c.x() + random.uniform(-noise, noise),
                              c.y() + random.uniform(-noise, noise), c.z() + random.uniform(-noise, noise));
      stream << "f -3 -2 -1\n";
    }
    return file.string();
  }

 private:
  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("scree_meshes_test_" + std::to_string(::getpid()));
};

/// Returns a strip of 1 x 0.5 in two triangles, and beside it one in `parts` squares, whose corners lie on an
/// edge of the first.
std::vector<Triangle> strips(int parts, double size) {
  const auto at = [&](double x, double y) { return Vec3(size * x, size * y, 0); };
  std::vector<Triangle> all = {{at(0, 0), at(1, 0), at(1, 0.5)}, {at(0, 0), at(1, 0.5), at(0, 0.5)}};
  for (int k = 0; k < parts; ++k) {
    const double a = double(k) / parts, b = double(k + 1) / parts;
    all.push_back({at(a, 0.5), at(b, 0.5), at(b, 1)});
    all.push_back({at(a, 0.5), at(b, 1), at(a, 1)});
  }
  return all;
}

constexpr const char* laws = "materials: {m: {friction: 0, density: 1000}}\n";

TEST_F(Meshes, AFloorIsFlatHoweverItsCornersWereWritten) {
  for (const char* mode : {"default", "accurate"}) {
    for (const double size : {1e-3, 1.0, 1e3}) {
      for (const int parts : {1, 2, 6}) {
        for (const double noise : {0.0, 1e-14, 1e-10, 1e-7, 1e-5}) {
          SCOPED_TRACE(fmt::format("{}, size {}, {} parts, noise {}", mode, size, parts, noise));
          const double speed = 2.5 * std::sqrt(size), time = std::sqrt(size);
          const Scene scene = scene_of(fmt::format(
              R"(
gravity: [0, 0, -9.81]
time: {{end: {}, step: {}}}
response: {{mode: {}}}
{}bodies:
  - {{mesh: {{file: {}}}, fixed: true, material: m}}
  - {{sphere: {{radius: {}}}, name: ball, at: [{}, {}, {}], velocity: [{}, {}, 0], material: m}}
  - {{box: {{size: {}}}, name: box, at: [{}, {}, {}], velocity: [0, -{}, 0], material: m}}
)",
              0.3 * time, 0.005 * time, mode, laws, written(strips(parts, size), size * noise), 0.03 * size,
              0.05 * size, 0.1 * size, 0.03 * size, speed, speed, 0.06 * size, 0.75 * size, 0.9 * size,
              0.03 * size, speed));
          Simulation run(scene, one_thread);
          run_to_end(run);
          for (const auto& [name, expected] : {std::pair("ball", std::sqrt(2.0) * speed), {"box", speed}}) {
            const BodyState body = run.body(scene.body_names.at(name));
            EXPECT_NEAR(body.velocity.norm(), expected, (1e-6 + 3 * noise) * expected) << name;
            EXPECT_NEAR(body.position.z(), 0.03 * size, (1e-8 + 2 * noise) * size) << name;
          }
        }
      }
    }
  }
}

TEST_F(Meshes, SupportsCarryWhatLiesOnThem) {
  const std::string mesh = written(strips(3, 1), 0);
  const std::string supports[] = {"plane: {normal: [0, 0, 1], offset: 0}, name: it",
                                  "box: {size: [2, 2, 1]}, at: [0, 0, -0.5], fixed: true, name: it",
                                  "mesh: {file: " + mesh + "}, at: [-0.5, -0.25, 0], fixed: true, name: it"};
  for (const char* mode : {"default", "accurate"}) {
    for (const std::string& support : supports) {
      SCOPED_TRACE(support + ", " + mode);
      const Scene scene = scene_of(fmt::format(R"(
gravity: [0, 0, -9.81]
time: {{end: 0.5, step: 0.005}}
response: {{mode: {}}}
materials: {{m: {{friction: 0.5}}}}
bodies:
  - {{{}, material: m}}
  - {{box: {{size: 0.1}}, mass: 1, at: [0.2, 0.1, 0.05], material: m}}
  - {{sphere: {{radius: 0.05}}, mass: 3, at: [-0.2, 0, 0.05], material: m}}
)",
                                               mode, support));
      Simulation run(scene, one_thread);
      run_to_end(run);
      EXPECT_NEAR(measured(run, "it.force.z"), -4 * 9.81, 4e-6);
      EXPECT_NEAR(measured(run, "it.force.x"), 0, 1e-6);
      if (scene.meshes.empty()) continue;
      // The torques are about the `at` of the mesh: the two weights have these arms.
      EXPECT_NEAR(measured(run, "it.torque.x"), -9.81 * (1 * 0.35 + 3 * 0.25), 1e-5);
      EXPECT_NEAR(measured(run, "it.torque.y"), 9.81 * (1 * 0.7 + 3 * 0.3), 1e-5);
      EXPECT_NEAR(measured(run, "it.torque.z"), 0, 1e-5);
    }
  }
}

TEST_F(Meshes, ATubeCarriesWhatLiesInIt) {
  const Scene scene = scene_of(R"(
gravity: [0, 0, -9.81]
time: {end: 0.5, step: 0.005}
materials: {m: {friction: 0.5}}
bodies:
  - {tube: {radius: 0.5, length: 0.4}, name: it, at: [0, 0, 0.5], rotate: {axis: [1, 0, 0], degrees: 90}, fixed: true, material: m}
  - {sphere: {radius: 0.05}, mass: 3, at: [0, 0, 0.05], material: m}
)");
  Simulation run(scene, one_thread);
  run_to_end(run);
  EXPECT_NEAR(measured(run, "it.force.z"), -3 * 9.81, 3e-6);
}

}  // namespace
}  // namespace scree
