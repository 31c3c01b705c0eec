// What a run leaves is what the next one starts from, to the bit.
#include "sim/record/final_state.hpp"

#include "core/rng.hpp"
#include "tests/sim/record/temporary_folder.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace scree {
namespace {

Vec3 random_vector(Random& random) {
  const double x = random.uniform(-1, 1);
  const double y = random.uniform(-1, 1);
  return Vec3(x / 3, y * 1e-7, random.uniform(-1, 1) * 1e9);
}

TEST(FinalState, ComesBackToTheBit) {
  const TemporaryFolder folder;
  const std::string head =
      "format: 1\ntime: {end: 1, step: 0.1}\nmaterials: {glass: {density: 2500}, steel: {density: "
      "7850.5}}\nbodies:\n";
  Scene scene = parse_scene(head +
                                "  - {plane: {normal: [0, 0, 1]}, material: glass}\n"
                                "  - {box: {size: {uniform: [[0.1, 0.2, 0.3], [1, 2, 3]]}}, repeat: {count: "
                                "[50, 1, 1], spacing: [1, 0, 0]}, material: steel}\n"
                                "  - {sphere: {radius: {powerlaw: [0.01, 1, 3]}}, repeat: {count: [50, 1, "
                                "1], spacing: [1, 0, 0]}, material: glass}\n"
                                "  - {box: {size: 1}, motion: {spin: [0, 0, 1]}, material: glass}\n",
                            "a.yaml");
  BodyTable& bodies = scene.bodies;
  Random random(1, 2);
  for (std::size_t k = 1; k < 101; ++k) {
    bodies.position[k] = random_vector(random);
    bodies.velocity[k] = random_vector(random);
    bodies.spin[k] = random_vector(random);
    const Vec3 angle = random_vector(random);
    bodies.orientation[k] = (rotation_of(angle) * Quat(1, 2, 3, 4)).normalized();
  }
  bodies.velocity[7].x() = -0.0;
  bodies.mobility[9] = Mobility::absent;
  write_final_state(bodies, scene, folder / "final.csv");
  const Scene next = parse_scene(head + "  - {file: .}\n", folder / "b.yaml");
  ASSERT_EQ(next.bodies.count(), 99);
  for (std::size_t n = 0, k = 1; n < 99; ++n, ++k) {
    if (k == 9) ++k;
    EXPECT_EQ(next.bodies.position[n], bodies.position[k]);
    EXPECT_EQ(next.bodies.orientation[n].coeffs(), bodies.orientation[k].coeffs());
    EXPECT_EQ(next.bodies.velocity[n], bodies.velocity[k]);
    EXPECT_EQ(std::signbit(next.bodies.velocity[n].x()), std::signbit(bodies.velocity[k].x()));
    EXPECT_EQ(next.bodies.spin[n], bodies.spin[k]);
    EXPECT_EQ(next.bodies.size[n], bodies.size[k]);
    EXPECT_EQ(next.bodies.inverse_mass[n], bodies.inverse_mass[k]);
    EXPECT_EQ(next.bodies.inverse_inertia[n], bodies.inverse_inertia[k]);
    EXPECT_EQ(next.bodies.material[n], bodies.material[k]);
  }
}

constexpr const char* shapes_head =
    "format: 1\ntime: {end: 1, step: 0.1}\nmaterials: {glass: {density: 2500}, steel: {density: 7850.5}}\n";

/// Every field of all bodies but their places in the scene.
void expect_same_bits(const BodyTable& found, std::size_t n, const BodyTable& expected, std::size_t k) {
  EXPECT_EQ(found.shape[n], expected.shape[k]);
  EXPECT_EQ(found.mobility[n], expected.mobility[k]);
  EXPECT_EQ(found.size[n], expected.size[k]);
  EXPECT_EQ(found.position[n], expected.position[k]);
  EXPECT_EQ(found.orientation[n].coeffs(), expected.orientation[k].coeffs());
  EXPECT_EQ(found.velocity[n], expected.velocity[k]);
  EXPECT_EQ(found.spin[n], expected.spin[k]);
  EXPECT_EQ(found.inverse_mass[n], expected.inverse_mass[k]);
  EXPECT_EQ(found.inverse_inertia[n], expected.inverse_inertia[k]);
  EXPECT_EQ(found.material[n], expected.material[k]);
}

/// Gives bodies places, motions and orientations that take all their digits.
void stir(BodyTable& bodies, std::size_t first, std::size_t last) {
  Random random(3, 4);
  for (std::size_t k = first; k < last; ++k) {
    bodies.position[k] = random_vector(random);
    bodies.velocity[k] = random_vector(random);
    bodies.spin[k] = random_vector(random);
    bodies.orientation[k] = (rotation_of(random_vector(random)) * Quat(1, 2, 3, 4)).normalized();
  }
}

TEST(FinalState, CapsulesAndCylindersComeBackToTheBit) {
  const TemporaryFolder folder;
  std::string items;
  Random random(5, 6);
  for (int k = 0; k < 40; ++k)
    items +=
        fmt::format("  - {{{}: {{radius: {}, length: {}}}, at: [{}, 0, 0], material: steel}}\n",
                    k % 2 == 0 ? "capsule" : "cylinder", random.uniform(0.1, 0.3), random.uniform(0.1, 3), k);
  Scene scene = parse_scene(std::string(shapes_head) + "bodies:\n" + items, "a.yaml");
  stir(scene.bodies, 0, 40);
  write_final_state(scene.bodies, scene, folder / "final.csv");
  EXPECT_EQ(text_of(folder / "final.csv").find("hull"), std::string::npos) << "no columns that nobody needs";
  const Scene next = parse_scene(std::string(shapes_head) + "bodies: [{file: .}]\n", folder / "b.yaml");
  ASSERT_EQ(next.bodies.count(), 40);
  for (std::size_t k = 0; k < 40; ++k) expect_same_bits(next.bodies, k, scene.bodies, k);
}

// Two polyhedra of one hull, one of another that is not in the frame of its points, and a ball.
TEST(FinalState, PolyhedraComeBackToRounding) {
  const TemporaryFolder folder;
  Scene scene = parse_scene(std::string(shapes_head) +
                                "bodies:\n"
                                "  - {polyhedron: {points: [[1, 0, 0], [0, 1, 0], [0, 0, 1], [0, 0, 0], [1, "
                                "1, 0.3]]}, repeat: {count: "
                                "[2, 1, 1], spacing: [3, 0, 0]}, material: glass}\n"
                                "  - {sphere: {radius: 1}, at: [9, 0, 0], material: glass}\n"
                                "  - {polyhedron: {points: [[3, 0, 0], [0, 2, 0], [0, 0, 1], [-1, -1, -1]]}, "
                                "at: [20, 0, 0], "
                                "material: steel}\n",
                            "a.yaml");
  stir(scene.bodies, 0, 4);
  // As heavy as the box around it would be.
  scene.bodies.inverse_mass[3] = 1 / (7850.5 * volume_of(Shape::polyhedron, scene.bodies.size[3]));
  scene.bodies.inverse_inertia[3] =
      (scene.geometry->of_body[3].hull->moments / scene.bodies.inverse_mass[3]).cwiseInverse();
  write_final_state(scene.bodies, scene, folder / "final.csv");
  const Scene next = parse_scene(std::string(shapes_head) + "bodies: [{file: .}]\n", folder / "b.yaml");
  ASSERT_EQ(next.bodies.count(), 4);
  expect_same_bits(next.bodies, 2, scene.bodies, 2);
  EXPECT_EQ(next.geometry->hulls.size(), 2u);
  constexpr double rounding = 1e-14;
  for (const std::size_t k : {0, 1, 3}) {
    const BodyTable &found = next.bodies, &expected = scene.bodies;
    EXPECT_EQ(found.velocity[k], expected.velocity[k]);
    EXPECT_EQ(found.spin[k], expected.spin[k]);
    EXPECT_EQ(found.inverse_mass[k], expected.inverse_mass[k]);
    EXPECT_EQ(found.orientation[k].coeffs(), expected.orientation[k].coeffs());
    EXPECT_LE((found.position[k] - expected.position[k]).norm(), rounding);
    EXPECT_LE((found.size[k] - expected.size[k]).norm(), rounding);
    EXPECT_LE((found.inverse_inertia[k] - expected.inverse_inertia[k]).norm(),
              rounding * expected.inverse_inertia[k].norm());
    const Hull &hull = *next.geometry->of_body[k].hull, &before = *scene.geometry->of_body[k].hull;
    ASSERT_EQ(hull.vertices.size(), before.vertices.size());
    for (std::size_t v = 0; v < hull.vertices.size(); ++v)
      EXPECT_LE((hull.vertices[v] - before.vertices[v]).norm(), rounding);
    EXPECT_EQ(hull.faces.size(), before.faces.size());
    EXPECT_NEAR(hull.volume, before.volume, rounding);
  }
}

TEST(FinalState, AServoComesBackAsOne) {
  const TemporaryFolder folder;
  Scene scene = parse_scene(std::string(shapes_head) +
                                "bodies:\n  - {sphere: {radius: 1}, at: [9, 0, 0], material: glass}\n"
                                "  - {box: {size: [1, 2, 3]}, servo: {axis: [1, 2, -4], force: -0.3}, "
                                "rotate: {axis: [1, 1, 1], degrees: "
                                "10}, material: steel}\n",
                            "a.yaml");
  scene.bodies.velocity[1] = 0.7 * scene.servos[0].axis;
  write_final_state(scene.bodies, scene, folder / "final.csv");
  const Scene next =
      parse_scene(std::string(shapes_head) +
                      "bodies:\n  - {sphere: {radius: 1}, at: [-9, 0, 0], material: glass}\n  - {file: .}\n",
                  folder / "b.yaml");
  ASSERT_EQ(next.servos.size(), 1u);
  EXPECT_EQ(next.servos[0].body, 2);
  EXPECT_EQ(next.servos[0].axis, scene.servos[0].axis);
  EXPECT_EQ(next.servos[0].force, scene.servos[0].force);
  expect_same_bits(next.bodies, 2, scene.bodies, 1);
}

TEST(FinalState, AMassOfItsOwnIsKept) {
  const TemporaryFolder folder;
  const std::string head =
      "format: 1\ntime: {end: 1, step: 0.1}\nmaterials: {glass: {density: 2500}}\nbodies:\n";
  const Scene scene = parse_scene(head + "  - {box: {size: 1}, mass: 12, material: glass}\n", "a.yaml");
  write_final_state(scene.bodies, scene, folder / "final.csv");
  const Scene next = parse_scene(head + "  - {file: final.csv}\n", folder / "b.yaml");
  EXPECT_NEAR(1 / next.bodies.inverse_mass[0], 12, 1e-14);
}

}  // namespace
}  // namespace scree
