// The text file of a contact problem, for other programs and for later runs. It consists of matrices in
// Matrix Market's form, one after the other. The comment after each header has the matrix's name:
//   W         coordinate, symmetric (its lower triangle), 3 m x 3 m: rows 3 k + 1 to 3 k + 3 are the normal
//             and the two tangents of point k (1/kg)
//   q         array, 3 m x 1 (m/s)
//   mu        array, m x 1
//   bodies    array, a row each: 1/mass; inverse inertia xx, xy, xz, yy, yz, zz; velocity; spin
//   contacts  array, a row each: i, j, first point (all from 0), points, normal, mu, 1 if between balls
//   points    array, a row each: arm of i, arm of j, target, impulse found by the run
// W, q and mu follow from the last three matrices (ContactProblem). Numbers have the fewest digits that are
// read back to the same bits.
#pragma once

#include "bench/solvers/problem.hpp"

#include <filesystem>

namespace scree::bench {

struct ProblemFile {
  ContactProblem scene;
  Problem problem;
};

/// Writes a problem. Throws RunError if the file cannot be written.
void write_problem(const std::filesystem::path& file, const ProblemFile& content);

/// Reads a problem. Throws InputError if the file cannot be read or is not valid.
ProblemFile read_problem(const std::filesystem::path& file);

}  // namespace scree::bench
