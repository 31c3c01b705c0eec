#include "render/color.hpp"

#include "core/rng.hpp"

#include <algorithm>
#include <cmath>

namespace scree::render {

Color linear_of(const Color& srgb) {
  return srgb.unaryExpr(
      [](float v) { return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f); });
}

Color srgb_of(const Color& linear) {
  return linear.unaryExpr(
      [](float v) { return v <= 0.0031308f ? 12.92f * v : 1.055f * std::pow(v, 1 / 2.4f) - 0.055f; });
}

namespace {

// The two matrices of OKLab. The first takes linear sRGB to the cone response, the second takes the cube root
// of that to lightness and opponent colours.
const Eigen::Matrix3f& cones() {
  static const Eigen::Matrix3f m =
      (Eigen::Matrix3f() << 0.4122214708f, 0.5363325363f, 0.0514459929f, 0.2119034982f, 0.6806995451f,
       0.1073969566f, 0.0883024619f, 0.2817188376f, 0.6299787005f)
          .finished();
  return m;
}
const Eigen::Matrix3f& opponents() {
  static const Eigen::Matrix3f m =
      (Eigen::Matrix3f() << 0.2104542553f, 0.7936177850f, -0.0040720468f, 1.9779984951f, -2.4285922050f,
       0.4505937099f, 0.0259040371f, 0.7827717662f, -0.8086757660f)
          .finished();
  return m;
}

}  // namespace

Vec3f oklab_of(const Color& linear) {
  return opponents() * Vec3f((cones() * linear).unaryExpr([](float v) { return std::cbrt(v); }));
}

Color linear_of_oklab(const Vec3f& lab) {
  static const Eigen::Matrix3f from_opponents = opponents().inverse(), from_cones = cones().inverse();
  const Vec3f root = from_opponents * lab;
  return (from_cones * root.cwiseProduct(root).cwiseProduct(root)).cwiseMax(0.0f).cwiseMin(1.0f);
}

const std::vector<Color>& default_palette() {
  static const std::vector<Color> palette = {
      {0.255f, 0.495f, 0.650f},  // lake blue
      {0.890f, 0.635f, 0.235f},  // amber
      {0.800f, 0.370f, 0.300f},  // brick
      {0.440f, 0.640f, 0.515f},  // sage
      {0.530f, 0.430f, 0.660f},  // heather
      {0.800f, 0.715f, 0.565f},  // sand
      {0.830f, 0.545f, 0.620f},  // rose
      {0.370f, 0.415f, 0.450f},  // slate
  };
  return palette;
}

const std::vector<Color>& category_palette() {
  static const std::vector<Color> palette = {
      {0.000f, 0.447f, 0.698f},  // blue
      {0.902f, 0.624f, 0.000f},  // orange
      {0.000f, 0.620f, 0.451f},  // bluish green
      {0.800f, 0.475f, 0.655f},  // reddish purple
      {0.337f, 0.706f, 0.914f},  // sky blue
      {0.835f, 0.369f, 0.000f},  // vermillion
      {0.941f, 0.894f, 0.259f},  // yellow
  };
  return palette;
}

Color scale_color(double t) {
  const float s = static_cast<float>(std::clamp(t, 0.0, 1.0));
  const float lightness = 0.34f + 0.56f * s;
  // The hue goes from violet over blue and green to yellow. The chroma is as high as sRGB can show all along
  // that path.
  const float hue = (300.0f - 195.0f * s) * static_cast<float>(pi / 180);
  const float chroma = 0.105f + 0.055f * s * s;
  return linear_of_oklab({lightness, chroma * std::cos(hue), chroma * std::sin(hue)});
}

Color tinted(const Color& linear, std::int32_t id) {
  const auto bits = philox({static_cast<std::uint32_t>(id), 0, 0, 0}, {0, 0});
  const auto centered = [](std::uint32_t word) { return static_cast<float>(word) * 0x1p-32f - 0.5f; };
  const Vec3f shift(0.10f * centered(bits[0]), 0.016f * centered(bits[1]), 0.020f * centered(bits[2]));
  return linear_of_oklab(oklab_of(linear) + shift);
}

}  // namespace scree::render
