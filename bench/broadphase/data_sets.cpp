#include "bench/broadphase/data_sets.hpp"

#include "broadphase/bounds.hpp"
#include "core/error.hpp"
#include "core/rng.hpp"

#include <cmath>

namespace scree::bench {

namespace {

double radius(const std::string& name, Random& random) {
  const double u = random.uniform();
  if (name == "A") return 0.5;
  if (name == "B") return std::pow(10.0, 2 * (u - 1));
  if (name == "C") return u < 1e-4 ? 50.0 : 1.0;
  throw InputError("data set " + name + ": one of A, B, C");
}

}  // namespace

std::vector<Aabb> make_data_set(const std::string& name, std::int64_t n) {
  const double share = name == "A" ? 0.5 : 0.3;
  std::vector<double> radii;
  double volume = 0;
  for (std::int64_t i = 0; i < n; ++i) {
    Random random(1, static_cast<std::uint64_t>(i));
    radii.push_back(radius(name, random));
    volume += 4 * pi / 3 * std::pow(radii.back(), 3);
  }
  const double side = std::cbrt(volume / share);
  std::vector<Aabb> boxes;
  for (std::int64_t i = 0; i < n; ++i) {
    Random random(2, static_cast<std::uint64_t>(i));
    const double r = radii[static_cast<std::size_t>(i)];
    Aabb box;
    for (int a = 0; a < 3; ++a) {
      const double x = random.uniform(-side / 2, side / 2);
      box.lo[a] = round_down(x - r);
      box.hi[a] = round_up(x + r);
    }
    boxes.push_back(box);
  }
  return boxes;
}

}  // namespace scree::bench
