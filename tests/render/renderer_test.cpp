// Tests of pictures against closed forms. The background has a flat colour that no body has, which tells it
// apart from shapes.
#include "render/renderer.hpp"

#include "tests/render/scenes.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace scree::render {
namespace {

constexpr int width = 320, height = 240;

Renderer& renderer() {
  static const std::unique_ptr<Renderer> shared = make_renderer(ContextChoice::osmesa, width, height);
  return *shared;
}

// Returns a style with a purely green background and bodies without green, so that the green of a pixel shows
// how much of it a body covers.
Style masked() {
  Style style;
  style.zenith = style.horizon = Color(0, 0.8f, 0);
  style.palette = {Color(0.5f, 0, 0.5f)};
  return style;
}

Color pixel(const Image& image, int x, int y) {
  const std::uint8_t* p = &image.rgb[3 * static_cast<std::size_t>(y * image.width + x)];
  return Color(p[0], p[1], p[2]) / 255.0f;
}

double brightness(const Image& image, int x, int y) { return linear_of(pixel(image, x, y)).sum() / 3; }

// Returns whether the background covers about half of the pixel or more. Its full light in green is 0.6, or
// 0.45 near the bottom of the picture.
bool is_background(const Image& image, int x, int y) { return linear_of(pixel(image, x, y)).y() > 0.26f; }

struct Blob {
  double area = 0;  // pixels
  double x = 0, y = 0;
};
Blob silhouette(const Image& image) {
  Blob blob;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      if (is_background(image, x, y)) continue;
      blob.area += 1;
      blob.x += x + 0.5;
      blob.y += y + 0.5;
    }
  }
  blob.x /= blob.area;
  blob.y /= blob.area;
  return blob;
}

// A sphere at angle `off` from the view with the half angle `a` of its tangent cone is seen as the ellipse
// between tan(off - a) and tan(off + a) along the direction of its centre; the other axis follows from the
// cone.
Blob projected_sphere(const Camera& camera, const Vec3& center, double radius) {
  const Vec3 p = axes_of(camera).transpose() * (center - camera.from);
  const double off = std::atan2(std::hypot(p.x(), p.y()), p.z());
  const double a = std::asin(radius / p.norm());
  const double near = std::tan(off - a), far = std::tan(off + a);
  const double major = 0.5 * (far - near);
  const double minor = std::sin(a) / std::sqrt(std::pow(std::cos(off), 2) - std::pow(std::sin(a), 2));
  const double focal = 0.5 * height / std::tan(0.5 * camera.fov * pi / 180);
  const double toward = std::atan2(p.y(), p.x());
  const double middle = 0.5 * (near + far) * focal;
  return {pi * major * minor * focal * focal, 0.5 * width + middle * std::cos(toward),
          0.5 * height - middle * std::sin(toward)};
}

class Silhouette : public ::testing::TestWithParam<Vec3> {};

TEST_P(Silhouette, IsTheEllipseOfTheTangentCone) {
  // The second origin is so far away that single precision would lose the sphere's size.
  for (const Vec3& origin : {Vec3(0, 0, 0), Vec3(3e7, -2e7, 1e7)}) {
    Snapshot snapshot;
    const Vec3 center = origin + GetParam();
    add_sphere(snapshot, center, 0.8);
    const Camera camera{origin + Vec3(0, -4, 0), origin, Vec3::UnitZ(), 60};
    const Blob seen = silhouette(renderer().draw({snapshot}, camera, masked()));
    const Blob expected = projected_sphere(camera, center, 0.8);
    // The tolerance of the area is a quarter of a pixel in the radius.
    EXPECT_NEAR(seen.area, expected.area, 0.25 * std::sqrt(4 * pi * expected.area));
    EXPECT_NEAR(seen.x, expected.x, 0.3);
    EXPECT_NEAR(seen.y, expected.y, 0.3);
  }
}
INSTANTIATE_TEST_SUITE_P(Places, Silhouette,
                         ::testing::Values(Vec3(0, 0, 0), Vec3(1.2, 0.5, 0.6), Vec3(-1.5, 0, -0.7),
                                           Vec3(0, -2, 0)));

