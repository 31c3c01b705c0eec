#include "sim/record/run_identity.hpp"

#include "core/bodies.hpp"
#include "sim/record/build_info.hpp"

#include <fmt/format.h>

#include <sstream>
#include <utility>

namespace scree {

namespace {

/// Returns the first line in which two texts differ, as it is in each of them.
std::pair<std::string, std::string> first_difference(const std::string& a, const std::string& b) {
  std::istringstream lines_a(a), lines_b(b);
  std::string line_a, line_b;
  do {
    line_a.clear();
    line_b.clear();
    std::getline(lines_a, line_a);
    std::getline(lines_b, line_b);
  } while (line_a == line_b && lines_a && lines_b);
  return {line_a, line_b};
}

}  // namespace

void RunIdentity::archive(Archive& archive) {
  archive("version", version);
  archive("commit", commit);
  archive("space", space);
  archive("scene", scene);
  archive("bodies", bodies);
}

RunIdentity identity_of(const Scene& scene, const std::string& space) {
  const BuildInfo build = build_info();
  return {.version = build.version,
          .commit = build.commit,
          .space = space,
          .scene = scene.resolved,
          .bodies = hash_of(scene.bodies)};
}

std::string difference_of(const RunIdentity& saved, const RunIdentity& present) {
  if (saved.version != present.version)
    return fmt::format("the checkpoint is of version {}, and this is {}", saved.version, present.version);
  if (saved.scene != present.scene) {
    const auto [was, is] = first_difference(saved.scene, present.scene);
    return fmt::format("the checkpoint is of another scene: it has `{}`, this one `{}`", was, is);
  }
  if (saved.bodies != present.bodies)
    return "the bodies differ from those of the checkpoint: a file they are read from has changed";
  if (saved.space != present.space)
    return fmt::format("the checkpoint is of a run on {0}, and this is one on {1} (--device {0})",
                       saved.space, present.space);
  return {};
}

}  // namespace scree
