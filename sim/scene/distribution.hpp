// Sizes given as one value or as a distribution to draw from.
#pragma once

#include "core/math.hpp"
#include "core/rng.hpp"

#include <array>
#include <optional>
#include <vector>

namespace scree {

/// Exactly one member is given.
template <class T>
struct Distribution {
  std::optional<T> value;
  std::optional<std::array<T, 2>> uniform;        ///< between two values; each component by itself
  std::optional<std::array<double, 3>> powerlaw;  ///< smallest, largest, exponent
  std::vector<T> choose;                          ///< each as likely as the others
};

/// The share u of the values is smaller: the quantile of the density ~ x^-exponent on [low, high], low > 0.
double powerlaw_quantile(double low, double high, double exponent, double u);

/// Radii. A draw takes one number of the stream, whatever the distribution.
double draw(const Distribution<double>& sizes, Random& random);
/// Edge lengths. A draw takes three numbers for uniform, and one else; powerlaw makes cubes.
Vec3 draw(const Distribution<Vec3>& sizes, Random& random);

}  // namespace scree
