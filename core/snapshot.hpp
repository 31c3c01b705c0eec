// One instant of a run, on the host. Snapshots are recorded, measured and drawn.
#pragma once

#include "core/bodies.hpp"

#include <cstdint>

namespace scree {

struct Snapshot {
  double time = 0;        ///< time (s)
  std::int64_t step = 0;  ///< number of steps done
  BodyTable bodies;
};

}  // namespace scree
