#include "render/gl/functions.hpp"

#include "core/error.hpp"

#include <string>

namespace scree::render::gl {

Functions::Functions(const Context& context) {
  const auto load = [&context](const char* name) {
    const Context::Function function = context.function(name);
    if (function == nullptr) throw RunError(std::string("the OpenGL context lacks ") + name);
    return function;
  };
#define SCREE_GL_LOAD(name, type) name = reinterpret_cast<PFNGL##type##PROC>(load("gl" #name));
  SCREE_GL_FUNCTIONS(SCREE_GL_LOAD)
#undef SCREE_GL_LOAD
}

}  // namespace scree::render::gl
