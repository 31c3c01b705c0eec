#include "render/renderer.hpp"

#include "core/error.hpp"
#include "render/gl/context.hpp"
#include "render/gl/gl_renderer.hpp"

namespace scree::render {

namespace {

class NullRenderer : public Renderer {
 public:
  NullRenderer(int width, int height) : image_{width, height, {}} {
    image_.rgb.resize(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  }
  Image draw(const Frame&, const Camera&, const Style&) override { return image_; }
  std::string name() const override { return "none"; }

 private:
  Image image_;
};

std::unique_ptr<Renderer> on_hardware_or_processor(int width, int height) {
  try {
    return gl::make_gl_renderer(gl::make_egl_context(gl::EglDevices::hardware), width, height);
  } catch (const RunError&) {  // `scree info` reports the reason
    return make_renderer(ContextChoice::osmesa, width, height);
  }
}

}  // namespace

std::unique_ptr<Renderer> make_renderer(ContextChoice choice, int width, int height) {
  switch (choice) {
    case ContextChoice::automatic:
      return on_hardware_or_processor(width, height);
    case ContextChoice::osmesa:
      break;
    case ContextChoice::egl:
      return gl::make_gl_renderer(gl::make_egl_context(gl::EglDevices::any), width, height);
  }
  return gl::make_gl_renderer(gl::make_osmesa_context(), width, height);
}

std::unique_ptr<Renderer> make_null_renderer(int width, int height) {
  return std::make_unique<NullRenderer>(width, height);
}

}  // namespace scree::render
