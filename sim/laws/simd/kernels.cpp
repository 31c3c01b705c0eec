// The kernels of bodies, compiled once for each instruction set, which SCREE_SIMD names. This file calls
// nothing that other sources share, so that no function of theirs is compiled with instructions that the
// program may not use.
#include "sim/laws/simd/kernels/turning.hpp"
#include "sim/laws/simd/simd.hpp"

namespace scree::simd::SCREE_SIMD {

extern const Kernels kernels = {.turn = turn};

}  // namespace scree::simd::SCREE_SIMD
