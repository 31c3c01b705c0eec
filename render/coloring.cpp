#include "render/coloring.hpp"

#include <algorithm>

namespace scree::render {

namespace {

// Returns the q-quantile of the values, 0 <= q <= 1. There must be at least one value.
double quantile(std::vector<double>& values, double q) {
  const auto nth = values.begin() + static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

// The sRGB colour of fixed bodies; muted colours are mixed with it. It stays in the background.
const Color stone(0.72f, 0.71f, 0.69f);

}  // namespace

bool is_scale(ColorBy color_by) {
  return color_by != ColorBy::material && color_by != ColorBy::level && color_by != ColorBy::id;
}

double value_of(const Frame& frame, ColorBy color_by, std::size_t body) {
  const BodyTable& bodies = frame.snapshot.bodies;
  switch (color_by) {
    case ColorBy::speed:
      return bodies.velocity[body].norm();
    case ColorBy::size:
      return bounding_radius(bodies.shape[body], bodies.size[body]);
    case ColorBy::kinetic_energy:
      if (bodies.inverse_mass[body] == 0) return 0;
      return 0.5 * bodies.velocity[body].squaredNorm() / bodies.inverse_mass[body];
    case ColorBy::force:
      return body < frame.force.size() ? frame.force[body] : 0;
    case ColorBy::material:
    case ColorBy::level:
    case ColorBy::id:
      break;
  }
  return 0;
}

std::array<double, 2> value_range(const Frame& frame, ColorBy color_by) {
  const BodyTable& bodies = frame.snapshot.bodies;
  std::vector<double> values;
  for (std::size_t k = 0; k < bodies.shape.size() && is_scale(color_by); ++k) {
    if (is_colored(bodies, k)) values.push_back(value_of(frame, color_by, k));
  }
  if (values.empty()) return {0, 1};
  const double low = color_by == ColorBy::size ? quantile(values, 0.02) : 0;
  const double high = quantile(values, 0.98);
  if (high > low) return {low, high};
  return {0, high > 0 ? 2 * high : 1};
}

Painter::Painter(const Frame& frame, ColorBy color_by, const std::array<double, 2>& range,
                 const std::vector<Color>& palette, float muted)
    : frame_(frame), color_by_(color_by), range_(range), muted_(muted) {
  const bool kinds_of_others = color_by == ColorBy::level || color_by == ColorBy::id;
  for (const Color& color : kinds_of_others ? category_palette() : palette) {
    palette_.push_back(linear_of(color));
  }
  if (palette_.empty()) palette_.push_back(Color::Constant(0.5f));
}

Color Painter::operator()(std::size_t body) const {
  static const Color background = linear_of(stone);
  const BodyTable& bodies = frame_.snapshot.bodies;
  if (!is_colored(bodies, body)) {
    const bool shows_material = color_by_ == ColorBy::material && !is_surface(bodies.shape[body]);
    return shows_material ? Color(0.5f * (colored(body) + background)) : background;
  }
  return (1 - muted_) * colored(body) + muted_ * background;
}

Color Painter::colored(std::size_t body) const {
  const BodyTable& bodies = frame_.snapshot.bodies;
  if (is_scale(color_by_)) {
    return scale_color((value_of(frame_, color_by_, body) - range_[0]) / (range_[1] - range_[0]));
  }
  std::int32_t kind = bodies.material[body];
  if (color_by_ == ColorBy::id) kind = static_cast<std::int32_t>(bodies.id[body]);
  if (color_by_ == ColorBy::level) kind = body < frame_.level.size() ? frame_.level[body] : 0;
  const Color& color = palette_[static_cast<std::size_t>(kind) % palette_.size()];
  return color_by_ == ColorBy::level ? color : tinted(color, static_cast<std::int32_t>(bodies.id[body]));
}

}  // namespace scree::render
