// Random bodies of all mobilities.
#pragma once

#include "core/bodies.hpp"
#include "core/rng.hpp"
#include "sim/laws/rotation.hpp"

#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace scree {

inline constexpr std::size_t count = 1000;  // more than one leaf of the sums

inline Vec3 vector_in(Random& random, double reach) {
  const double x = random.uniform(-reach, reach);
  const double y = random.uniform(-reach, reach);
  return {x, y, random.uniform(-reach, reach)};
}

/// Returns balls and cubes of all mobilities.
inline BodyTable random_bodies() {
  BodyTable table;
  for (std::size_t k = 0; k < count; ++k) {
    Random random(7, k);
    const Mobility mobility = k % 5 == 1   ? Mobility::fixed
                              : k % 7 == 2 ? Mobility::absent
                              : k % 9 == 3 ? Mobility::prescribed
                                           : Mobility::free;
    const bool free = mobility == Mobility::free;
    table.position.push_back(vector_in(random, 5));
    table.orientation.push_back(rotation_of(vector_in(random, 2)));
    table.velocity.push_back(vector_in(random, 3));
    table.spin.push_back(vector_in(random, 4));
    table.size.push_back(Vec3::Constant(random.uniform(0.1, 0.3)));
    table.inverse_mass.push_back(free ? random.uniform(0.5, 2) : 0);
    table.inverse_inertia.push_back(free ? Vec3(Vec3::Constant(random.uniform(1, 3))) : Vec3::Zero());
    table.shape.push_back(k % 2 == 0 ? Shape::sphere : Shape::box);
    table.mobility.push_back(mobility);
    table.material.push_back(0);
    table.id.push_back(BodyNumber{static_cast<std::int32_t>(k)});
  }
  return table;
}

inline std::vector<BodyNumber> numbers(const std::vector<std::int32_t>& list) {
  std::vector<BodyNumber> numbers;
  for (const std::int32_t number : list) numbers.push_back(BodyNumber{number});
  return numbers;
}

/// Returns the same bodies at other places.
inline BodyTable shuffled(BodyTable table) {
  std::vector<std::int32_t> order(table.id.size());
  std::iota(order.begin(), order.end(), 0);
  Random random(3, 0);
  for (std::size_t k = order.size() - 1; k > 0; --k)
    std::swap(order[k], order[static_cast<std::size_t>(random.uniform() * static_cast<double>(k + 1))]);
  permute(table, order);
  return table;
}

template <class Space>
Bodies<Space> in_space(const BodyTable& table) {
  Bodies<Space> bodies;
  copy_bodies(bodies, table);
  return bodies;
}

}  // namespace scree
