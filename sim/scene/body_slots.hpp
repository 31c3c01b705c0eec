// The items of `bodies`, each with the range of bodies that it stands for. Bodies are counted before any is
// made.
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
  std::size_t index;  ///< index of the entry in `bodies`
  BodyRange bodies;
  std::int32_t material;              ///< index of the material; -1: each row of the file gives its own
  TimeGrid::Steps steps;              ///< steps in whose states the bodies exist
  std::unique_ptr<BodyFile> file{};   ///< file of the bodies; null if there is none
  std::unique_ptr<SceneMesh> mesh{};  ///< mesh whose triangles are the bodies; null if there is none
  std::unique_ptr<Hull> hull{};       ///< hull of all the bodies; null if the entry has no polyhedron
};

/// Returns one slot for each entry, in order. Writes the absolute paths of files into the entries. Throws
/// InputError if there are too many bodies, if a whole run of them needs more memory than it may take, or if
/// a file, a material, a name or a lifetime is wrong.
std::vector<BodySlot> body_slots(std::vector<BodyEntry>& entries, const std::filesystem::path& scene,
                                 const MemoryBudget& memory, const TimeGrid& grid,
                                 const MaterialNames& materials, Reader& reader);

}  // namespace scree
