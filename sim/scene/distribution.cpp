// Quantiles of distributions, and random draws from them.
#include "sim/scene/distribution.hpp"

#include <algorithm>
#include <cmath>

namespace scree {
namespace {

template <class T>
const T& chosen(const std::vector<T>& values, double u) {
  const auto n = values.size();
  return values[std::min(static_cast<std::size_t>(u * static_cast<double>(n)), n - 1)];
}

double quantile(const std::array<double, 3>& powerlaw, double u) {
  return powerlaw_quantile(powerlaw[0], powerlaw[1], powerlaw[2], u);
}

}  // namespace

// The textbook form, (a^s + u (b^s - a^s))^(1/s) with s = 1 - exponent, overflows for steep laws and cancels
// near s = 0. Both are avoided by measuring from the end where the ratio (x/end)^s is at most 1.
double powerlaw_quantile(double low, double high, double exponent, double u) {
  const double s = 1.0 - exponent;
  const double span = std::log(high / low);
  double x;
  if (s == 0.0) {
    x = low * std::exp(u * span);
  } else if (s < 0.0) {
    x = low * std::exp(std::log1p(u * std::expm1(s * span)) / s);
  } else {
    x = high * std::exp(std::log1p((1.0 - u) * std::expm1(-s * span)) / s);
  }
  return std::clamp(x, low, high);
}

double draw(const Distribution<double>& sizes, Random& random) {
  const double u = random.uniform();
  if (sizes.uniform) return (*sizes.uniform)[0] + u * ((*sizes.uniform)[1] - (*sizes.uniform)[0]);
  if (sizes.powerlaw) return quantile(*sizes.powerlaw, u);
  return sizes.choose.empty() ? *sizes.value : chosen(sizes.choose, u);
}

Vec3 draw(const Distribution<Vec3>& sizes, Random& random) {
  const double u = random.uniform();
  if (sizes.uniform) {
    const auto& [low, high] = *sizes.uniform;
    const Vec3 share(u, random.uniform(), random.uniform());
    return low + share.cwiseProduct(high - low);
  }
  if (sizes.powerlaw) return Vec3::Constant(quantile(*sizes.powerlaw, u));
  return sizes.choose.empty() ? *sizes.value : chosen(sizes.choose, u);
}

}  // namespace scree
