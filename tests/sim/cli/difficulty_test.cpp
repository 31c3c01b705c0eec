// Advice on steps and ratios against closed forms.
#include "sim/cli/difficulty.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace scree::cli {
namespace {

Difficulty of(const std::string& bodies, const char* end = "10", const char* gravity = "[0, 0, -10]") {
  return difficulty_of(parse_scene("format: 1\ngravity: " + std::string(gravity) + "\ntime: {end: " + end +
                                       ", step: 0.01}\nmaterials: {a: {density: 1000}}\nbodies:\n" + bodies,
                                   "test.yaml"));
}

const std::string floor = "  - {plane: {normal: [0, 0, 1]}, material: a}\n";

TEST(Difficulty, AFallEndsOnThePlane) {
  const std::string ball = "  - {sphere: {radius: 0.1}, at: [0, 0, 5.1], material: a}\n";
  const Difficulty d = of(floor + ball);
  EXPECT_NEAR(d.fall, 5, 1e-14);
  EXPECT_NEAR(d.speed, 10, 1e-14);
  EXPECT_NEAR(d.travel(0.01), 1, 1e-14);
  EXPECT_NEAR(of(floor + ball, "0.5").speed, 5, 1e-14) << "the run ends in the air";
  EXPECT_NEAR(of(floor + ball, "0.5").fall, 1.25, 1e-14);
  const std::string thrown =
      "  - {sphere: {radius: 0.1}, at: [0, 0, 5.1], velocity: [0, 0, -2], material: a}\n";
  EXPECT_NEAR(of(floor + thrown, "0.5").fall, 2.25, 1e-14);
  EXPECT_NEAR(of(floor + thrown, "0.5").speed, 7, 1e-14);
  EXPECT_EQ(of(floor + ball, "10", "[0, 0, 0]").speed, 0);
  EXPECT_NEAR(of(floor + ball, "10", "[0, 0, 10]").fall, 0, 1e-14) << "away from the plane, past nothing";
  // Down a plane that leans by 60 degrees, straight along gravity.
  EXPECT_NEAR(of("  - {plane: {normal: [0.8660254037844386, 0, 0.5]}, material: a}\n"
                 "  - {sphere: {radius: 0.1}, at: [1, 0, 0], material: a}\n")
                  .fall,
              (0.8660254037844386 - 0.1) / 0.5, 1e-14);
}

TEST(Difficulty, WithoutAPlaneAFallEndsAtTheLowestBody) {
  const Difficulty d =
      of("  - {sphere: {radius: 0.1}, at: [0, 0, 3.1], velocity: [3, 0, 0], material: a}\n"
         "  - {box: {size: [4, 4, 2]}, fixed: true, at: [0, 0, 1], material: a}\n");
  EXPECT_NEAR(d.fall, 5, 1e-14);  // from 3 to the foot of the sphere around the box, at 1 - 3
  EXPECT_NEAR(d.speed, std::sqrt(9 + 20 * d.fall), 1e-13);
}

TEST(Difficulty, CornersOfTurningBoxesCount) {
  const Difficulty d =
      of("  - {box: {size: [2, 2, 1]}, motion: {velocity: [0, 0, 1], spin: [0, 0, 4]}, material: a}\n");
  EXPECT_NEAR(d.speed, 1 + 4 * 1.5, 1e-14);
  EXPECT_EQ(d.smallest_size, 0.5);
  EXPECT_EQ(d.largest_size, 0) << "no body is free";
}

TEST(Difficulty, RatiosAreOfTheFreeBodies) {
  const Difficulty d = of(floor +
                          "  - {sphere: {radius: 0.1}, at: [0, 0, 0.1], mass: 2, material: a}\n"
                          "  - {sphere: {radius: 0.4}, at: [1, 0, 0.4], mass: 600, material: a}\n"
                          "  - {sphere: {radius: 9}, at: [1, 99, 0.4], fixed: true, material: a}\n");
  EXPECT_NEAR(d.mass_ratio, 300, 1e-11);
  EXPECT_EQ(d.least_size, 0.1);
  EXPECT_EQ(d.largest_size, 0.4);
}

}  // namespace
}  // namespace scree::cli
