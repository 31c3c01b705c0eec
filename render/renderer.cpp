#include "render/renderer.hpp"

#include <algorithm>

namespace scree::render {

namespace {

// The q-quantile of the values, 0 <= q <= 1; there is at least one.
double quantile(std::vector<double>& values, double q) {
  const auto nth = values.begin() + static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

class NullRenderer : public Renderer {
 public:
  NullRenderer(int width, int height) : image_{width, height, {}} {
    image_.rgb.resize(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  }
  Image draw(const Snapshot&, const Camera&, const Style&) override { return image_; }

 private:
  Image image_;
};

}  // namespace

std::array<double, 2> value_range(const Snapshot& snapshot, ColorBy color_by) {
  const BodyTable& bodies = snapshot.bodies;
  std::vector<double> values;
  for (std::size_t k = 0; k < bodies.shape.size(); ++k) {
    if (bodies.mobility[k] == Mobility::fixed) continue;
    values.push_back(color_by == ColorBy::speed ? bodies.velocity[k].norm()
                                                : bounding_radius(bodies.shape[k], bodies.size[k]));
  }
  if (values.empty() || color_by == ColorBy::material) return {0, 1};
  const double low = color_by == ColorBy::speed ? 0 : quantile(values, 0.02);
  const double high = quantile(values, 0.98);
  if (high > low) return {low, high};
  return {0, high > 0 ? 2 * high : 1};
}

std::unique_ptr<Renderer> make_null_renderer(int width, int height) {
  return std::make_unique<NullRenderer>(width, height);
}

}  // namespace scree::render
