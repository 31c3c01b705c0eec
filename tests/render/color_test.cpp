#include "render/color.hpp"

#include "render/renderer.hpp"
#include "tests/render/scenes.hpp"

#include <gtest/gtest.h>

namespace scree::render {
namespace {

TEST(Color, SrgbHasItsKnownValues) {
  // IEC 61966-2-1: half of the largest code value stands for 21.4 % of the light.
  EXPECT_NEAR(linear_of(Color::Constant(0.5f)).x(), 0.21404114, 1e-6);
  EXPECT_NEAR(linear_of(Color::Constant(0.04f)).x(), 0.04 / 12.92, 1e-7);
  for (float v = 0; v <= 1; v += 0.01f) {
    EXPECT_NEAR(srgb_of(linear_of(Color::Constant(v))).x(), v, 2e-6);
  }
}

TEST(Color, OklabHasItsKnownValues) {
  EXPECT_NEAR((oklab_of(Color::Ones()) - Vec3f(1, 0, 0)).norm(), 0, 1e-4);
  // The value for red is in the table of the CSS Color Module (oklab(0.628 0.225 0.126)).
  EXPECT_NEAR((oklab_of(Color(1, 0, 0)) - Vec3f(0.628f, 0.225f, 0.126f)).norm(), 0, 1e-3);
  const Color color(0.2f, 0.5f, 0.7f);
  EXPECT_NEAR((linear_of_oklab(oklab_of(color)) - color).norm(), 0, 1e-5);
}

TEST(Color, ScaleHasEqualStepsOfLightness) {
  for (int k = 0; k < 32; ++k) {
    const float step = oklab_of(scale_color((k + 1) / 32.0)).x() - oklab_of(scale_color(k / 32.0)).x();
    EXPECT_NEAR(step, 0.56f / 32, 0.15f * 0.56f / 32) << "clipped by the gamut at " << k;
  }
  EXPECT_EQ(scale_color(-1), scale_color(0));
  EXPECT_EQ(scale_color(7), scale_color(1));
}

TEST(Color, TintIsSmallAndDependsOnTheBodyAlone) {
  const Color color = linear_of(default_palette().front());
  EXPECT_EQ(tinted(color, 7), tinted(color, 7));
  EXPECT_NE(tinted(color, 7), tinted(color, 8));
  for (int id = 0; id < 100; ++id) {
    EXPECT_LT((oklab_of(tinted(color, id)) - oklab_of(color)).norm(), 0.06f);
  }
}

TEST(Color, ValueRangeIsThatOfTheMovingBodies) {
  Snapshot snapshot;
  EXPECT_EQ(value_range({snapshot}, ColorBy::speed), (std::array<double, 2>{0, 1}));
  add_sphere(snapshot, Vec3::Zero(), 0.5);
  EXPECT_EQ(value_range({snapshot}, ColorBy::speed), (std::array<double, 2>{0, 1}));
  EXPECT_EQ(value_range({snapshot}, ColorBy::size), (std::array<double, 2>{0, 1}));
  for (int k = 0; k < 100; ++k) add_sphere(snapshot, Vec3::Zero(), 1 + 0.01 * k);
  add_body(snapshot, Shape::box, Vec3::Zero(), Vec3::Constant(100), Mobility::fixed);
  const auto [low, high] = value_range({snapshot}, ColorBy::size);
  EXPECT_NEAR(low, 1.01, 0.02);
  EXPECT_NEAR(high, 1.97, 0.02);
}

TEST(Coloring, ScalesShowTheirQuantity) {
  Frame frame;
  add_sphere(frame.snapshot, Vec3::Zero(), 0.5);
  frame.snapshot.bodies.velocity[0] = Vec3(0, 3, 4);
  frame.snapshot.bodies.inverse_mass[0] = 0.5;
  frame.force = {7};
  struct Case {
    ColorBy color_by;
    double value;
  };
  for (const Case& c : {Case{ColorBy::speed, 5}, Case{ColorBy::size, 0.5}, Case{ColorBy::kinetic_energy, 25},
                        Case{ColorBy::force, 7}}) {
    EXPECT_TRUE(is_scale(c.color_by));
    EXPECT_DOUBLE_EQ(value_of(frame, c.color_by, 0), c.value);
    const Painter painter(frame, c.color_by, {0, 2 * c.value}, {});
    EXPECT_LT((painter(0) - scale_color(0.5)).norm(), 1e-6f);
  }
}

TEST(Coloring, KindsAreToldApart) {
  Frame frame;
  for (int k = 0; k < 3; ++k) add_sphere(frame.snapshot, Vec3::Zero(), 0.5);
  frame.level = {0, 1, 1};
  const Painter levels(frame, ColorBy::level, {0, 1}, {});
  EXPECT_EQ(levels(0), linear_of(category_palette()[0]));
  EXPECT_EQ(levels(1), linear_of(category_palette()[1]));
  EXPECT_EQ(levels(2), levels(1));
  const Painter ids(frame, ColorBy::id, {0, 1}, {});
  EXPECT_GT((oklab_of(ids(0)) - oklab_of(ids(1))).norm(), 0.1f);
}

TEST(Coloring, FixedBodiesStayInTheBackground) {
  Frame frame;
  add_body(frame.snapshot, Shape::box, Vec3::Zero(), Vec3::Ones(), Mobility::fixed);
  EXPECT_EQ(Painter(frame, ColorBy::speed, {0, 1}, {})(0), Painter(frame, ColorBy::id, {0, 1}, {})(0));
}

}  // namespace
}  // namespace scree::render
