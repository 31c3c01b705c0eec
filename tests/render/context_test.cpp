// Tests that every kind of OpenGL context draws the same pictures, except for the rounding of its driver.
#include "render/gl/context.hpp"

#include "core/error.hpp"
#include "render/annotation.hpp"
#include "render/gl/gl_renderer.hpp"
#include "render/renderer.hpp"
#include "tests/render/scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <memory>

namespace scree::render {
namespace {

constexpr int width = 320, height = 240;

/// The difference of two pictures, in steps of 8-bit sRGB.
struct Difference {
  int largest = 0;   ///< largest difference over all channels
  double mean = 0;   ///< mean difference over all channels
  double share = 0;  ///< share of the pixels with a channel that differs by more than `seen`

  static constexpr int seen = 8;
};

// Returns whether two pictures differ only as drivers may. Coverage has four samples per pixel, so that at an
// edge that passes next to a sample the pictures may differ by a quarter of the contrast, or by half of it
// next to two samples. Such pixels are few; elsewhere rounding makes a difference of one or two steps.
bool is_same_picture(const Difference& d) { return d.mean < 0.1 && d.share < 2e-3; }

Difference difference(const Image& a, const Image& b) {
  Difference d;
  std::size_t seen = 0;
  for (std::size_t pixel = 0; pixel < a.rgb.size(); pixel += 3) {
    int largest = 0;
    for (std::size_t k = pixel; k < pixel + 3; ++k) {
      const int apart = std::abs(a.rgb[k] - b.rgb[k]);
      d.mean += apart;
      largest = std::max(largest, apart);
    }
    d.largest = std::max(d.largest, largest);
    seen += largest > Difference::seen ? 1 : 0;
  }
  d.mean /= static_cast<double>(a.rgb.size());
  d.share = static_cast<double>(seen) / static_cast<double>(a.rgb.size() / 3);
  return d;
}

/// Pictures of a colour scale with its legend, of lines over bodies, of a pile with shadows between walls, of
/// a drum with its contents, and of the pile seen from a hundredth of its size further to the side.
struct Pictures {
  Image speeds, lines, pile, drum, aside;
};

Pictures draw_all(Renderer& renderer) {
  Frame pile{.snapshot = small_pile()};
  for (std::size_t k = 0; k < pile.snapshot.bodies.velocity.size(); ++k)
    pile.snapshot.bodies.velocity[k] = 0.02 * static_cast<double>(k) * Vec3::UnitX();
  const Camera camera = frame_all(pile.snapshot, {0, 0, -9.81}, static_cast<double>(width) / height);
  Style speed;
  speed.color_by = ColorBy::speed;
  speed.range = {0, 1.2};
  speed.cell = grid_cell(camera);
  Pictures pictures;
  pictures.speeds = renderer.draw(pile, camera, speed);
  Annotator({}, height, 0.1).annotate(pictures.speeds, pile, speed);
  pictures.pile = renderer.draw(pile, camera, {});
  Camera aside = camera;
  aside.from += 0.01 * Vec3::UnitX();
  pictures.aside = renderer.draw(pile, aside, {});
  for (int k = 0; k < 8; ++k)
    pile.lines.push_back(
        {.from = {-1, 0.25 * k - 1, 0.1 * k}, .to = {1, 1 - 0.25 * k, 1}, .width = 1.0f + k});
  pictures.lines = renderer.draw(pile, camera, {});
  Frame filled{.snapshot = drum(0.3)};
  for (int k = 0; k < 5; ++k) add_sphere(filled.snapshot, {0.3 * k - 0.6, 0, -0.5}, 0.14);
  pictures.drum = renderer.draw(filled, {{1, -4, 1}, Vec3::Zero(), Vec3::UnitZ(), 40}, {});
  return pictures;
}

TEST(Contexts, DrawTheSamePictures) {
  std::unique_ptr<Renderer> egl;
  try {
    egl = make_renderer(ContextChoice::egl, width, height);
  } catch (const RunError& error) {
    GTEST_SKIP() << error.what();
  }
  std::printf("%s\n", egl->name().c_str());
  const Pictures theirs = draw_all(*egl);
  egl.reset();  // only one context exists at a time
  const Pictures ours = draw_all(*make_renderer(ContextChoice::osmesa, width, height));
  const auto expect_same = [&](const char* name, const Image Pictures::*picture) {
    const Difference d = difference(ours.*picture, theirs.*picture);
    std::printf("%-7s largest %3d, mean %.4f, share of pixels more than %d apart %.5f\n", name, d.largest,
                d.mean, Difference::seen, d.share);
    EXPECT_TRUE(is_same_picture(d)) << name;
  };
  expect_same("speeds", &Pictures::speeds);
  expect_same("lines", &Pictures::lines);
  expect_same("pile", &Pictures::pile);
  expect_same("drum", &Pictures::drum);
  // A picture that is shifted by half a pixel no longer counts as the same.
  const Difference aside = difference(ours.pile, theirs.aside);
  std::printf("half a pixel aside: largest %d, mean %.4f, share %.5f\n", aside.largest, aside.mean,
              aside.share);
  EXPECT_FALSE(is_same_picture(aside));
  EXPECT_FALSE(is_same_picture(difference(ours.pile, ours.lines)));
}

/// An OSMesa context, on the processor, that claims to be a GPU's.
class AsIfHardware : public gl::Context {
 public:
  void make_current() override { context_->make_current(); }
  Function function(const char* name) const override { return context_->function(name); }
  std::string name() const override { return context_->name(); }
  bool is_hardware() const override { return true; }

 private:
  std::unique_ptr<gl::Context> context_ = gl::make_osmesa_context();
};

TEST(Contexts, PicturesAreTheSameWithWhatIsHidden) {
  const Pictures without = draw_all(*make_renderer(ContextChoice::osmesa, width, height));
  const Pictures with = draw_all(*gl::make_gl_renderer(std::make_unique<AsIfHardware>(), width, height));
  EXPECT_EQ(without.speeds.rgb, with.speeds.rgb);
  EXPECT_EQ(without.pile.rgb, with.pile.rgb);
  EXPECT_EQ(without.lines.rgb, with.lines.rgb);
  EXPECT_EQ(without.drum.rgb, with.drum.rgb);
}

TEST(Contexts, SameInputGivesTheSameBytes) {
  try {
    const std::unique_ptr<Renderer> egl = make_renderer(ContextChoice::egl, width, height);
    EXPECT_EQ(draw_all(*egl).pile.rgb, draw_all(*egl).pile.rgb);
  } catch (const RunError& error) {
    GTEST_SKIP() << error.what();
  }
}

TEST(Contexts, LeftToScreeAlwaysDraw) {
  EXPECT_NO_THROW(make_renderer(ContextChoice::automatic, width, height)->draw({small_pile()}, {}, {}));
}

}  // namespace
}  // namespace scree::render
