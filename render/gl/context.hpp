// Where OpenGL comes from: the only thing that differs between the ways to draw without a window.
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
  /// The entry point of an OpenGL function; null if there is none. Needs the context to be current.
  virtual Function function(const char* name) const = 0;
  /// Of the way: "OSMesa".
  virtual std::string name() const = 0;
  /// Whether a GPU draws.
  virtual bool is_hardware() const = 0;
};

/// An OpenGL 3.3 core context without a window, on the processor. Throws RunError.
std::unique_ptr<Context> make_osmesa_context();

enum class EglDevices { hardware, any };
/// The same on the first device that gives one, GPUs before what imitates them on the processor. Throws
/// RunError that says what was tried.
std::unique_ptr<Context> make_egl_context(EglDevices wanted);

}  // namespace scree::render::gl
