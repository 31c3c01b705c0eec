// The factorization of sparse symmetric matrices whose entries are blocks, one for each two bodies in
// contact.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace scree {

/// Solves A x = b for a sparse, symmetric and positive definite matrix A of 6 x 6 blocks, by A = L D L^T in
/// an order of minimum degree (Davis 2006, "Direct Methods for Sparse Linear Systems", chapters 4 and 7). D
/// is diagonal. Without a square root anywhere, matrices in other units (scaled by a power of two) give the
/// same result. The columns are eliminated one block at a time: a factorization by single numbers takes
/// several times as long.
class BlockFactorization {
 public:
  static constexpr int size = 6;
  using Block = Eigen::Matrix<double, size, size>;
  using Vector = Eigen::VectorXd;

  /// Lays out a matrix of `rows` x `rows` blocks. Those on its diagonal, and those at `entries` and at their
  /// mirror images, may differ from 0. An entry may be given several times. The blocks take no memory before
  /// clear(), so that cost() can be asked of a matrix that is too large.
  void lay_out(std::int32_t rows, const std::vector<std::pair<std::int32_t, std::int32_t>>& entries);

  /// Returns about how many multiplications a factorization takes.
  double cost() const;

  /// Sets the matrix to 0. Call it after lay_out() and before the matrix is set for each factorization.
  void clear();

  /// Adds a block at (i, j), and its transpose at (j, i). The entry must have been laid out.
  void add(std::int32_t i, std::int32_t j, const Block& block);

  /// Factorizes the matrix. Returns false if a pivot is 0 or not finite; then there is no factorization.
  bool factorize();

  /// Returns the solution x of A x = b, by the last factorization.
  Vector solve(const Vector& b) const;

 private:
  std::size_t place_in_column(std::int32_t column, std::int32_t row) const;
  bool eliminate_diagonal(Block& diagonal);
  void eliminate_below(std::size_t column);
  void subtract_from_later_columns(std::size_t column);

  std::vector<std::int32_t> position_;  // place in the order of elimination of each row of blocks
  std::vector<std::size_t> first_;      // first entry of each column in below_; one more at the end
  std::vector<std::int32_t> row_;       // row of each entry below the diagonal, ascending within a column
  std::vector<Block> below_;            // blocks of A, and of L once factorized
  std::vector<Block> diagonal_;         // blocks of A; once factorized, L below the diagonal and D on it
  std::vector<Block> scaled_;           // L D of the column that is eliminated
};

}  // namespace scree
