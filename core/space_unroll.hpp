// Loops that a GPU takes apart.
#pragma once

/// Stands before a loop of a fixed number of turns. On a GPU it is unrolled, so that what is listed by its
/// index is in registers.
#ifdef __CUDA_ARCH__
#define SCREE_UNROLL _Pragma("unroll")
#else
#define SCREE_UNROLL
#endif
