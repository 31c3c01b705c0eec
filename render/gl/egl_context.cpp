#include "core/error.hpp"
#include "render/gl/context.hpp"

#include <fmt/format.h>

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <algorithm>
#include <array>
#include <cstdlib>
#include <string_view>
#include <vector>

namespace scree::render::gl {

namespace {

constexpr EGLint most_devices = 64;

// Returns whether a list of extensions has the name as a whole word, since some names are the beginnings of
// others.
bool has(const char* extensions, std::string_view name) {
  const std::string list = fmt::format(" {} ", extensions != nullptr ? extensions : "");
  return list.find(fmt::format(" {} ", name)) != std::string::npos;
}

template <class Function>
Function extension(const char* name) {
  return reinterpret_cast<Function>(eglGetProcAddress(name));
}

std::string last_error() { return fmt::format("EGL error 0x{:x}", eglGetError()); }

struct Device {
  EGLDeviceEXT device;
  bool is_hardware;
};

/// Returns the devices that EGL knows, hardware first. There are none if no driver is installed.
std::vector<Device> devices() {
  // Without this setting, Mesa would warn on the terminal of drivers that are not installed. Failures are
  // reported by the errors here.
  setenv("EGL_LOG_LEVEL", "fatal", 0);
  const char* client = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  const bool can_list = has(client, "EGL_EXT_device_base") || has(client, "EGL_EXT_device_enumeration");
  if (!can_list || !has(client, "EGL_EXT_platform_device")) return {};
  const auto query = extension<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
  const auto describe = extension<PFNEGLQUERYDEVICESTRINGEXTPROC>("eglQueryDeviceStringEXT");
  std::array<EGLDeviceEXT, most_devices> found{};
  EGLint count = 0;
  if (query == nullptr || describe == nullptr || !query(most_devices, found.data(), &count)) return {};
  std::vector<Device> devices;
  for (EGLint k = 0; k < count; ++k) {
    EGLDeviceEXT device = found[static_cast<std::size_t>(k)];
    devices.push_back({device, !has(describe(device, EGL_EXTENSIONS), "EGL_MESA_device_software")});
  }
  std::ranges::stable_partition(devices, &Device::is_hardware);
  return devices;
}

class EglContext : public Context {
 public:
  /// Throws RunError if the device gives no context.
  explicit EglContext(const Device& device) : is_hardware_(device.is_hardware) {
    const auto display_of = extension<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");
    if (display_of != nullptr) display_ = display_of(EGL_PLATFORM_DEVICE_EXT, device.device, nullptr);
    if (display_ == EGL_NO_DISPLAY || !eglInitialize(display_, nullptr, nullptr))
      throw RunError("has no display: " + last_error());
    const char* extensions = eglQueryString(display_, EGL_EXTENSIONS);
    for (const char* needed : {"EGL_KHR_no_config_context", "EGL_KHR_surfaceless_context"})
      if (!has(extensions, needed)) throw RunError(fmt::format("lacks {}", needed));
    const std::array<EGLint, 7> attributes = {EGL_CONTEXT_MAJOR_VERSION,
                                              3,
                                              EGL_CONTEXT_MINOR_VERSION,
                                              3,
                                              EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                              EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                              EGL_NONE};
    if (eglBindAPI(EGL_OPENGL_API))
      context_ = eglCreateContext(display_, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes.data());
    if (context_ == EGL_NO_CONTEXT) throw RunError("gives no OpenGL 3.3 core context: " + last_error());
  }
  /// The display is not terminated: it belongs to the process, and other contexts may use it.
  ~EglContext() override {
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display_, context_);
  }
  EglContext(const EglContext&) = delete;
  EglContext& operator=(const EglContext&) = delete;

  void make_current() override {
    if (!eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_))
      throw RunError("EGL cannot make its context current: " + last_error());
  }
  Function function(const char* name) const override { return eglGetProcAddress(name); }
  std::string name() const override { return "EGL"; }
  bool is_hardware() const override { return is_hardware_; }

 private:
  bool is_hardware_;
  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLContext context_ = EGL_NO_CONTEXT;
};

}  // namespace

std::unique_ptr<Context> make_egl_context(EglDevices wanted) {
  std::string tried;
  for (const Device& device : devices()) {
    if (!device.is_hardware && wanted == EglDevices::hardware) continue;
    try {
      return std::make_unique<EglContext>(device);
    } catch (const RunError& error) {
      tried += fmt::format("{}a {} device {}", tried.empty() ? "" : "; ",
                           device.is_hardware ? "GPU's" : "software", error.what());
    }
  }
  if (tried.empty())
    tried = wanted == EglDevices::hardware
                ? "there is no GPU with a driver for it"
                : "it knows no device; is a driver's EGL installed (libegl-mesa0, or the GPU's own)?";
  throw RunError("EGL gives no OpenGL context: " + tried);
}

}  // namespace scree::render::gl
