// The OpenGL context. It is the only part that differs between the ways to draw without a window.
#pragma once

#include <memory>
#include <string>

namespace scree::render::gl {

class Context {
 public:
  using Function = void (*)();
  virtual ~Context() = default;
  /// Makes this the calling thread's context. Throws RunError.
  virtual void make_current() = 0;
  /// Returns the entry point of an OpenGL function, or null if there is none. The context must be current.
  virtual Function function(const char* name) const = 0;
  /// Returns the name of the interface, such as "OSMesa".
  virtual std::string name() const = 0;
  /// Returns whether a GPU draws.
  virtual bool is_hardware() const = 0;
};

/// Makes an OpenGL 3.3 core context without a window, on the processor. Throws RunError.
std::unique_ptr<Context> make_osmesa_context();

enum class EglDevices { hardware, any };
/// Makes an OpenGL 3.3 core context without a window through EGL, on the first device that gives one. GPUs
/// are tried before devices that imitate them on the processor. Throws RunError, which lists what was tried.
std::unique_ptr<Context> make_egl_context(EglDevices wanted);

}  // namespace scree::render::gl
