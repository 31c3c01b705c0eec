// Tests that a flat floor of several bodies is flat: bodies that slide over its seams do not feel them. And
// thin bodies, and bodies that may not turn, rest and slide as they should.
#include "tests/sim/ways.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <string>

namespace scree {
namespace {

/// A body that slides over the seam of a floor.
struct Crossing {
  const char* shape = "box";    ///< shape of the mover
  const char* floor = "fixed";  ///< kind of the two tiles: fixed, moving, free or mesh
  double size = 1;              ///< width of a tile (m); the half extent of the mover is a tenth of it
  double speed = 3;             ///< speed of the mover for a tile of 1 m (m/s)
  double step = 0.002;          ///< length of a step for a tile of 1 m (s)
  double restitution = 0;
  double gap = 0;            ///< gap between the tiles (share of the size)
  double up = 0;             ///< height of the second tile's top over the first (share of the size)
  bool mover_first = false;  ///< whether the mover comes first among the bodies
  double thickness = 0.5;    ///< thickness of the tiles (share of the size)
  double y = 0.05;           ///< place of the mover along the seam (share of the size)

  double true_speed() const { return speed * std::sqrt(size); }
  double duration() const { return 0.6 * size / true_speed(); }
};

std::string mover(const Crossing& c) {
  const double s = 0.1 * c.size;
  const std::string shape = c.shape;
  const std::string at = fmt::format("name: mover, at: [{}, {}, {}], velocity: [{}, 0, 0], material: m}}\n",
                                     -0.3 * c.size, c.y * c.size, s, c.true_speed());
  if (shape == "box") return fmt::format("  - {{box: {{size: {}}}, {}", 2 * s, at);
  if (shape == "sphere") return fmt::format("  - {{sphere: {{radius: {}}}, {}", s, at);
  if (shape == "cylinder") return fmt::format("  - {{cylinder: {{radius: {}, length: {}}}, {}", s, 2 * s, at);
  if (shape == "capsule")
    return fmt::format(
        "  - {{capsule: {{radius: {}, length: {}}}, rotate: {{axis: [1, 0, 0], degrees: 90}}, {}", s, s, at);
  std::string points;
  for (int k = 0; k < 8; ++k)
    points += fmt::format("{}[{}, {}, {}]", k ? ", " : "", k & 1 ? s : -s, k & 2 ? s : -s, k & 4 ? s : -s);
  return fmt::format("  - {{polyhedron: {{points: [{}]}}, {}", points, at);
}

/// Writes a mesh of 6 x 6 squares of two triangles each.
void write_grid(const std::string& file, double size) {
  constexpr int squares = 6;
  std::ofstream out(file);
  for (int i = 0; i <= squares; ++i)
    for (int j = 0; j <= squares; ++j)
      out << fmt::format("v {} {} 0\n", size * (i - 0.5 * squares) / squares,
                         size * (j - 0.5 * squares) / squares);
  for (int i = 0; i < squares; ++i) {
    for (int j = 0; j < squares; ++j) {
      const int k = i * (squares + 1) + j + 1, next = k + squares + 1;
      out << fmt::format("f {0} {1} {2}\nf {0} {2} {3}\n", k, next, next + 1, k + 1);
    }
  }
}

std::string tile(const Crossing& c, double x, double top) {
  const std::string floor = c.floor;
  if (floor == "mesh") {
    const std::string file = fmt::format("{}/seam_{}.obj", testing::TempDir(), c.size);
    write_grid(file, c.size);
    return fmt::format("  - {{mesh: {{file: {}}}, at: [{}, 0, {}], fixed: true, material: m}}\n", file, x,
                       top);
  }
  const char* how = floor == "fixed"    ? ", fixed: true"
                    : floor == "moving" ? ", motion: {velocity: [0, 0.02, 0]}"
                                        : "";
  return fmt::format("  - {{box: {{size: [{0}, {0}, {1}]}}, at: [{2}, 0, {3}]{4}, material: m}}\n", c.size,
                     c.thickness * c.size, x, top - 0.5 * c.thickness * c.size, how);
}

std::string scene_of_crossing(const Crossing& c) {
  const double h = 0.5 * c.size;
  std::string tiles = tile(c, -h, 0) + tile(c, h + c.gap * c.size, c.up * c.size);
  if (std::string(c.floor) == "free")
    tiles +=
        fmt::format("  - {{plane: {{normal: [0, 0, 1], offset: {}}}, material: m}}\n", -c.thickness * c.size);
  return fmt::format(
      "gravity: [0, 0, -9.81]\ntime: {{end: {}, step: {}}}\nmaterials: {{m: {{restitution: "
      "{}}}}}\nbodies:\n{}",
      c.duration(), c.step * std::sqrt(c.size), c.restitution,
      c.mover_first ? mover(c) + tiles : tiles + mover(c));
}

struct Crossed {
  double speed_lost = 0;  ///< share of the speed
  double rise = 0;        ///< largest deviation from the height at the start (share of the size)
};

Crossed cross(Simulation run, const Crossing& c) {
  const Scene scene = scene_of("time: {end: 1, step: 1}\n" +
                               scene_of_crossing(c).substr(scene_of_crossing(c).find("materials")));
  const std::int32_t body = scene.body_names.at("mover");
  const double height = run.body(body).position.z();
  Crossed crossed;
  while (!run.finished()) {
    run.step();
    crossed.rise = std::max(crossed.rise, std::abs(run.body(body).position.z() - height) / c.size);
  }
  crossed.speed_lost = std::abs(run.body(body).velocity.x() / c.true_speed() - 1);
  return crossed;
}

/// A body that falls flat onto the seams of a floor.
struct Drop {
  const char* shape = "box";
  const char* floor = "two";  ///< two or four boxes, moving boxes, a mesh; or one box
  double size = 1;            ///< width of a tile (m); the half extent of the body is a tenth of it
  double restitution = 0.5;
  double x = 0.03, y = 0.02;  ///< place of the body (share of the size)
  double friction = 0;

