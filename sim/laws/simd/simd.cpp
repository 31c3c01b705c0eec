#include "sim/laws/simd/simd.hpp"

namespace scree::simd {

const Kernels& kernels() {
  static const Kernels& widest = *supported_kernels().back().kernels;
  return widest;
}

}  // namespace scree::simd
