// What a running scene lets be seen of its workings; made when asked for.
#pragma once

#include "core/math.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace scree {

/// The bodies of a potentially colliding pair, i < j.
using BodyPair = std::array<std::int32_t, 2>;

/// A contact of the last substep.
struct ContactForce {
  std::int32_t i;
  std::int32_t j;
  Vec3 force;  ///< on j (N)
  Vec3 point;  ///< where it acts (m)
};

/// An occupied cell of the hierarchical grid.
struct OccupiedCell {
  std::int32_t level;  ///< counted from the smallest cells
  Vec3 low;            ///< its lower corner (m)
  double width;        ///< m

  friend bool operator==(const OccupiedCell&, const OccupiedCell&) = default;
};

/// The hierarchical grid of the last pairs. Empty for other methods.
struct GridOccupancy {
  std::vector<double> width;        ///< of each level's cells (m)
  std::vector<std::int32_t> level;  ///< of each body; 0 for those in no cell: planes, and absent ones
  std::vector<OccupiedCell> cells;  ///< each once
};

}  // namespace scree
