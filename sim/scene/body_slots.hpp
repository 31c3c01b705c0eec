// The items of `bodies`, each with the bodies that it stands for, counted before any is made.
#pragma once

#include "sim/scene/body_file.hpp"
#include "sim/scene/keys.hpp"
#include "sim/scene/materials.hpp"
#include "sim/scene/memory.hpp"
#include "sim/scene/mesh_file.hpp"
#include "sim/scene/time_grid.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace scree {

struct BodySlot {
  const BodyEntry* entry;
  std::size_t index;  ///< of the entry in `bodies`
  BodyRange bodies;
  std::int32_t material;              ///< -1: each row of the file says its own
  TimeGrid::Steps steps;              ///< in whose states the bodies are there
  std::unique_ptr<BodyFile> file{};   ///< where they come from, if from one
  std::unique_ptr<SceneMesh> mesh{};  ///< whose triangles they are, if they are
  std::unique_ptr<Hull> hull{};       ///< of all of them, if they are polyhedra
};

/// One slot for each entry, in order. Writes where files were found into its entry. Throws InputError if the
/// bodies are too many, or need more memory for the whole run than it may take, and where a file, a material,
/// a name or a lifetime is wrong.
std::vector<BodySlot> body_slots(std::vector<BodyEntry>& entries, const std::filesystem::path& scene,
                                 const MemoryBudget& memory, const TimeGrid& grid,
                                 const MaterialNames& materials, Reader& reader);

}  // namespace scree
