// The way to OpenGL that the command line asks for.
#pragma once

#include "render/renderer.hpp"

namespace scree::cli {

/// Throws InputError if --context names a way that does not draw here. Left to scree, pictures are worth no
/// run, and only a warning. Not while threads or a GPU are in use, which it leaves unused.
void expect_context(render::ContextChoice context);

}  // namespace scree::cli