TEST(Renderer, DrawsAFrameOf4K) {
  Snapshot snapshot;
  add_sphere(snapshot, Vec3::Zero(), 0.8);
  const Camera camera{{0, -4, 0}, Vec3::Zero(), Vec3::UnitZ(), 60};
  const Image image = make_renderer(ContextChoice::osmesa, 3840, 2160)->draw({snapshot}, camera, masked());
  ASSERT_EQ(image.rgb.size(), 3u * 3840 * 2160);
  const Blob seen = silhouette(image);
  const double area = std::pow(2160.0 / height, 2) * projected_sphere(camera, Vec3::Zero(), 0.8).area;
  // The tolerance of the area is a quarter of a pixel in the radius.
  EXPECT_NEAR(seen.area, area, 0.25 * std::sqrt(4 * pi * area));
  EXPECT_NEAR(seen.x, 1920, 0.3);
  EXPECT_NEAR(seen.y, 1080, 0.3);
}

TEST(Renderer, NearerSurfaceHidesTheOther) {
  // The box has its front face at y = -0.5, and the sphere of radius 0.75 has the same centre. Seen from
  // y = -oo, the sphere sticks out of the face within a circle of radius sqrt(0.75^2 - 0.5^2) about the
  // middle.
  Snapshot snapshot;
  add_body(snapshot, Shape::box, Vec3::Zero(), Vec3(1, 0.5, 1));
  add_sphere(snapshot, Vec3::Zero(), 0.75);
  snapshot.bodies.material[1] = 1;
  Style style = masked();
  style.palette = {Color(0.9f, 0, 0), Color(0, 0, 0.9f)};
  const Camera camera{{0, -100, 0}, Vec3::Zero(), Vec3::UnitZ(), 1.4};
  const Image image = renderer().draw({snapshot}, camera, style);
  int blue = 0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const Color c = pixel(image, x, y);
      if (!is_background(image, x, y) && c.z() > c.x()) ++blue;
    }
  }
  const double scale = height / (2 * 99.5 * std::tan(0.7 * pi / 180));
  const double radius = std::sqrt(0.75 * 0.75 - 0.5 * 0.5) * scale;
  EXPECT_NEAR(blue, pi * radius * radius, 2 * pi * radius * 0.75);
}

TEST(Renderer, BoxFaceHasItsSize) {
  Snapshot snapshot;
  add_body(snapshot, Shape::box, Vec3::Zero(), Vec3(0.5, 1, 0.25));
  const Camera camera{{0, -5, 0}, Vec3::Zero(), Vec3::UnitZ(), 40};
  const Blob seen = silhouette(renderer().draw({snapshot}, camera, masked()));
  const double scale = height / (2 * 4 * std::tan(20 * pi / 180));  // pixels/m on the front face, 4 m away
  EXPECT_NEAR(seen.area, scale * 1 * scale * 0.5, 0.5 * 2 * scale * 1.5);
}

TEST(Renderer, SameInputGivesTheSameBytes) {
  const Snapshot snapshot = small_pile();
  const Camera camera = frame_all(snapshot, {0, 0, -9.81}, 4.0 / 3);
  for (const ColorBy color_by : {ColorBy::material, ColorBy::speed, ColorBy::size}) {
    Style style;
    style.color_by = color_by;
    const Image first = renderer().draw({snapshot}, camera, style);
    const Image other = renderer().draw({}, camera, style);
    EXPECT_NE(first.rgb, other.rgb);
    EXPECT_EQ(first.rgb, renderer().draw({snapshot}, camera, style).rgb);
    EXPECT_EQ(first.rgb,
              make_renderer(ContextChoice::osmesa, width, height)->draw({snapshot}, camera, style).rgb);
  }
}

