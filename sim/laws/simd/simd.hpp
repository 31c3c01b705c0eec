// Bodies in SIMD lanes: eight side by side, so that one instruction works on all of them, and the kernels
// that work on them. The kernels of contacts are in sim/contacts/visit_kernels.hpp.
#pragma once

#include "sim/laws/simd/wide_laws.hpp"

#include <cstdint>
#include <vector>

namespace scree::simd {

/// One number of each of eight bodies.
struct alignas(64) Lane {
  double at[width];
};
struct LaneVec {
  Lane x, y, z;
};

/// Eight bodies that turn freely, with the members of RotatingBody.
struct RotatingBodies {
  Lane w;
  LaneVec v, spin, inverse_inertia;
  Lane drift;        ///< drift of the rotational energy (J)
  std::int32_t far;  ///< one bit for each body that would turn further than one splitting step may
};

struct Kernels {
  /// Turns all bodies for a time (s), except those that turn far (RotatingBodies::far).
  void (*turn)(RotatingBodies&, double dt, bool fourth_order);
};

/// The kernels of one instruction set, with its name.
struct NamedKernels {
  const char* name;
  const Kernels* kernels;
};
/// Returns the kernels that this processor can run, the widest last. All of them give the same bits.
std::vector<NamedKernels> supported_kernels();

/// Returns the widest of the supported kernels.
const Kernels& kernels();

// Each way in which kernels.cpp is compiled defines one of these; not all exist on every processor.
namespace baseline {
extern const Kernels kernels;
}
namespace avx2 {
extern const Kernels kernels;
}
namespace avx512 {
extern const Kernels kernels;
}

}  // namespace scree::simd
