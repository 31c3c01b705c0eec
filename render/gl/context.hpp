// Where OpenGL comes from: the only thing that differs between OSMesa and other ways to draw without a
// window.
#pragma once

#include <memory>

namespace scree::render::gl {

class Context {
 public:
  using Function = void (*)();
  virtual ~Context() = default;
  /// Makes this the calling thread's context. Throws RunError.
  virtual void make_current() = 0;
  /// The entry point of an OpenGL function; null if there is none. Needs the context to be current.
  virtual Function function(const char* name) const = 0;
};

/// An OpenGL 3.3 core context without a window, on the processor. Throws RunError.
std::unique_ptr<Context> make_osmesa_context();

}  // namespace scree::render::gl
