#include "render/renderer.hpp"

namespace scree::render {

namespace {

class NullRenderer : public Renderer {
 public:
  NullRenderer(int width, int height) : image_{width, height, {}} {
    image_.rgb.resize(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  }
  Image draw(const Frame&, const Camera&, const Style&) override { return image_; }

 private:
  Image image_;
};

}  // namespace

std::unique_ptr<Renderer> make_null_renderer(int width, int height) {
  return std::make_unique<NullRenderer>(width, height);
}

}  // namespace scree::render