TEST(Renderer, ShadowDarkensTheGround) {
  // The picture differs from that of the bare ground where the sphere is and where its shadow falls, which is
  // on the right.
  Snapshot bare;
  add_plane(bare, Vec3::UnitZ(), 0);
  Snapshot shaded = bare;
  add_sphere(shaded, {0, 0, 1.5}, 0.5);
  const Camera camera{{0, -6, 5}, {0, 0, 0.5}, Vec3::UnitZ(), 50};
  const Image before = renderer().draw({bare}, camera, {});
  const Image after = renderer().draw({shaded}, camera, {});
  const Blob sphere = projected_sphere(camera, {0, 0, 1.5}, 0.5);
  const double sphere_radius = std::sqrt(sphere.area / pi);
  int darker = 0, brighter = 0;
  double x_sum = 0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      if (std::hypot(x + 0.5 - sphere.x, y + 0.5 - sphere.y) < sphere_radius + 3) continue;
      const double ratio = brightness(after, x, y) / brightness(before, x, y);
      if (ratio > 1.05) ++brighter;
      if (ratio > 0.7) continue;
      ++darker;
      x_sum += x;
    }
  }
  EXPECT_GT(darker, 0.3 * sphere.area);
  EXPECT_GT(x_sum / darker, sphere.x);
  EXPECT_EQ(brighter, 0);
}

TEST(Renderer, ShadowsSoftenWithTheHeightOfWhatCastsThem) {
  // A fixed plate casts a shadow on the ground. The share of the shadow's pixels that are neither dark nor
  // fully lit grows with the plate's height.
  Snapshot bare;
  add_plane(bare, Vec3::UnitZ(), 0);
  Style style;
  style.cell = 100;
  double last = 0;
  for (const double plate : {0.3, 1.2, 4.8}) {
    Snapshot shaded = bare;
    add_body(shaded, Shape::box, {0, 0, plate}, {0.5, 0.5, 0.05}, Mobility::fixed);
    // For each metre down, the light goes 0.62 m to the right and 0.38 m ahead. The camera looks down on the
    // shadow from below the plate.
    const Vec3 middle(0.62 * plate, 0.38 * plate, 0);
    const Camera camera{middle + Vec3(2, -3, 0.29), middle, Vec3::UnitZ(), 40};
    const Image before = renderer().draw({bare}, camera, style);
    const Image after = renderer().draw({shaded}, camera, style);
    double dark = 0, half_lit = 0;
    for (int y = height / 3; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const double ratio = brightness(after, x, y) / brightness(before, x, y);
        dark += ratio < 0.5 ? 1 : 0;
        half_lit += ratio > 0.5 && ratio < 0.9 ? 1 : 0;
      }
    }
    EXPECT_GT(half_lit / (dark + half_lit), 1.15 * last) << plate;
    last = half_lit / (dark + half_lit);
  }
}

TEST(Renderer, TubeShowsItsContentsAndItsTurn) {
  const Camera camera{{0, -6, 1}, Vec3::Zero(), Vec3::UnitZ(), 40};
  Snapshot filled = drum(0);
  add_sphere(filled, {0, 0, 0}, 0.3);
  const Image empty = renderer().draw({drum(0)}, camera, masked());
  const Image full = renderer().draw({filled}, camera, masked());
  const Blob sphere = projected_sphere(camera, {0, 0, 0}, 0.3);
  const auto x = static_cast<int>(sphere.x), y = static_cast<int>(sphere.y);
  EXPECT_TRUE(is_background(empty, x, y)) << "through both end caps";
  EXPECT_FALSE(is_background(full, x, y));
  EXPECT_NE(renderer().draw({drum(0.1)}, camera, masked()).rgb, empty.rgb);
  // The drum has a radius of 1 m at a distance of about 6 m: its wall ends at the circle of its rim.
  EXPECT_TRUE(is_background(empty, width / 2 + 100, height / 2));
}

