#include "sim/response/block_factorization.hpp"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>

#include <algorithm>
#include <cmath>

namespace scree {

namespace {

using Entries = std::vector<std::pair<std::int32_t, std::int32_t>>;

/// Returns the place of each row in an order of elimination that leaves few entries below the diagonal.
std::vector<std::int32_t> order_of_minimum_degree(std::int32_t rows, const Entries& entries) {
  std::vector<Eigen::Triplet<double>> places;
  for (std::int32_t k = 0; k < rows; ++k) places.emplace_back(k, k, 1.0);
  for (const auto& [i, j] : entries) places.emplace_back(std::max(i, j), std::min(i, j), 1.0);
  Eigen::SparseMatrix<double> pattern(rows, rows);
  pattern.setFromTriplets(places.begin(), places.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> rows_in_order;
  Eigen::AMDOrdering<int>()(pattern, rows_in_order);
  std::vector<std::int32_t> position(static_cast<std::size_t>(rows));
  for (std::int32_t k = 0; k < rows; ++k) position[static_cast<std::size_t>(rows_in_order.indices()[k])] = k;
  return position;
}

/// Subtracts a b^T. Compilers turn loops along columns into SIMD instructions, with the same result.
void subtract_product(const BlockFactorization::Block& a, const BlockFactorization::Block& b,
                      BlockFactorization::Block& from) {
  constexpr int size = BlockFactorization::size;
  for (int c = 0; c < size; ++c) {
    double column[size];
    for (int r = 0; r < size; ++r) column[r] = from(r, c);
    for (int s = 0; s < size; ++s) {
      for (int r = 0; r < size; ++r) column[r] -= a(r, s) * b(c, s);
    }
    for (int r = 0; r < size; ++r) from(r, c) = column[r];
  }
}

/// Sets `scaled` to block L^-T, and `block` to block (D L^T)^-1, for a factorized block L D L^T.
void divide_by_transpose(const BlockFactorization::Block& factors, BlockFactorization::Block& block,
                         BlockFactorization::Block& scaled) {
  constexpr int size = BlockFactorization::size;
  for (int c = 0; c < size; ++c) {
    double column[size];
    for (int r = 0; r < size; ++r) column[r] = block(r, c);
    for (int s = 0; s < c; ++s) {
      for (int r = 0; r < size; ++r) column[r] -= factors(c, s) * scaled(r, s);
    }
    for (int r = 0; r < size; ++r) scaled(r, c) = column[r];
    const double inverse = 1 / factors(c, c);
    for (int r = 0; r < size; ++r) block(r, c) = inverse * column[r];
  }
}

}  // namespace

void BlockFactorization::lay_out(std::int32_t rows, const Entries& entries) {
  const auto n = static_cast<std::size_t>(rows);
  position_ = order_of_minimum_degree(rows, entries);
  std::vector<std::vector<std::int32_t>> columns(n);
  for (const auto& [i, j] : entries) {
    const auto [column, row] =
        std::minmax(position_[static_cast<std::size_t>(i)], position_[static_cast<std::size_t>(j)]);
    if (column != row) columns[static_cast<std::size_t>(column)].push_back(row);
  }
  first_.assign(1, 0);
  row_.clear();
  for (std::size_t k = 0; k < n; ++k) {
    auto& column = columns[k];
    std::sort(column.begin(), column.end());
    column.erase(std::unique(column.begin(), column.end()), column.end());
    row_.insert(row_.end(), column.begin(), column.end());
    first_.push_back(row_.size());
    if (column.empty()) continue;
    // The elimination of a column couples all rows below it; the first of these passes them on.
    auto& parent = columns[static_cast<std::size_t>(column.front())];
    parent.insert(parent.end(), column.begin() + 1, column.end());
  }
}

double BlockFactorization::cost() const {
  double cost = 0;
  for (std::size_t k = 0; k + 1 < first_.size(); ++k) {
    const auto below = static_cast<double>(size * (first_[k + 1] - first_[k]));
    for (int c = 0; c < size; ++c) cost += (below + c) * (below + c);
  }
  return cost;
}

void BlockFactorization::clear() {
  below_.assign(row_.size(), Block::Zero());
  diagonal_.assign(first_.size() - 1, Block::Zero());
}

/// Returns the place in below_ of an entry; both numbers are places in the order of elimination.
std::size_t BlockFactorization::place_in_column(std::int32_t column, std::int32_t row) const {
  const auto k = static_cast<std::size_t>(column);
  const auto begin = row_.begin() + static_cast<std::ptrdiff_t>(first_[k]);
  const auto end = row_.begin() + static_cast<std::ptrdiff_t>(first_[k + 1]);
  return static_cast<std::size_t>(std::lower_bound(begin, end, row) - row_.begin());
}

void BlockFactorization::add(std::int32_t i, std::int32_t j, const Block& block) {
  const std::int32_t a = position_[static_cast<std::size_t>(i)];
  const std::int32_t b = position_[static_cast<std::size_t>(j)];
  if (a == b)
    diagonal_[static_cast<std::size_t>(a)] += block;
  else if (a > b)
    below_[place_in_column(b, a)] += block;
  else
    below_[place_in_column(a, b)] += block.transpose();
}

/// Factorizes a block on the diagonal in its place.
bool BlockFactorization::eliminate_diagonal(Block& diagonal) {
  for (int c = 0; c < size; ++c) {
    const double pivot = diagonal(c, c);
    if (pivot == 0 || !std::isfinite(pivot)) return false;
    for (int s = c + 1; s < size; ++s) {
      const double factor = diagonal(s, c) / pivot;
      for (int r = s; r < size; ++r) diagonal(r, s) -= factor * diagonal(r, c);
    }
    for (int r = c + 1; r < size; ++r) diagonal(r, c) /= pivot;
  }
  return true;
}

/// Makes L, and L D in scaled_, from the blocks below a diagonal that has been factorized.
void BlockFactorization::eliminate_below(std::size_t column) {
  const Block& diagonal = diagonal_[column];
  scaled_.resize(std::max(scaled_.size(), first_[column + 1] - first_[column]));
  for (std::size_t e = first_[column]; e < first_[column + 1]; ++e) {
    divide_by_transpose(diagonal, below_[e], scaled_[e - first_[column]]);
  }
}

/// Subtracts L D L^T of an eliminated column from the columns after it.
void BlockFactorization::subtract_from_later_columns(std::size_t column) {
  const std::size_t end = first_[column + 1];
  for (std::size_t e = first_[column]; e < end; ++e) {
    const auto later = static_cast<std::size_t>(row_[e]);
    const Block& scaled = scaled_[e - first_[column]];
    subtract_product(below_[e], scaled, diagonal_[later]);
    std::size_t place = first_[later];
    for (std::size_t f = e + 1; f < end; ++f) {
      while (row_[place] != row_[f]) ++place;
      subtract_product(below_[f], scaled, below_[place]);
    }
  }
}

bool BlockFactorization::factorize() {
  for (std::size_t column = 0; column < diagonal_.size(); ++column) {
    if (!eliminate_diagonal(diagonal_[column])) return false;
    eliminate_below(column);
    subtract_from_later_columns(column);
  }
  return true;
}

BlockFactorization::Vector BlockFactorization::solve(const Vector& b) const {
  using Segment = Eigen::Matrix<double, size, 1>;
  std::vector<Segment> y(diagonal_.size());
  for (std::size_t k = 0; k < y.size(); ++k)
    y[static_cast<std::size_t>(position_[k])] = b.segment<size>(static_cast<Eigen::Index>(size * k));
  for (std::size_t k = 0; k < y.size(); ++k) {
    diagonal_[k].triangularView<Eigen::UnitLower>().solveInPlace(y[k]);
    for (std::size_t e = first_[k]; e < first_[k + 1]; ++e)
      y[static_cast<std::size_t>(row_[e])] -= below_[e] * y[k];
  }
  for (std::size_t k = y.size(); k-- > 0;) {
    y[k] = y[k].cwiseQuotient(diagonal_[k].diagonal());
    for (std::size_t e = first_[k]; e < first_[k + 1]; ++e)
      y[k] -= below_[e].transpose() * y[static_cast<std::size_t>(row_[e])];
    diagonal_[k].triangularView<Eigen::UnitLower>().transpose().solveInPlace(y[k]);
  }
  Vector x(b.size());
  for (std::size_t k = 0; k < y.size(); ++k)
    x.segment<size>(static_cast<Eigen::Index>(size * k)) = y[static_cast<std::size_t>(position_[k])];
  return x;
}

}  // namespace scree
