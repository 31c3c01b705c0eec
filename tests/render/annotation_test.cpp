#include "render/annotation.hpp"

#include "tests/render/scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace scree::render {
namespace {

constexpr int width = 640, height = 360;

Image blank() { return {width, height, std::vector<std::uint8_t>(std::size_t{3} * width * height, 128)}; }

// Returns the number of pixels in columns [from, to) that differ from the blank picture.
int written(Image& image, int from, int to) {
  int count = 0;
  for (int y = 0; y < height; ++y) {
    for (int x = from; x < to; ++x) count += *pixel_of(image, x, y) != 128 ? 1 : 0;
  }
  return count;
}

Frame moving_sphere(double speed) {
  Frame frame;
  add_plane(frame.snapshot, Vec3::UnitZ(), 0);
  add_sphere(frame.snapshot, Vec3::Zero(), 0.5);
  frame.snapshot.bodies.velocity[1] = Vec3(speed, 0, 0);
  return frame;
}

Style speed_style() {
  Style style;
  style.color_by = ColorBy::speed;
  style.range = {0, 2};
  style.cell = 0.1;
  return style;
}

Image annotated(const Annotation& annotation, const Frame& frame, const Style& style) {
  Image image = blank();
  Annotator(annotation, height, 0.01).annotate(image, frame, style);
  return image;
}

TEST(Text, HasTheWidthThatItSays) {
  const Font font(20);
  Image image = blank();
  font.draw(image, 100, 100, "0123 m/s", Color::Zero());
  const int end = 100 + font.width("0123 m/s");
  EXPECT_GT(written(image, 100, end), 200);
  EXPECT_EQ(written(image, 0, 99) + written(image, end + 1, width), 0);
  EXPECT_GT(font.width("≥"), 0);
}

TEST(Text, OutsideThePictureIsLeftOut) {
  Image image = blank();
  const Font font(20);
  font.draw(image, -30, 5, "outside", Color::Zero());
  font.draw(image, width - 5, height + 5, "outside", Color::Zero());
  fill(image, -10, -10, 15, 15, Color::Zero());
  EXPECT_EQ(*pixel_of(image, 4, 4), 0);
  EXPECT_EQ(*pixel_of(image, 5, 5), 128);
}

TEST(Annotation, WritesWhatIsAskedForAndNothingElse) {
  const Frame frame = moving_sphere(1);
  Image none = annotated({.legend = false, .time_stamp = false}, frame, speed_style());
  EXPECT_EQ(none.rgb, blank().rgb);
  Image time = annotated({.legend = false, .time_stamp = true}, frame, speed_style());
  EXPECT_GT(written(time, 0, width / 2), 100);
  EXPECT_EQ(written(time, width / 2, width), 0);
  Image legend = annotated({.legend = true, .time_stamp = false}, frame, speed_style());
  EXPECT_GT(written(legend, width / 2, width), 1000);
  EXPECT_EQ(annotated({}, frame, speed_style()).rgb, annotated({}, frame, speed_style()).rgb);
}

TEST(Annotation, LegendHoldsTheColoursOfTheScale) {
  Image image = annotated({.legend = true, .time_stamp = false}, moving_sphere(1), speed_style());
  for (const double t : {0.1, 0.5, 0.9}) {
    const Color color = srgb_of(scale_color(t));
    float nearest = 1;
    for (int y = 0; y < height; ++y) {
      for (int x = width / 2; x < width; ++x) {
        const std::uint8_t* p = pixel_of(image, x, y);
        nearest = std::min(nearest, (Color(p[0], p[1], p[2]) / 255 - color).norm());
      }
    }
    EXPECT_LT(nearest, 0.01f) << t;
  }
}

TEST(Annotation, SaysWhenValuesExceedTheScale) {
  const Annotation legend{.legend = true, .time_stamp = false};
  EXPECT_EQ(annotated(legend, moving_sphere(1), speed_style()).rgb,
            annotated(legend, moving_sphere(2), speed_style()).rgb);
  EXPECT_NE(annotated(legend, moving_sphere(1), speed_style()).rgb,
            annotated(legend, moving_sphere(2.01), speed_style()).rgb);
}

TEST(Annotation, KindsAreNamedWhereThereAreSeveral) {
  Frame frame = moving_sphere(1);
  Style style = speed_style();
  style.color_by = ColorBy::material;
  frame.kinds = {"sand"};
  const Annotation legend{.legend = true, .time_stamp = false};
  Image one = annotated(legend, frame, style);
  EXPECT_EQ(written(one, width / 2, width), 0);
  frame.kinds.push_back("gravel");
  Image two = annotated(legend, frame, style);
  EXPECT_GT(written(two, width / 2, width), 500);
}

TEST(Annotation, TicksAreRound) {
  EXPECT_EQ(round_ticks(0, 10, 5), (std::vector<double>{0, 2, 4, 6, 8, 10}));
  const std::vector<double> ticks = round_ticks(0.03, 0.061, 5);
  ASSERT_EQ(ticks.size(), 4u);
  EXPECT_NEAR(ticks.front(), 0.03, 1e-12);
  EXPECT_NEAR(ticks.back(), 0.06, 1e-12);
  EXPECT_DOUBLE_EQ(rounded_up(3.1), 5);
  EXPECT_DOUBLE_EQ(rounded_up(0.05), 0.05);
  EXPECT_DOUBLE_EQ(rounded_up(600), 1000);
}

TEST(Annotation, WordsHaveTheUnitThatSuits) {
  EXPECT_EQ(length_words(0.1), "0.1 m");
  EXPECT_EQ(length_words(0.01), "10 mm");
  EXPECT_EQ(length_words(1e-3), "1 mm");
  EXPECT_EQ(length_words(10), "10 m");
  EXPECT_EQ(length_words(1000), "1 km");
  EXPECT_EQ(length_words(1e-6), "1 µm");
  EXPECT_EQ(time_words(1.2345, 1.0 / 30), "1.23 s");
  EXPECT_EQ(time_words(2, 1), "2 s");
}

}  // namespace
}  // namespace scree::render
