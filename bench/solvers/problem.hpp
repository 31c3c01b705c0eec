// The contact problem of a substep in the form that the literature solves: impulses r of the points, in the
// frame of each (normal, two tangents), such that with u = W r + q
//   u + mu |u_t| n is in the dual of K, r is in K, and the two are at right angles,
// K the product of the points' Coulomb cones |r_t| <= mu r_n (De Saxce and Feng 1998, "The bipotential
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

/// A vector for each point: x along the normal, y and z along the tangents.
using PointVectors = std::vector<Vec3>;

/// A symmetric matrix of 3 x 3 blocks, of which each row keeps those that are not zero, by column.
class BlockMatrix {
 public:
  struct Block {
    std::int32_t column;
    Mat3 value;
  };
  using Rows = std::vector<std::vector<Block>>;

  BlockMatrix() = default;
  /// From the rows of the lower triangle: the columns ascend and end with the diagonal, which each row has.
  explicit BlockMatrix(const Rows& lower);

  std::size_t size() const { return diagonal_.size(); }  ///< in blocks
  std::size_t count() const { return blocks_.size(); }   ///< of blocks, in both triangles
  const Block* begin(std::size_t row) const { return blocks_.data() + begin_[row]; }
  const Block* end(std::size_t row) const { return blocks_.data() + begin_[row + 1]; }
  const Mat3& diagonal(std::size_t row) const { return diagonal_[row]; }

  /// One block row of the product with x.
  Vec3 times(std::size_t row, const PointVectors& x) const {
    Vec3 sum = Vec3::Zero();
    for (const Block* b = begin(row); b != end(row); ++b)
      sum += b->value * x[static_cast<std::size_t>(b->column)];
    return sum;
  }

 private:
  std::vector<std::size_t> begin_;  // of each row; one more than rows
  std::vector<Block> blocks_;
  std::vector<Mat3> diagonal_;
};

struct Problem {
  BlockMatrix delassus;          ///< W (1/kg)
  PointVectors free_velocity;    ///< q: relative velocities without impulses, less their targets (m/s)
  std::vector<double> friction;  ///< mu

  std::size_t size() const { return friction.size(); }  ///< points
};

/// The frame of a contact: its columns are the normal and two tangents, right-handed.
Mat3 frame_of(const ContactProblem::Contact& contact);

/// W = J M^-1 J^T, of the points of bodies that are free, q and mu.
Problem assemble(const ContactProblem& scene);

/// The impulses that the run had found (N s).
PointVectors impulses_of(const ContactProblem& scene);

}  // namespace scree::bench
