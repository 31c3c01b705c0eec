// final.csv: where a run left its free bodies, in the format that scenes read (sim/scene/body_file.hpp).
#pragma once

#include "core/bodies.hpp"
#include "sim/scene/scene.hpp"

#include <filesystem>

namespace scree {

/// The folder beside it with the hulls that it names, each an OBJ file.
inline constexpr const char* hulls_name = "hulls";

/// Writes the free bodies that are there, in their order. Numbers are the shortest that read back to the same
/// double, so that a run which starts from the file has the same state to the bit; hulls are made again from
/// their vertices, which gives their faces and moments to rounding. A mass that follows from the material's
/// density is left out. Throws RunError if the file cannot be written.
void write_final_state(const BodyTable& bodies, const Scene& scene, const std::filesystem::path& file);

}  // namespace scree
