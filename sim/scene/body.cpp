// Closed formulas of mass and inertia, and the random draws of one body.
#include "sim/scene/body.hpp"

#include "core/random_orientation.hpp"
#include "sim/scene/unit_quaternion.hpp"

#include <cmath>

namespace scree {
namespace {

Vec3 place_of(const BodyEntry& entry, std::int64_t k, Random& random) {
  if (entry.motion && !entry.motion->keyframes.empty()) return entry.motion->keyframes.front().position;
  if (entry.emit) return 0.5 * (entry.emit->from + entry.emit->to);
  Vec3 at = entry.at.value_or(Vec3::Zero());
  if (!entry.repeat) return at;
  const RepeatEntry& repeat = *entry.repeat;
  const auto& n = repeat.count;
  const std::int64_t row = k / n[0], layer = row / n[1];
  const Vec3 cell(static_cast<double>(k % n[0]), static_cast<double>(row % n[1]), static_cast<double>(layer));
  at += cell.cwiseProduct(repeat.spacing);
  for (int c = 0; c < 3; ++c) at[c] += random.uniform(-repeat.jitter, repeat.jitter);
  return at;
}

/// Returns the orientation that an entry, of a body or of a keyframe, gives, if it gives one.
template <class Entry>
std::optional<Quat> given_orientation(const Entry& entry) {
  if (entry.orientation) {
    const auto& q = *entry.orientation;
    return *unit_quaternion(q[0], Vec3(q[1], q[2], q[3]));
  }
  if (!entry.rotate) return {};
  const double angle = entry.rotate->degrees ? *entry.rotate->degrees * pi / 180 : *entry.rotate->radians;
  return Quat(Eigen::AngleAxisd(angle, entry.rotate->axis.stableNormalized()));
}

Quat orientation_of(const BodyEntry& entry, Random& random) {
  if (entry.motion && !entry.motion->keyframes.empty())
    if (const std::optional<Quat> first = given_orientation(entry.motion->keyframes.front())) return *first;
  if (const std::optional<Quat> given = given_orientation(entry)) return *given;
  return entry.scatter || entry.emit ? random_orientation(random) : Quat::Identity();
}

/// Returns the principal moments of inertia (kg m^2) of a cylinder, or of a capsule, which is a cylinder with
/// half a ball at each end (size as in Shape).
Vec3 inertia_of_round(Shape shape, const Vec3& size, double mass) {
  const double square = size.x() * size.x();
  const double half =
      shape == Shape::capsule ? size.z() - size.x() : size.z();  // half length of the cylinder
  const double of_ends = shape == Shape::capsule ? size.x() / (size.x() + 1.5 * half) : 0.0;
  const double ends = of_ends * mass, middle = mass - ends;
  const double across =
      middle * (square / 4 + half * half / 3) + ends * (0.4 * square + half * half + 0.75 * half * size.x());
  return {across, across, middle * square / 2 + ends * 0.4 * square};
}

/// Returns the principal moments of inertia (kg m^2) of a solid body (size as in Shape).
Vec3 inertia_of(Shape shape, const Vec3& size, double mass) {
  if (shape == Shape::sphere) return Vec3::Constant(0.4 * mass * size.x() * size.x());
  if (shape == Shape::capsule || shape == Shape::cylinder) return inertia_of_round(shape, size, mass);
  const Vec3 squares = size.cwiseProduct(size);
  return mass / 3 * Vec3(squares.y() + squares.z(), squares.z() + squares.x(), squares.x() + squares.y());
}

bool is_usable(double x) { return x > 0 && std::isfinite(x) && std::isfinite(1 / x); }

/// Sets the mass and inertia of a free body. `given`: its mass (kg); absent: from `density` (kg/m^3). Returns
/// false in the same cases as make_body().
bool set_mass(const std::optional<double>& given, double density, const Hull* hull, std::size_t b,
              BodyTable& bodies) {
  const double volume = hull ? hull->volume : volume_of(bodies.shape[b], bodies.size[b]);
  const double mass = given.value_or(density * volume);
  const Vec3 inertia = hull ? Vec3(mass * hull->moments) : inertia_of(bodies.shape[b], bodies.size[b], mass);
  bodies.inverse_mass[b] = 1 / mass;
  bodies.inverse_inertia[b] = inertia.cwiseInverse();
  return is_usable(mass) && is_usable(inertia.minCoeff()) && is_usable(inertia.maxCoeff());
}

/// Returns a rotation that takes +z to the unit vector n. It is exact along the axes. For n.z < 0 it goes by
/// way of -z, because 1 + n.z would lose digits by cancellation.
Quat turn_to(const Vec3& n) {
  if (n.z() >= 0) return Quat(1 + n.z(), -n.y(), n.x(), 0).normalized();
  return Quat(1 - n.z(), n.y(), -n.x(), 0).normalized() * Quat(0, 1, 0, 0);
}

void make_plane(const PlaneEntry& plane, std::size_t b, BodyTable& bodies) {
  const Vec3 normal = plane.normal.stableNormalized();
  bodies.shape[b] = Shape::plane;
  bodies.mobility[b] = Mobility::fixed;
  bodies.size[b] = Vec3::Zero();
  bodies.position[b] = normal * plane.offset;
  bodies.orientation[b] = turn_to(normal);
}

/// Sets the shape of a body, and its size, which is drawn at random if the entry gives a distribution.
void make_shape(const BodyEntry& entry, const Hull* hull, Random& random, Shape& shape, Vec3& size) {
  if (entry.sphere) {
    shape = Shape::sphere;
    size = Vec3(draw(entry.sphere->radius, random), 0, 0);
  } else if (entry.box) {
    shape = Shape::box;
    size = 0.5 * draw(entry.box->size, random);
  } else if (entry.capsule) {
    shape = Shape::capsule;
    const double radius = entry.capsule->radius;
    size = Vec3(radius, radius, 0.5 * entry.capsule->length + radius);
  } else if (entry.cylinder) {
    shape = Shape::cylinder;
    size = Vec3(entry.cylinder->radius, entry.cylinder->radius, 0.5 * entry.cylinder->length);
  } else if (hull) {
    shape = Shape::polyhedron;
    size = hull->half_extent();
  } else {
    shape = Shape::tube;
    size = Vec3(entry.tube->radius, entry.tube->radius, 0.5 * entry.tube->length);
  }
}

/// Moves a body from the frame in which its hull's points are given, which is the frame that the row places,
/// to the hull's own frame. If both have the same axes but for rounding (see make_hull()), the orientation
/// keeps its bits.
void place_hull(const Hull& hull, std::size_t b, BodyTable& bodies) {
  bodies.position[b] += bodies.orientation[b] * hull.centre;
  if (hull.axes.coeffs() != Quat::Identity().coeffs())
    bodies.orientation[b] = (bodies.orientation[b] * hull.axes).normalized();
}

}  // namespace

bool make_body(const BodyEntry& entry, std::int64_t k, std::int32_t id, std::uint64_t seed, double density,
               const Hull* hull, BodyTable& bodies) {
  const auto b = static_cast<std::size_t>(id);
  bodies.id[b] = BodyNumber{id};
  bodies.velocity[b] = bodies.spin[b] = bodies.inverse_inertia[b] = Vec3::Zero();
  bodies.inverse_mass[b] = 0;
  if (entry.plane) {
    make_plane(*entry.plane, b, bodies);
    return true;
  }
  Random random(seed, b);
  make_shape(entry, hull, random, bodies.shape[b], bodies.size[b]);
  bodies.position[b] = place_of(entry, k, random);
  bodies.orientation[b] = orientation_of(entry, random);
  if (hull) {
    // The entry places the frame in which the points are given; of a scattered or emitted body the random
    // position is that of the centre of mass.
    if (!entry.scatter && !entry.emit) bodies.position[b] += bodies.orientation[b] * hull->centre;
    bodies.orientation[b] = (bodies.orientation[b] * hull->axes).normalized();
  }
  bodies.velocity[b] = entry.motion ? entry.motion->velocity : entry.velocity.value_or(Vec3::Zero());
  bodies.spin[b] = entry.motion ? entry.motion->spin : entry.spin.value_or(Vec3::Zero());
  bodies.mobility[b] = entry.fixed.value_or(false) ? Mobility::fixed
                       : entry.motion              ? Mobility::prescribed
                                                   : Mobility::free;
  if (bodies.mobility[b] != Mobility::free) return true;
  const bool usable = set_mass(entry.mass, density, hull, b, bodies);
  if (entry.servo) bodies.inverse_inertia[b].setZero();  // its guide keeps it from turning
  return usable;
}

Motion motion_of(const MotionEntry& entry, std::int32_t body) {
  Motion motion{.body = body,
                .velocity = entry.velocity,
                .spin = entry.spin,
                .about = entry.about,
                .oscillate = entry.oscillate};
  for (const MotionKeyEntry& key : entry.keyframes)
    motion.keyframes.push_back({key.at, key.position, given_orientation(key)});
  return motion;
}

void make_body(const BodyEntry& entry, const PlacedTriangle& triangle, std::int32_t id, BodyTable& bodies) {
  const auto b = static_cast<std::size_t>(id);
  Random unused(0, 0);
  const Quat turn = orientation_of(entry, unused);
  const Vec3 at = entry.at.value_or(Vec3::Zero());
  bodies.id[b] = BodyNumber{id};
  bodies.shape[b] = Shape::triangle;
  bodies.size[b] = triangle.size;
  bodies.position[b] = at + turn * triangle.position;
  bodies.orientation[b] = (turn * triangle.orientation).normalized();
  bodies.velocity[b] = entry.motion ? entry.motion->velocity : Vec3(Vec3::Zero());
  bodies.spin[b] = entry.motion ? entry.motion->spin : Vec3(Vec3::Zero());
  bodies.mobility[b] = entry.motion ? Mobility::prescribed : Mobility::fixed;
  bodies.inverse_mass[b] = 0;
  bodies.inverse_inertia[b] = Vec3::Zero();
}

bool make_body(const BodyEntry& entry, const BodyRow& row, std::int32_t id, std::uint64_t seed,
               double density, const Hull* hull, BodyTable& bodies) {
  const auto b = static_cast<std::size_t>(id);
  const bool fixed = entry.fixed.value_or(false);
  bodies.id[b] = BodyNumber{id};
  bodies.shape[b] = row.shape;
  bodies.size[b] = hull ? hull->half_extent() : row.size;
  if (row.has_shape_of_entry) {
    Random random(seed, b);
    make_shape(entry, hull, random, bodies.shape[b], bodies.size[b]);
  }
  bodies.position[b] = row.position;
  bodies.orientation[b] = row.orientation;
  if (hull) place_hull(*hull, b, bodies);
  bodies.velocity[b] = fixed ? Vec3(Vec3::Zero()) : row.velocity;
  bodies.spin[b] = fixed ? Vec3(Vec3::Zero()) : row.spin;
  bodies.mobility[b] = fixed ? Mobility::fixed : Mobility::free;
  bodies.inverse_mass[b] = 0;
  bodies.inverse_inertia[b] = Vec3::Zero();
  if (fixed) return true;
  const bool usable = set_mass(row.mass, density, hull, b, bodies);
  if (row.servo) bodies.inverse_inertia[b].setZero();  // its guide keeps it from turning
  return usable;
}

}  // namespace scree
