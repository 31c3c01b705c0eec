// The scenes of `scree new`: the files of sim/cli/templates, which are built into the program.
#pragma once

#include <string_view>
#include <vector>

namespace scree::cli {

struct Template {
  std::string_view name;
  std::string_view text;  ///< a scene file; its first line is a comment that says what it is
};

/// Returns the templates, sorted by name.
const std::vector<Template>& templates();

}  // namespace scree::cli
