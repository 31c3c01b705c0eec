// One instant of a run, on the host: what is recorded, measured and drawn.
#pragma once

#include "core/bodies.hpp"

#include <cstdint>

namespace scree {

struct Snapshot {
  double time = 0;        ///< s
  std::int64_t step = 0;  ///< steps done
  BodyTable bodies;
};

}  // namespace scree
