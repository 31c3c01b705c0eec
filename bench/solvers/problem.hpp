// The contact problem of a substep in the form used in the literature. The unknowns are the impulses r of the
// points, each in its own frame (normal, two tangents), such that with u = W r + q
//   u + mu |u_t| n is in the dual of K, r is in K, and the two are at right angles.
// K is the product of the points' Coulomb cones |r_t| <= mu r_n (De Saxce and Feng 1998, "The bipotential
// method"; Acary, Bremond and Huber 2018, "On solving contact problems with Coulomb friction: formulations
// and numerical comparisons").
#pragma once

#include "core/math.hpp"
#include "sim/observe/inspection.hpp"

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace scree::bench {

/// One vector for each point: x along the normal, y and z along the tangents.
using PointVectors = std::vector<Vec3>;

/// A symmetric matrix of 3 x 3 blocks. Each row keeps its nonzero blocks, sorted by column.
class BlockMatrix {
 public:
  struct Block {
    std::int32_t column;
    Mat3 value;
  };
  using Rows = std::vector<std::vector<Block>>;

  BlockMatrix() = default;
  /// Makes the matrix from the rows of its lower triangle. The columns of each row must ascend and end with
  /// the diagonal.
  explicit BlockMatrix(const Rows& lower);

  std::size_t size() const { return diagonal_.size(); }  ///< number of block rows
  std::size_t count() const { return blocks_.size(); }   ///< number of blocks, in both triangles
  const Block* begin(std::size_t row) const { return blocks_.data() + begin_[row]; }
  const Block* end(std::size_t row) const { return blocks_.data() + begin_[row + 1]; }
  const Mat3& diagonal(std::size_t row) const { return diagonal_[row]; }

  /// Returns one block row of the product with x.
  Vec3 times(std::size_t row, const PointVectors& x) const {
    Vec3 sum = Vec3::Zero();
    for (const Block* b = begin(row); b != end(row); ++b)
      sum += b->value * x[static_cast<std::size_t>(b->column)];
    return sum;
  }

 private:
  std::vector<std::size_t> begin_;  // first block of each row, and the end of the last row
  std::vector<Block> blocks_;
  std::vector<Mat3> diagonal_;
};

struct Problem {
  BlockMatrix delassus;          ///< W (1/kg)
  PointVectors free_velocity;    ///< q: relative velocities without impulses, less their targets (m/s)
  std::vector<double> friction;  ///< mu

  std::size_t size() const { return friction.size(); }  ///< number of points
};

/// Returns the frame of a contact. Its columns are the normal and two tangents, right-handed.
Mat3 frame_of(const ContactProblem::Contact& contact);

/// Computes W = J M^-1 J^T from the free bodies of each point, and q and mu.
Problem assemble(const ContactProblem& scene);

/// Returns the impulses that the captured run found (N s).
PointVectors impulses_of(const ContactProblem& scene);

}  // namespace scree::bench
