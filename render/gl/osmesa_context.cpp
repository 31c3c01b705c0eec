#include "core/error.hpp"
#include "render/gl/context.hpp"

#include <GL/osmesa.h>

#include <array>
#include <cstdint>

namespace scree::render::gl {

namespace {

class OsmesaContext : public Context {
 public:
  OsmesaContext() {
    const std::array<int, 9> attributes = {OSMESA_FORMAT,
                                           OSMESA_RGBA,
                                           OSMESA_PROFILE,
                                           OSMESA_CORE_PROFILE,
                                           OSMESA_CONTEXT_MAJOR_VERSION,
                                           3,
                                           OSMESA_CONTEXT_MINOR_VERSION,
                                           3,
                                           0};
    context_ = OSMesaCreateContextAttribs(attributes.data(), nullptr);
    if (context_ == nullptr)
      throw RunError("OSMesa gives no OpenGL 3.3 core context; is libosmesa6 installed?");
  }
  ~OsmesaContext() override { OSMesaDestroyContext(context_); }
  OsmesaContext(const OsmesaContext&) = delete;
  OsmesaContext& operator=(const OsmesaContext&) = delete;

  void make_current() override {
    if (!OSMesaMakeCurrent(context_, window_.data(), GL_UNSIGNED_BYTE, 1, 1)) {
      throw RunError("OSMesa cannot make its context current");
    }
  }
  Function function(const char* name) const override { return OSMesaGetProcAddress(name); }
  std::string name() const override { return "OSMesa"; }
  bool is_hardware() const override { return false; }

 private:
  OSMesaContext context_ = nullptr;
  std::array<std::uint8_t, 4>
      window_{};  // buffer that OSMesa needs; everything is drawn into framebuffer objects
};

}  // namespace

std::unique_ptr<Context> make_osmesa_context() { return std::make_unique<OsmesaContext>(); }

}  // namespace scree::render::gl
