// final.csv: the free bodies at the end of a run, in the format that scenes read (sim/scene/body_file.hpp).
#pragma once

#include "core/bodies.hpp"
#include "sim/scene/scene.hpp"

#include <filesystem>

namespace scree {

/// The name of the folder with the hulls that final.csv names, each an OBJ file.
inline constexpr const char* hulls_name = "hulls";

/// Writes the free bodies that are present, in their order. Numbers are the shortest that read back to the
/// same double, so that a run that starts from the file has the same state to the bit. Hulls are made again
/// from their vertices, which gives the same faces and moments to rounding. A mass that follows from the
/// material's density is left out. Throws RunError if the file cannot be written.
void write_final_state(const BodyTable& bodies, const Scene& scene, const std::filesystem::path& file);

}  // namespace scree
