#include "sim/response/block_factorization.hpp"

#include "core/rng.hpp"

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace scree {
namespace {

using Block = BlockFactorization::Block;
using Vector = BlockFactorization::Vector;
using Entries = std::vector<std::pair<std::int32_t, std::int32_t>>;
constexpr int size = BlockFactorization::size;

/// A matrix as sparse blocks and as a dense one.
struct Matrices {
  BlockFactorization sparse;
  Eigen::MatrixXd dense;

  void add(std::int32_t i, std::int32_t j, const Block& block) {
    sparse.add(i, j, block);
    dense.block<size, size>(size * i, size * j) += block;
    if (i != j) dense.block<size, size>(size * j, size * i) += block.transpose();
  }
};

Block random_block(Random& random) {
  return Block::NullaryExpr([&random](Eigen::Index, Eigen::Index) { return random.uniform(-1, 1); });
}

/// Returns a positive definite matrix: a mass for each row, and for each entry J^T J, where J is random,
/// times a factor between 1 and `stiffness`.
Matrices random_matrices(std::int32_t rows, const Entries& entries, double stiffness, Random& random) {
  Matrices made;
  made.sparse.lay_out(rows, entries);
  made.sparse.clear();
  made.dense.setZero(size * rows, size * rows);
  for (std::int32_t k = 0; k < rows; ++k) made.add(k, k, Block::Identity() * random.uniform(0.5, 2));
  for (const auto& [i, j] : entries) {
    const double factor = std::pow(stiffness, random.uniform(0, 1));
    const Block ji = random_block(random), jj = random_block(random);
    made.add(i, i, factor * ji.transpose() * ji);
    made.add(j, j, factor * jj.transpose() * jj);
    made.add(i, j, -factor * ji.transpose() * jj);
  }
  return made;
}

/// Returns about `degree` random entries a row, in random order; some of them are given twice.
Entries random_entries(std::int32_t rows, double degree, Random& random) {
  Entries entries;
  const auto any = [&] { return std::min(static_cast<std::int32_t>(random.uniform(0, rows)), rows - 1); };
  for (int k = 0; k < static_cast<int>(degree * rows); ++k) {
    const std::int32_t i = any(), j = any();
    if (i != j) entries.emplace_back(i, j);
  }
  return entries;
}

Vector random_vector(std::int32_t rows, Random& random) {
  return Vector::NullaryExpr(size * rows, [&random](Eigen::Index) { return random.uniform(-1, 1); });
}

TEST(BlockFactorization, SolvesAsADenseOneDoes) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    Random random(41, seed);
    const auto rows = static_cast<std::int32_t>(random.uniform(1, 40));
    const double stiffness = seed % 2 == 0 ? 1 : 1e6;
    Matrices made = random_matrices(rows, random_entries(rows, 3, random), stiffness, random);
    ASSERT_TRUE(made.sparse.factorize());
    const Vector b = random_vector(rows, random);
    const Vector x = made.sparse.solve(b);
    const Vector exact =
        made.dense.cast<long double>().partialPivLu().solve(b.cast<long double>()).cast<double>();
    // Backward stable: the error is that of rounding times the condition, which is about the stiffness.
    EXPECT_LT((x - exact).norm(), 1e-13 * stiffness * exact.norm()) << "seed " << seed;
    EXPECT_LT((made.dense * x - b).norm(), 1e-14 * made.dense.norm() * x.norm()) << "seed " << seed;
  }
}

TEST(BlockFactorization, IsSetAnew) {
  Random random(43, 0);
  const Entries entries = random_entries(12, 2, random);
  Matrices made = random_matrices(12, entries, 1, random);
  ASSERT_TRUE(made.sparse.factorize());
  const Vector b = random_vector(12, random);
  const auto scaled_anew = [&](double scale) {
    made.sparse.clear();
    for (std::int32_t i = 0; i < 12; ++i) {
      for (std::int32_t j = 0; j <= i; ++j) {
        const Block block = made.dense.block<size, size>(size * i, size * j);
        if (!block.isZero(0)) made.sparse.add(i, j, scale * block);
      }
    }
    EXPECT_TRUE(made.sparse.factorize());
    return made.sparse.solve(b);
  };
  const Vector first = scaled_anew(1);
  // Scaled by a power of two: the same bits, since there is no square root.
  EXPECT_EQ(scaled_anew(8) * 8, first);
  EXPECT_EQ(scaled_anew(0.5) * 0.5, first);
}

/// A hub among many bodies comes last, so that it couples none of them.
TEST(BlockFactorization, EliminatesHubsLast) {
  const auto cost_of = [](std::int32_t rows, const Entries& entries) {
    BlockFactorization made;
    made.lay_out(rows, entries);
    return made.cost();
  };
  constexpr std::int32_t rows = 50;
  for (const std::int32_t hub : {0, 17, rows - 1}) {
    Entries star;
    for (std::int32_t k = 0; k < rows; ++k)
      if (k != hub) star.emplace_back(hub, k);
    Entries chain;
    for (std::int32_t k = 1; k < rows; ++k) chain.emplace_back(k - 1, k);
    EXPECT_EQ(cost_of(rows, star), cost_of(rows, chain)) << "hub " << hub;
  }
  double of_diagonal = 0;
  for (int c = 0; c < size; ++c) of_diagonal += c * c;
  EXPECT_EQ(cost_of(rows, {}), rows * of_diagonal);
}

TEST(BlockFactorization, SaysWhereAPivotIsNone) {
  for (const double bad : {0.0, static_cast<double>(NAN), static_cast<double>(INFINITY)}) {
    BlockFactorization made;
    made.lay_out(2, {{0, 1}});
    made.clear();
    made.add(0, 0, Block::Identity());
    Block block = Block::Identity();
    block(3, 3) = bad;
    made.add(1, 1, block);
    EXPECT_FALSE(made.factorize());
  }
}

}  // namespace
}  // namespace scree
