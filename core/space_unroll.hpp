// Loops that are unrolled on a GPU.
#pragma once

/// SCREE_UNROLL is put before a loop with a fixed number of turns. On a GPU the loop is unrolled, so that
/// arrays that are indexed in it can be in registers.
#ifdef __CUDA_ARCH__
#define SCREE_UNROLL _Pragma("unroll")
#else
#define SCREE_UNROLL
#endif

namespace scree {

/// Whether the code that is compiled runs on a GPU. The threads of a GPU wait long for memory, so they load
/// all that they need before they use the first of it; a processor would only have to spill it.
#ifdef __CUDA_ARCH__
inline constexpr bool is_gpu_code = true;
#else
inline constexpr bool is_gpu_code = false;
#endif

}  // namespace scree
