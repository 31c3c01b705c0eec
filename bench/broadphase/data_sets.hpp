// The data sets of the broad-phase benchmarks: balls and boxes at random places. The random numbers of an
// object are seeded by its number, so that a set is the same on every machine and for any number of threads.
#pragma once

#include "broadphase/broad_phase.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace scree::bench {

/// Returns the bounds of n objects (m) of the data set with the given name. Unless noted otherwise, the
/// centres are uniform in a cube, and the side of the cube follows from the share of its volume that the
/// objects would fill.
///   A         balls of radius 0.5, share 0.5: 12/pi = 3.82 pairs per object
///   B         radius log-uniform from 0.01 to 1, share 0.3
///   C         radius 1, but 50 with probability 1e-4, share 0.3
///   log:R     radius log-uniform from 1/R to 1, share 0.3; three decades are log:1000
///   volume:R  radius from 1/R to 1, with equal volume in each octave, share 0.3; the density of radii goes
///             as r^-4, so the largest of n is about n^(1/3) times the smallest, if R allows it
///   giant     A, but the first ball, in the middle, is 1000 times as wide: up to n = 1e9 it meets all others
///   slab      A, but the first object is a floor, 1000 wide, that reaches in from below by 1
///   plummer   the balls of A in an untruncated Plummer sphere, with as many pairs per object on average
///   boxes     turned boxes with edges from 0.1 to 1, the longest 1, the others log-uniform; pairs as in A
///   line      the balls of A along (1, 1, 1); pairs as in A, except for the rounding of large coordinates
///   clusters  A in two halves, on each axis a hundred of their widths apart
///   point     the balls of A, all in one place: n (n - 1) / 2 pairs
/// Throws InputError for other names, for a ratio R below 1, and for n out of range.
std::vector<Aabb> make_data_set(const std::string& name, std::int64_t n);

/// Returns the names listed above.
const std::vector<std::string>& data_set_names();

}  // namespace scree::bench
