// What a run leaves is what the next one starts from, to the bit.
#include "sim/record/final_state.hpp"

#include "core/rng.hpp"
#include "tests/sim/record/temporary_folder.hpp"

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
