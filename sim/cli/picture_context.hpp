// The check of the way to OpenGL that --context chooses.
#pragma once

#include "render/renderer.hpp"

namespace scree::cli {

/// Throws InputError if --context names a way that does not draw on this machine. With `auto` it does
/// nothing: then missing pictures are only a warning. Must not be called while threads or a GPU are in use,
/// and leaves none in use.
void expect_context(render::ContextChoice context);

}  // namespace scree::cli