  double duration() const { return 0.75 * std::sqrt(size); }
};

std::string scene_of_drop(const Drop& d) {
  const std::string name = d.floor;
  std::string floor;
  if (name == "one") {
    floor = tile({.size = 4 * d.size}, 0, 0);
  } else if (name == "mesh") {
    floor = tile({.floor = "mesh", .size = d.size}, 0, 0);
  } else if (name == "four") {
    for (const double x : {-0.5, 0.5})
      for (const double y : {-0.5, 0.5})
        floor += fmt::format("  - {{box: {{size: {0}}}, at: [{1}, {2}, {3}], fixed: true, material: m}}\n",
                             d.size, x * d.size, y * d.size, -0.5 * d.size);
  } else {
    const char* how = name == "moving" ? "moving" : "fixed";
    floor = tile({.floor = how, .size = d.size}, -0.5 * d.size, 0) +
            tile({.floor = how, .size = d.size}, 0.5 * d.size, 0);
  }
  const double s = 0.1 * d.size;
  const std::string body =
      std::string(d.shape) == "box" ? fmt::format("box: {{size: [{}, {}, {}]}}", 2 * s, 1.6 * s, 2 * s)
      : std::string(d.shape) == "cylinder"
          ? fmt::format("cylinder: {{radius: {}, length: {}}}", s, 2 * s)
          : fmt::format(
                "polyhedron: {{points: [[{0}, 0, {1}], [{2}, {0}, {1}], [{2}, {2}, {1}], "
                "[0, 0, {0}]]}}",
                2 * s, -s, -s);
  return fmt::format(
      "gravity: [0, 0, -9.81]\ntime: {{end: {}, step: {}}}\nmaterials: {{m: {{restitution: {}, friction: "
      "{}}}}}\nbodies:\n{}  - {{{}, name: mover, at: [{}, {}, {}], material: m}}\n",
      d.duration(), 0.005 * std::sqrt(d.size), d.restitution, d.friction, floor, body, d.x * d.size,
      d.y * d.size, 3 * s);
}

/// The fastest spin of a dropped body, and its motion at the end, scaled to a tile of 1 m.
struct Dropped {
  double spin = 0;
  Vec3 velocity;
  double height = 0;
};

Dropped drop(Simulation run, const Drop& d) {
  const std::int32_t body = run.scene().body_names.at("mover");
  const double root = std::sqrt(d.size);
  Dropped dropped;
  while (!run.finished()) {
    run.step();
    dropped.spin = std::max(dropped.spin, run.body(body).spin.norm() * root);
  }
  dropped.velocity = run.body(body).velocity / root;
  dropped.height = run.body(body).position.z() / d.size;
  return dropped;
}

void expect_same(const Dropped& seam, const Dropped& one, double tolerance, const std::string& scene) {
  EXPECT_NEAR(seam.spin, one.spin, tolerance) << scene;
  EXPECT_LT((seam.velocity - one.velocity).norm(), tolerance) << scene;
  EXPECT_NEAR(seam.height, one.height, tolerance) << scene;
}

class Seams : public WayTest {
 protected:
  void expect_flat(const Crossing& c) const {
    const Crossed crossed = cross(simulate(scene_of_crossing(c)), c);
    const double rounding = is_mixed() ? 1e-5 : 1e-6;
    EXPECT_LT(crossed.speed_lost, rounding) << scene_of_crossing(c);
    EXPECT_LT(crossed.rise, rounding) << scene_of_crossing(c);
  }
};

TEST_P(Seams, AreNotFelt) {
  for (const char* shape : {"box", "sphere"})
    for (const char* floor : {"fixed", "moving", "free"})
      for (const double step : {1.0 / 60, 0.002})
        for (const double restitution : {0.0, 0.5, 1.0})
          expect_flat({.shape = shape, .floor = floor, .step = step, .restitution = restitution});
}

TEST_P(Seams, AreNotFeltAtAnySizeAndSpeed) {
  for (const double size : {1e-3, 1e3})
    for (const double speed : {0.1, 10.0})
      for (const bool first : {false, true})
        expect_flat({.size = size, .speed = speed, .step = 0.01, .mover_first = first});
}

TEST_P(Seams, AreNotFeltWhereTilesOverlapOrLieApartOrNotQuiteLevel) {
  expect_flat({.gap = 0.01});
  expect_flat({.gap = -0.05});
  expect_flat({.up = 1e-9});
  expect_flat({.up = -1e-9});
  expect_flat({.thickness = 0.004});
  expect_flat({.shape = "sphere", .gap = -0.3});
}

TEST_P(Seams, AreStruckAsOneFloor) {
  for (const char* floor : {"two", "four", "moving"}) {
    for (const double restitution : {0.3, 1.0}) {
      for (const double size : {1e-3, 1.0, 1e3}) {
        const Drop on_seam{.floor = floor, .size = size, .restitution = restitution};
        Drop on_one = on_seam;
        on_one.floor = "one";
        expect_same(drop(simulate(scene_of_drop(on_seam)), on_seam),
                    drop(simulate(scene_of_drop(on_one)), on_one), is_mixed() ? 1e-5 : 1e-7,
                    scene_of_drop(on_seam));
      }
    }
  }
}

TEST_P(Seams, AStepUpIsAWall) {
  for (const double up : {1e-4, 1e-2, 0.05}) {
    for (const double step : {1.0 / 60, 0.002}) {
      const Crossing c{.step = step, .up = up};
      EXPECT_GT(cross(simulate(scene_of_crossing(c)), c).speed_lost, 0.1) << up;
    }
  }
}

TEST_P(Seams, AStepDownIsAFall) {
  for (const double down : {1e-3, 0.02}) {
    const Crossing c{.up = -down};
    Simulation run = simulate(scene_of_crossing(c));
    while (run.time() < 0.3 / c.speed) run.step();
    EXPECT_NEAR(run.body(2).velocity.x(), c.speed, 1e-5 * c.speed);
    EXPECT_LT(run.body(2).position.z(), 0.1 + 1e-5);
  }
}

TEST_P(Seams, AThinPlateRests) {
  for (const double thickness : {1e-6, 1e-4, 4e-3}) {
    for (const double step : {1.0 / 30, 1.0 / 60}) {
      for (const double slope : {0.0, 0.5}) {
        Simulation run = simulate(fmt::format(
            "gravity: [{}, 0, {}]\ntime: {{end: 1, step: {}}}\nmaterials: {{m: {{friction: 0.6}}}}\nbodies:\n"
            "  - {{plane: {{normal: [0, 0, 1]}}, material: m}}\n"
            "  - {{box: {{size: [1, 1, {}]}}, mass: 4, at: [0, 0, {}], material: m}}\n",
            9.81 * slope, -9.81, step, thickness, 0.5 * thickness));
        double fastest = 0;
        while (!run.finished()) {
          run.step();
          fastest = std::max(fastest, run.body(1).velocity.norm());
        }
        EXPECT_LT(fastest, is_mixed() ? 1e-5 : 1e-9) << thickness << " at " << step;
        EXPECT_LT(std::abs(run.body(1).position.x()), is_mixed() ? 1e-5 : 1e-9);
      }
    }
  }
}

TEST_P(Seams, WithoutRotationABallSlides) {
  Simulation run = simulate(
      "gravity: [0, 0, -9.81]\ntime: {end: 2, step: 0.002}\nmaterials: {m: {friction: 0.5}}\nmodel: "
      "{rotation: off}\nbodies:\n"
      "  - {plane: {normal: [0, 0, 1]}, material: m}\n"
      "  - {sphere: {radius: 0.5}, at: [0, 0, 0.5], velocity: [5, 0, 0], spin: [0, 3, 0], material: m}\n"
      "  - {box: {size: [0.3, 0.2, 0.1]}, at: [0, 5, 0.5], rotate: {axis: [1, 2, 0], degrees: 20}, material: "
      "m}\n");
  while (!run.finished()) {
    run.step();
    for (const std::int32_t body : {1, 2}) ASSERT_EQ(run.body(body).spin.norm(), 0);
  }
  EXPECT_NEAR(run.body(1).position.x(), 5.0 * 5 / (2 * 0.5 * 9.81), 0.01);
  EXPECT_LT(run.observe().unexplained, is_mixed() ? 1e-5 : 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Ways, Seams, testing::ValuesIn(all_ways()), way_name);

/// Seams under general shapes and in meshes, on Host.
class GeneralSeams : public testing::TestWithParam<const char*> {};

TEST_P(GeneralSeams, AreNotFelt) {
  for (const char* shape : {"box", "sphere", "capsule", "cylinder", "polyhedron"}) {
    for (const char* floor : {"fixed", "mesh", "free"}) {
      for (const double restitution : {0.0, 0.5}) {
        const Crossing c{.shape = shape, .floor = floor, .step = 0.005, .restitution = restitution};
        const Crossed crossed = cross(
            simulation_of(scene_of_crossing(c) + fmt::format("response: {{mode: {}}}\n", GetParam())), c);
        EXPECT_LT(crossed.speed_lost, 1e-6) << scene_of_crossing(c);
        EXPECT_LT(crossed.rise, 1e-6) << scene_of_crossing(c);
      }
    }
  }
}

TEST_P(GeneralSeams, AreStruckAsOneFloor) {
  const auto dropped = [](Drop d, const char* floor) {
    d.floor = floor;
    return drop(simulation_of(scene_of_drop(d) + fmt::format("response: {{mode: {}}}\n", GetParam())), d);
  };
  for (const char* shape : {"box", "cylinder", "polyhedron"})
    for (const double restitution : {0.5, 1.0})
      for (const double friction : {0.0, 0.4})
        for (const double x : {0.03, 0.1}) {
          const Drop d{.shape = shape, .restitution = restitution, .x = x, .friction = friction};
          const Dropped on_one = dropped(d, "one");
          for (const char* floor : {"four", "mesh"})
            expect_same(dropped(d, floor), on_one, 1e-5,
                        "on " + std::string(floor) + ":\n" + scene_of_drop(d));
        }
}

/// The impulse of an impact on several walls is divided among them, and none of it is lost.
TEST_P(GeneralSeams, EachWallHasItsShareOfAnImpact) {
  const Drop d{.floor = "two", .restitution = 1};
  Simulation run = simulation_of(scene_of_drop(d) + fmt::format("response: {{mode: {}}}\n", GetParam()));
  const std::int32_t body = run.scene().body_names.at("mover");
  double change = 0, left = 0, right = 0;
  double before = 0;
  while (!run.finished()) {
    run.step();
    const double now = run.body(body).velocity.z();
    if (now > 0 && before < 0) {
      change = run.body(body).force.z();
      left = run.body(0).force.z();
      right = run.body(1).force.z();
      break;
    }
    before = now;
  }
  EXPECT_GT(change, 0);
  EXPECT_NEAR(left + right, -change, 1e-9 * change);
  EXPECT_LT(left, 0);
  EXPECT_LT(right, 0);
}

/// The sides of the sliding body lie along edges of the mesh.
TEST_P(GeneralSeams, AreNotFeltAlongThem) {
  for (const char* shape : {"box", "cylinder", "polyhedron"}) {
    for (const double y : {-0.1, 0.1, 1.0 / 6 - 0.1}) {
      for (const double restitution : {0.0, 1.0}) {
        const Crossing c{
            .shape = shape, .floor = "mesh", .step = 1.0 / 60, .restitution = restitution, .y = y};
        const Crossed crossed = cross(
            simulation_of(scene_of_crossing(c) + fmt::format("response: {{mode: {}}}\n", GetParam())), c);
        EXPECT_LT(crossed.speed_lost, 1e-6) << scene_of_crossing(c);
        EXPECT_LT(crossed.rise, 1e-6) << scene_of_crossing(c);
      }
    }
  }
}

TEST_P(GeneralSeams, WhatIsLargerThanAMeshRestsOnIt) {
  const std::string file = testing::TempDir() + "/small_plate.obj";
  write_grid(file, 0.2);
  for (const char* body :
       {"box: {size: 1}", "cylinder: {radius: 0.5, length: 1}",
        "polyhedron: {points: [[-1, -1, -0.5], [1, -1, -0.5], [0, 2, -0.5], [-1, -1, 0.5], [1, -1, 0.5], [0, "
        "2, 0.5]]}",
        "capsule: {radius: 0.5, length: 1}, rotate: {axis: [1, 0, 0], degrees: 90}"}) {
    for (const double x : {0.0, 0.05}) {
      Simulation run = simulation_of(fmt::format(
          "gravity: [0, 0, -9.81]\ntime: {{end: 0.5, step: 0.005}}\nmaterials: {{m: {{}}}}\nbodies:\n"
          "  - {{mesh: {{file: {}}}, fixed: true, material: m}}\n"
          "  - {{{}, name: body, at: [{}, 0, 0.5], material: m}}\nresponse: {{mode: {}}}\n",
          file, body, x, GetParam()));
      run_to_end(run);
      const BodyState state = run.body(run.scene().body_names.at("body"));
      EXPECT_NEAR(state.position.z(), 0.5, 1e-6) << body;
      EXPECT_LT(state.spin.norm(), 1e-6) << body;
    }
  }
}

/// The seam is that between a mesh and its own image, a period away.
TEST_P(GeneralSeams, APeriodHasNone) {
  const Crossing c;
  const Crossing floor{.floor = "mesh", .size = 3};
  Simulation run = simulation_of(
      "gravity: [0, 0, -9.81]\nperiodic: {x: [-1.5, 1.5]}\ntime: {end: 3, step: 0.005}\n"
      "materials: {m: {restitution: 0.5}}\nbodies:\n" +
      mover(c) + tile(floor, 0, 0) + fmt::format("response: {{mode: {}}}\n", GetParam()));
  run_to_end(run);
  EXPECT_NEAR(run.body(0).velocity.x(), c.speed, 1e-6);
  EXPECT_NEAR(run.body(0).position.z(), 0.1, 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Modes, GeneralSeams, testing::Values("default", "accurate"));

}  // namespace
}  // namespace scree
