// Bodies in lanes: eight side by side, so that one instruction works on all of them, and the kernels that do;
// those of contacts are in sim/contacts/visit_kernels.hpp.
#pragma once

#include "sim/laws/simd/wide_laws.hpp"

#include <cstdint>
#include <vector>

namespace scree::simd {

/// A number of each of eight bodies.
struct alignas(64) Lane {
  double at[width];
};
struct LaneVec {
  Lane x, y, z;
};

/// Eight bodies that turn freely, as Top has them.
struct Tops {
  Lane w;
  LaneVec v, spin, inverse_inertia;
  Lane drift;        ///< of the rotational energy (J)
  std::int32_t far;  ///< a bit for each that would turn further than one step of the splitting may
};

struct Kernels {
  /// Turns for a time (s) those that do not turn far.
  void (*turn)(Tops&, double dt, bool fourth_order);
};

/// Those that this processor can run, the widest last. All give the same bits.
struct NamedKernels {
  const char* name;
  const Kernels* kernels;
};
std::vector<NamedKernels> supported_kernels();

/// The widest of them.
const Kernels& kernels();

// One for each way in which kernels.cpp is compiled; not all exist on every processor.
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
