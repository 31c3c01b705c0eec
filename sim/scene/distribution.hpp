// Sizes given as one value or as a distribution to draw from.
#pragma once

#include "core/math.hpp"
#include "core/rng.hpp"

#include <array>
#include <optional>
#include <vector>

namespace scree {

/// A size that is one value or a distribution. Exactly one member is given.
template <class T>
struct Distribution {
  std::optional<T> value;
  std::optional<std::array<T, 2>> uniform;  ///< uniform between two values; each component is drawn by itself
  std::optional<std::array<double, 3>> powerlaw;  ///< smallest, largest, exponent
  std::vector<T> choose;                          ///< values, each as likely as the others
};

/// Returns the quantile u of the density ~ x^-exponent on [low, high], low > 0: the share u of the values is
/// smaller.
double powerlaw_quantile(double low, double high, double exponent, double u);

/// Draws a radius. A draw takes one number of the stream, whatever the distribution.
double draw(const Distribution<double>& sizes, Random& random);
/// Draws edge lengths. A draw takes three numbers of the stream for `uniform`, and one otherwise; `powerlaw`
/// makes cubes.
Vec3 draw(const Distribution<Vec3>& sizes, Random& random);

}  // namespace scree
