// Loops that a GPU takes apart.
#pragma once

/// SCREE_UNROLL stands before a loop of a fixed number of turns. On a GPU it is unrolled, so that what is
/// listed by its index is in registers.
#ifdef __CUDA_ARCH__
#define SCREE_UNROLL _Pragma("unroll")
#else
#define SCREE_UNROLL
#endif

namespace scree {

/// Whether what is compiled runs on a GPU. Its threads wait long for memory, and so they ask for all that
/// they need before they use the first of it; a processor would only have to put it aside.
#ifdef __CUDA_ARCH__
inline constexpr bool is_gpu_code = true;
#else
inline constexpr bool is_gpu_code = false;
#endif

}  // namespace scree
