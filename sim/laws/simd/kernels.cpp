// Compiled once for each instruction set; SCREE_SIMD names it. It calls nothing that other sources share, so
// that no function of theirs is compiled for more than the program may use.
#include "sim/laws/simd/kernels/turning.hpp"
#include "sim/laws/simd/simd.hpp"

namespace scree::simd::SCREE_SIMD {

extern const Kernels kernels = {.turn = turn};

}  // namespace scree::simd::SCREE_SIMD
