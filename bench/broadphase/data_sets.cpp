#include "bench/broadphase/data_sets.hpp"

#include "broadphase/bounds.hpp"
#include "core/error.hpp"
#include "core/random_orientation.hpp"
#include "core/rng.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <limits>

namespace scree::bench {

namespace {

/// The recipe of a data set. `side` is that of the cube (m).
struct Recipe {
  const char* name;
  double share;                              ///< share of the cube's volume that the objects would fill
  double (*radius)(double u, double ratio);  ///< radius of a ball; null: the objects are boxes
  Vec3 (*place)(Random& random, double side,
                std::int64_t i) = nullptr;  ///< place of object i; null: anywhere in the cube
  Aabb (*first)(double side) = nullptr;     ///< box of the first object; null: like all others
};

double half(double, double) { return 0.5; }
double log_uniform(double u, double ratio) { return std::pow(ratio, u - 1); }
double equal_volumes(double u, double ratio) {
  const double most = std::pow(ratio, 3);
  return std::pow(most - u * (most - 1), -1.0 / 3);
}

Vec3 in_cube(Random& random, double side) {
  Vec3 place;
  for (double& x : place) x = random.uniform(-side / 2, side / 2);
  return place;
}

/// Returns a place in a Plummer sphere, of density (1 + R^2/a^2)^(-5/2). The number of pairs depends on the
/// mean density over the objects, which is 45/1024 of n/a^3.
Vec3 in_plummer_sphere(Random& random, double side, std::int64_t) {
  const double a = std::cbrt(45.0 / 1024) * side;
  const double distance = a / std::sqrt(std::expm1(-2.0 / 3 * std::log(random.uniform())));
  const double z = random.uniform(-1, 1);
  const double angle = random.uniform(0, 2 * pi);
  const double across = std::sqrt(1 - z * z);
  return distance * Vec3(across * std::cos(angle), across * std::sin(angle), z);
}

/// Returns a place along (1, 1, 1). Boxes of width 1 overlap there if their coordinates differ by 1 at most.
Vec3 on_line(Random& random, double side, std::int64_t) {
  const double length = std::pow(side, 3) / 4;
  return Vec3::Constant(random.uniform(-length / 2, length / 2));
}

Vec3 in_clusters(Random& random, double side, std::int64_t i) {
  const double width = side / std::cbrt(2.0);
  return in_cube(random, width) + Vec3::Constant(i % 2 == 0 ? -50 * width : 50 * width);
}

Vec3 at_origin(Random&, double, std::int64_t) { return Vec3::Zero(); }

Aabb giant(double) { return {{-500, -500, -500}, {500, 500, 500}}; }
Aabb slab(double side) {
  const auto bottom = static_cast<float>(-side / 2);
  return {{-500, -500, bottom - 1}, {500, 500, bottom + 1}};
}

const Recipe recipes[] = {
    {"A", 0.5, half},
    {"B", 0.3, [](double u, double) { return std::pow(10.0, 2 * (u - 1)); }},
    {"C", 0.3, [](double u, double) { return u < 1e-4 ? 50.0 : 1.0; }},
    {"log:R", 0.3, log_uniform},
    {"volume:R", 0.3, equal_volumes},
    {"giant", 0.5, half, nullptr, giant},
    {"slab", 0.5, half, nullptr, slab},
    {"plummer", 0.5, half, in_plummer_sphere},
    {"boxes", 0.2, nullptr},  // the share that gives as many pairs as A has
    {"line", 0.5, half, on_line},
    {"clusters", 0.5, half, in_clusters},
    {"point", 0.5, half, at_origin},
};

/// A recipe and its ratio R.
struct DataSet {
  const Recipe* recipe;
  double ratio = 1;

  double radius(std::int64_t i) const {
    return recipe->radius(Random(1, static_cast<std::uint64_t>(i)).uniform(), ratio);
  }
  /// Returns half the edges of a box.
  static Vec3 half_edges(std::int64_t i) {
    Random random(1, static_cast<std::uint64_t>(i));
    const double second = std::pow(10.0, -random.uniform());
    return 0.5 * Vec3(1, second, std::pow(10.0, -random.uniform()));
  }
  double volume(std::int64_t i) const {
    return recipe->radius ? 4 * pi / 3 * std::pow(radius(i), 3) : volume_of(Shape::box, half_edges(i));
  }
  Aabb bounds(std::int64_t i, double side) const {
    if (i == 0 && recipe->first) return recipe->first(side);
    Random random(2, static_cast<std::uint64_t>(i));
    const Vec3 place = recipe->place ? recipe->place(random, side, i) : in_cube(random, side);
    if (!recipe->radius) {
      Random turn(3, static_cast<std::uint64_t>(i));
      return bounds_of({Shape::box, place, random_orientation(turn), half_edges(i)}, 0, Vec3::Zero());
    }
    const double r = radius(i);
    Aabb box;
    for (int a = 0; a < 3; ++a) {
      box.lo[a] = round_down(place[a] - r);
      box.hi[a] = round_up(place[a] + r);
    }
    return box;
  }
};

DataSet data_set_of(const std::string& name) {
  const std::size_t colon = name.find(':');
  const std::string kind = colon == std::string::npos ? name : name.substr(0, colon) + ":R";
  const auto recipe = std::ranges::find(recipes, kind, &Recipe::name);
  DataSet set{recipe};
  bool known = recipe != std::end(recipes);
  if (colon != std::string::npos) {
    const char* end = name.data() + name.size();
    const auto [rest, problem] = std::from_chars(name.data() + colon + 1, end, set.ratio);
    known = known && problem == std::errc() && rest == end && set.ratio >= 1 && std::isfinite(set.ratio);
  }
  if (known) return set;
  std::string message = "data set " + name + ": must be one of";
  for (const std::string& one : data_set_names()) message += ' ' + one;
  throw InputError(message + ", where R is at least 1");
}

/// Returns the volume of all objects. It is summed in the order of the objects, since the side of the cube
/// follows from it.
double total_volume(const DataSet& set, std::int64_t n) {
  constexpr std::int64_t block = 1 << 16;
  std::vector<double> volumes(static_cast<std::size_t>(std::min(n, block)));
  double total = 0;
  for (std::int64_t first = 0; first < n; first += block) {
    const std::int64_t count = std::min(block, n - first);
    tbb::parallel_for(std::int64_t{0}, count,
                      [&](std::int64_t k) { volumes[static_cast<std::size_t>(k)] = set.volume(first + k); });
    for (std::int64_t k = 0; k < count; ++k) total += volumes[static_cast<std::size_t>(k)];
  }
  return total;
}

}  // namespace

std::vector<Aabb> make_data_set(const std::string& name, std::int64_t n) {
  const DataSet set = data_set_of(name);
  if (n < 1 || n > std::numeric_limits<std::int32_t>::max())
    throw InputError(std::to_string(n) + " objects: must be from 1 to 2147483647");
  const double side = std::cbrt(total_volume(set, n) / set.recipe->share);
  std::vector<Aabb> boxes(static_cast<std::size_t>(n));
  tbb::parallel_for(std::int64_t{0}, n,
                    [&](std::int64_t i) { boxes[static_cast<std::size_t>(i)] = set.bounds(i, side); });
  return boxes;
}

const std::vector<std::string>& data_set_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const Recipe& recipe : recipes) all.emplace_back(recipe.name);
    return all;
  }();
  return names;
}

}  // namespace scree::bench