TEST(Renderer, LinesAreAsWideAsTheySay) {
  Frame frame;
  Line line{.from = {-1, 0, 0}, .to = {1, 0, 0}, .width = 12, .color = Color(1, 0, 1)};
  frame.lines = {line};
  const Camera camera{{0, -4, 0}, Vec3::Zero(), Vec3::UnitZ(), 60};
  const Image image = renderer().draw(frame, camera, masked());
  int rows = 0;
  for (int y = 0; y < height; ++y) rows += is_background(image, width / 2, y) ? 0 : 1;
  EXPECT_NEAR(rows, 12.0 * height / 720, 1);
  // Behind a body the line shows with the opacity `where_hidden`.
  add_sphere(frame.snapshot, Vec3::Zero(), 0.5);
  frame.lines[0].where_hidden = 0;
  const Image hidden = renderer().draw(frame, camera, masked());
  const Image alone = renderer().draw({frame.snapshot}, camera, masked());
  EXPECT_EQ(pixel(hidden, width / 2, height / 2), pixel(alone, width / 2, height / 2));
  // A line that passes the camera is clipped, and a line behind the camera is not drawn.
  frame.lines = {{.from = {0, -8, 0.01}, .to = {0, 8, 0.01}}, {.from = {-1, -9, 0}, .to = {1, -9, 0}}};
  EXPECT_NE(renderer().draw(frame, camera, masked()).rgb, std::vector<std::uint8_t>());
}

TEST(Renderer, FlatBackgroundKeepsItsColor) {
  Style style;
  style.zenith = style.horizon = Color::Constant(128 / 255.0f);
  const Image image = renderer().draw({}, {{0, -4, 0}, {0, 0, 3}, Vec3::UnitZ(), 20}, style);
  for (const std::uint8_t value : image.rgb) ASSERT_NEAR(value, 128, 1);
}

TEST(Renderer, RowsRunFromTheTop) {
  Snapshot snapshot;
  add_sphere(snapshot, {0, 0, 1}, 0.4);
  const Blob seen =
      silhouette(renderer().draw({snapshot}, {{0, -5, 0}, Vec3::Zero(), Vec3::UnitZ(), 40}, masked()));
  EXPECT_LT(seen.y, height / 2);
}

TEST(Renderer, PlaneSeenFromBehindHidesNothing) {
  Snapshot snapshot;
  add_sphere(snapshot, Vec3::Zero(), 0.5);
  const Camera camera{{0, -5, 0}, Vec3::Zero(), Vec3::UnitZ(), 40};
  const Image alone = renderer().draw({snapshot}, camera, masked());
  add_plane(snapshot, Vec3::UnitY(), -2);
  EXPECT_EQ(renderer().draw({snapshot}, camera, masked()).rgb, alone.rgb);
}

TEST(Renderer, MillimetresLookLikeMetres) {
  const Snapshot large = small_pile();
  Snapshot small = large;
  for (Vec3& p : small.bodies.position) p *= 1e-3;
  for (Vec3& s : small.bodies.size) s *= 1e-3;
  const Image a = renderer().draw({large}, frame_all(large, {0, 0, -9.81}, 4.0 / 3), {});
  const Image b = renderer().draw({small}, frame_all(small, {0, 0, -9.81}, 4.0 / 3), {});
  std::size_t differing = 0;
  for (std::size_t k = 0; k < a.rgb.size(); ++k) differing += std::abs(a.rgb[k] - b.rgb[k]) > 8 ? 1 : 0;
  EXPECT_LT(static_cast<double>(differing), 0.01 * static_cast<double>(a.rgb.size()));
}

TEST(NullRenderer, DrawsBlackWithoutOpenGl) {
  const Image image = make_null_renderer(7, 5)->draw({small_pile()}, {}, {});
  EXPECT_EQ(image.width, 7);
  EXPECT_EQ(image.height, 5);
  EXPECT_EQ(image.rgb, std::vector<std::uint8_t>(7 * 5 * 3, 0));
}

}  // namespace
}  // namespace scree::render
