#include "sim/cli/picture_context.hpp"

#include "core/error.hpp"
#include "sim/cli/process_pool.hpp"

#include <fmt/format.h>

namespace scree::cli {

namespace {

/// Returns the error of the renderer; empty if it draws.
std::string trouble_with(render::ContextChoice context) {
  try {
    render::make_renderer(context, 16, 16);
    return {};
  } catch (const std::exception& error) {
    return error.what();
  }
}

}  // namespace

void expect_context(render::ContextChoice context) {
  if (context == render::ContextChoice::automatic) return;
  const char* name = context == render::ContextChoice::egl ? "egl" : "osmesa";
  // The renderer is tried in a child process, because a driver may crash, and does not survive a later fork.
  in_processes(
      1, 1, [context](int) { return trouble_with(context); },
      [name](int, const ProcessResult& result) {
        const std::string& trouble = result.death.empty() ? result.text : result.death;
        if (!trouble.empty()) throw InputError(fmt::format("--context {}: {}", name, trouble));
      });
}

}  // namespace scree::cli
