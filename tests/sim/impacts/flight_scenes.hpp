// Scenes of bodies of one material in flight, in any space.
#pragma once

#include "core/rng.hpp"
#include "sim/impacts/flight_stage.hpp"

#include <cmath>
#include <vector>

namespace scree {

/// Bodies of one material and the parameters of their flight.
struct FlightScene {
  BodyTable bodies;
  PairLaw law{.restitution = 1, .friction = 0};
  ResponseParameters parameters;
  double step = 1.0 / 240;

  void add(Shape shape, const Vec3& size, const Vec3& position, const Vec3& velocity, bool free = true) {
    const Vec3 inertia = shape == Shape::sphere
                             ? Vec3(Vec3::Constant(0.4 * size.x() * size.x()))
                             : Vec3(Vec3::Constant(size.squaredNorm()) - size.cwiseProduct(size)) / 3.0;
    bodies.position.push_back(position);
    bodies.orientation.push_back(Quat::Identity());
    bodies.velocity.push_back(velocity);
    bodies.spin.push_back(Vec3::Zero());
    bodies.size.push_back(size);
    bodies.inverse_mass.push_back(free ? 1 : 0);
    bodies.inverse_inertia.push_back(free ? Vec3(inertia.cwiseInverse()) : Vec3(Vec3::Zero()));
    bodies.shape.push_back(shape);
    bodies.mobility.push_back(free ? Mobility::free : Mobility::fixed);
    bodies.material.push_back(0);
    bodies.id.push_back(BodyNumber{static_cast<std::int32_t>(bodies.id.size())});
  }
  void add_ball(double radius, const Vec3& position, const Vec3& velocity) {
    add(Shape::sphere, Vec3::Constant(radius), position, velocity);
  }
  /// Gives a body, which had 1 kg until then, the mass `mass` (kg).
  void weigh(std::int32_t body, double mass) {
    bodies.inverse_mass[static_cast<std::size_t>(body)] /= mass;
    bodies.inverse_inertia[static_cast<std::size_t>(body)] /= mass;
  }
  void add_plane(const Vec3& normal, double offset) {
    add(Shape::plane, Vec3::Zero(), offset * normal, Vec3::Zero(), false);
    Mat3 axes;
    axes << tangent_of(normal), normal.cross(tangent_of(normal)), normal;
    bodies.orientation.back() = Quat(axes);
  }

  std::int32_t count() const { return static_cast<std::int32_t>(bodies.count()); }
  bool is_free(std::int32_t k) const {
    return bodies.mobility[static_cast<std::size_t>(k)] == Mobility::free;
  }

  /// Returns all pairs that come as near as `reach` (m).
  std::vector<Pair> pairs(double reach) const {
    std::vector<Pair> found;
    for (std::int32_t i = 0; i < count(); ++i) {
      for (std::int32_t j = i + 1; j < count(); ++j) {
        const auto a = static_cast<std::size_t>(i);
        const auto b = static_cast<std::size_t>(j);
        const double touching = bounding_radius(bodies.shape[a], bodies.size[a]) +
                                bounding_radius(bodies.shape[b], bodies.size[b]);
        if (!is_free(i) && !is_free(j)) continue;
        if ((bodies.position[b] - bodies.position[a]).norm() < touching + reach) found.push_back({i, j});
      }
    }
    return found;
  }

  double kinetic_energy() const {
    double energy = 0;
    for (const Vec3& v : bodies.velocity) energy += 0.5 * v.squaredNorm();
    return energy;
  }
  void fly(double dt) {
    for (std::size_t k = 0; k < bodies.position.size(); ++k) bodies.position[k] += dt * bodies.velocity[k];
  }
};

/// A scene in a space.
template <class Space>
struct World {
  explicit World(const FlightScene& scene) : parameters(scene.parameters), step(scene.step) {
    copy_bodies(bodies, scene.bodies);
    copy(table, std::vector<PairLaw>{scene.law});
  }
  FlightTerms terms(double from) const {
    return {.laws = {bodies.shape.view(), bodies.size.view(), bodies.mobility.view(), bodies.material.view(),
                     table.view(), 1},
            .step = step,
            .from = from,
            .bounces = from == 0};
  }

  Bodies<Space> bodies;
  Array<PairLaw, Space> table;
  ResponseParameters parameters;
  double step;
};

inline Vec3 vector_in(Random& random, double size) {
  const double x = random.uniform(-size, size);
  const double y = random.uniform(-size, size);
  return {x, y, random.uniform(-size, size)};
}

/// Returns a gas of 1000 balls in a box of 1 m, of which they fill the share `fill`.
inline FlightScene gas(double fill) {
  constexpr int along = 10;
  FlightScene scene;
  const double radius = std::cbrt(fill / (along * along * along) * 0.75 / pi);
  for (int k = 0; k < along * along * along; ++k) {
    Random random(3, static_cast<std::uint64_t>(k));
    const Vec3 cell(k % along, k / along % along, k / (along * along));
    const Vec3 jitter = vector_in(random, 0.5 / along - radius);
    scene.add_ball(radius, (cell + Vec3::Constant(0.5)) / along + jitter, vector_in(random, 1.0));
  }
  for (int axis = 0; axis < 3; ++axis) {
    scene.add_plane(Vec3::Unit(axis), 0);
    scene.add_plane(-Vec3::Unit(axis), -1);
  }
  return scene;
}

}  // namespace scree
