#include "bench/narrowphase/families.hpp"

#include "bench/narrowphase/oracle.hpp"
#include "narrowphase/box_pair.hpp"

#include <algorithm>
#include <cmath>

namespace scree::oracle {

namespace {

bool one_in(int many, Random& random) { return random.uniform() * many < 1; }

/// Returns the distance by which a pair is moved from touching, relative to its smaller size. In one of six
/// pairs it is zero or nearly so.
double step_from_touching(Random& random) {
  const double step = std::pow(10.0, -(one_in(6, random) ? random.uniform(7, 16) : random.uniform(0.7, 7)));
  return one_in(2, random) ? step : -step;
}

Vec3 random_extents(Random& random) {
  Vec3 extents;
  for (int k = 0; k < 3; ++k) extents[k] = std::exp2(random.uniform(-2, 0));
  return extents;
}

/// Returns a tilt of 1e-1 to 1e-12 rad.
double small_angle(Random& random) { return std::pow(10.0, -random.uniform(1, 12)); }

/// Returns the rotation that takes one direction to another. It is normalised, because Eigen's own quaternion
/// is of unit length only to 1e-11 if the two directions are nearly opposed.
Quat turn_between(const Vec3& from, const Vec3& to) { return Quat::FromTwoVectors(from, to).normalized(); }

/// The sizes and orientations of a family's boxes, the first of which is at the origin, and the direction
/// from it to the second.
struct Arrangement {
  Solid a, b;
  Vec3 direction;
};

void put_edge_over_edge(double angle, Arrangement& to) {
  const Quat on_edge = rotation_of(pi / 4 * Vec3::UnitX());
  to.a.orientation = on_edge;
  to.b.orientation = (rotation_of(angle * Vec3::UnitZ()) * on_edge).normalized();
  to.direction = Vec3::UnitZ();
}

void enlarge_one(Arrangement& pair, Random& random) {
  pair.a.size *= 1000;
  if (one_in(2, random)) pair.a.size.z() *= 1e-3;
  if (one_in(3, random)) pair.a.orientation = Quat::Identity(), pair.direction = Vec3::UnitZ();
  if (one_in(2, random)) std::swap(pair.a, pair.b);
}

Arrangement arrange(Family family, Random& random) {
  Arrangement pair{{Vec3::Zero(), random_turn(random), random_extents(random)},
                   {Vec3::Zero(), random_turn(random), random_extents(random)},
                   random_unit(random)};
  auto& [a, b, direction] = pair;
  const Vec3 axis = random_unit(random);
  switch (family) {
    case Family::aligned:
      a.orientation = b.orientation = Quat::Identity();
      if (one_in(2, random)) a.size = b.size = Vec3::Constant(0.5);
      if (!one_in(3, random)) direction = Vec3::Unit(static_cast<int>(random.uniform(0, 3)));
      break;
    case Family::yaw:
      a.orientation = Quat::Identity();
      b.orientation = rotation_of(random.uniform(0, pi) * Vec3::UnitZ());
      if (one_in(2, random)) direction = Vec3::UnitZ();
      break;
    case Family::tilted: {
      const double tilt = small_angle(random);
      a.orientation = Quat::Identity();
      b.orientation = rotation_of(tilt * axis);
      if (one_in(2, random)) direction = (Vec3::UnitZ() + tilt * direction).normalized();
      if (one_in(5, random)) b.size = a.size;
      break;
    }
    case Family::crossed_edges:
      put_edge_over_edge(random.uniform(0.1, pi / 2), pair);
      break;
    case Family::parallel_edges:
      put_edge_over_edge(one_in(5, random) ? 0 : small_angle(random), pair);
      break;
    case Family::vertex:
      a.orientation = turn_between(a.size, Vec3::UnitZ());
      b.orientation = turn_between(b.size, one_in(2, random) ? Vec3::UnitZ() : axis);
      direction = Vec3::UnitZ();
      break;
    case Family::size_ratio:
      enlarge_one(pair, random);
      break;
    case Family::coincident:
      direction.setZero();
      if (one_in(3, random))
        b.orientation = (rotation_of(small_angle(random) * axis) * a.orientation).normalized();
      break;
    case Family::scaled: {
      const double scale = std::pow(10.0, random.uniform(-6, 6));
      a.size *= scale;
      b.size *= scale;
      break;
    }
    case Family::any:
    case Family::shallow:
    case Family::far:
    case Family::count:
      break;
  }
  return pair;
}

/// Returns the distance along the direction at which the boxes overlap by `depth`, found by bisection. The
/// axes under test only serve to place the boxes; the true separation comes from the oracle.
double distance_for(Arrangement pair, double depth) {
  double near = 0, far = 2 * (pair.a.size.norm() + pair.b.size.norm());
  for (int k = 0; k < 36; ++k) {
    const double middle = 0.5 * (near + far);
    pair.b.position = middle * pair.direction;
    (separating_axes(BoxPair(pair.a, pair.b), HUGE_VAL).separation < -depth ? near : far) = middle;
  }
  return near;
}

}  // namespace

Vec3 random_unit(Random& random) {
  const double z = random.uniform(-1, 1), angle = random.uniform(0, 2 * pi), r = std::sqrt(1 - z * z);
  return Vec3(r * std::cos(angle), r * std::sin(angle), z);
}

Quat random_turn(Random& random) { return rotation_of(random.uniform(0, pi) * random_unit(random)); }

const char* name_of(Family family) {
  constexpr const char* names[] = {"any",        "shallow",       "aligned",        "yaw",
                                   "tilted",     "crossed edges", "parallel edges", "vertex",
                                   "size ratio", "coincident",    "scaled",         "far"};
  return names[static_cast<int>(family)];
}

SolidPair make_pair(Family family, std::uint64_t n) {
  Random random(static_cast<std::uint64_t>(family) + 100, n);
  Arrangement pair = arrange(family, random);
  auto& [a, b, direction] = pair;
  const double smaller = std::min(a.size.maxCoeff(), b.size.maxCoeff());
  if (family == Family::shallow) {
    b.position = distance_for(pair, smaller * std::pow(10.0, -random.uniform(1, 6))) * direction;
  } else if (family != Family::coincident) {
    b.position = (distance_for(pair, 0) + smaller * step_from_touching(random)) * direction;
  }
  const Vec3 away = smaller * (family == Family::far ? 1e6 : random.uniform(0, 100)) * random_unit(random);
  a.position += away;
  b.position += away;
  return {a, b, std::max(a.size.maxCoeff(), b.size.maxCoeff()),
          std::min(a.size.minCoeff(), b.size.minCoeff())};
}

// ---- Closed forms ----

namespace {

/// Returns a size from 0.001 to 1.
double random_ratio(Random& random) {
  return one_in(2, random) ? random.uniform(0.1, 1) : std::pow(10.0, -random.uniform(0, 3));
}

Solid random_sphere(Random& random) {
  return {Vec3::Zero(), Quat::Identity(), Vec3::Constant(random_ratio(random))};
}

/// Returns a random box. One of three boxes is not turned or only a little.
Solid random_box(Random& random) {
  const Vec3 size = random_ratio(random) * random_extents(random);
  if (!one_in(3, random)) return {Vec3::Zero(), random_turn(random), size};
  const double tilt = one_in(2, random) ? 0 : small_angle(random);
  return {Vec3::Zero(), rotation_of(tilt * random_unit(random)), size};
}

SolidPair spheres(Random& random) {
  SolidPair pair{random_sphere(random), random_sphere(random), 0, 0};
  const double reach = pair.a.size.x() + pair.b.size.x();
  const double smaller = std::min(pair.a.size.x(), pair.b.size.x());
  const double apart = one_in(10, random) ? 0 : reach + smaller * step_from_touching(random);
  pair.b.position = apart * random_unit(random);
  return pair;
}

/// Places the centre of a sphere anywhere in a box or near it, also exactly over edges and vertices and on
/// the surface.
SolidPair sphere_and_box(Random& random) {
  SolidPair pair{random_sphere(random), random_box(random), 0, 0};
  Vec3 at;
  for (int k = 0; k < 3; ++k) {
    const double share = random.uniform(-1.5, 1.5);
    at[k] = (one_in(5, random) ? std::round(share) : share) * pair.b.size[k];
  }
  pair.a.position = pair.b.orientation * at;
  Vec nearest = Vec::Zero();
  const double distance = static_cast<double>(to_surface(Box(pair.b), pair.a.position.cast<Real>(), nearest));
  if (distance > 0 && !one_in(5, random)) {
    pair.a.size.setConstant(distance * (1 + step_from_touching(random)));
  }
  return pair;
}

/// Puts a body over a plane. `reach` is the body's extent from its centre towards the plane.
void put_on_plane(double reach, Random& random, SolidPair& pair) {
  pair.b.orientation = one_in(3, random) ? Quat::Identity() : random_turn(random);
  const Vec3 beside = random.uniform(0, 100) * (pair.b.orientation * Vec3(random_unit(random).x(), 1, 0));
  pair.a.position = beside + reach * (1 + step_from_touching(random)) * (pair.b.orientation * Vec3::UnitZ());
}

SolidPair sphere_and_plane(Random& random) {
  SolidPair pair{random_sphere(random), {Vec3::Zero(), Quat::Identity(), Vec3::Zero()}, 0, 0};
  put_on_plane(pair.a.size.x(), random, pair);
  return pair;
}

SolidPair box_and_plane(Random& random) {
  SolidPair pair{random_box(random), {Vec3::Zero(), Quat::Identity(), Vec3::Zero()}, 0, 0};
  const Quat own = pair.a.orientation;
  put_on_plane(pair.a.size.dot((own.inverse() * Vec3::UnitZ()).cwiseAbs()), random, pair);
  pair.a.orientation = (pair.b.orientation * own).normalized();
  return pair;
}

/// Puts a body in a tube: anywhere, or with its bounding ball touching the wall or a cap.
SolidPair in_tube(const Solid& body, double ball, Random& random) {
  SolidPair pair{body, {Vec3::Zero(), random_turn(random), Vec3::Zero()}, 0, 0};
  const double radius = random.uniform(0.3, 1);
  pair.b.size = Vec3(radius, radius, random.uniform(0.3, 1));
  double from_axis = 1.2 * radius * random.uniform(), along = 1.2 * pair.b.size.z() * random.uniform(-1, 1);
  if (one_in(3, random)) from_axis = radius - ball * (1 + step_from_touching(random));
  if (one_in(3, random)) along = pair.b.size.z() - ball * (1 + step_from_touching(random));
  if (one_in(20, random)) from_axis = 0;
  const double angle = random.uniform(0, 2 * pi);
  pair.a.position =
      pair.b.orientation * Vec3(from_axis * std::cos(angle), from_axis * std::sin(angle), along);
  return pair;
}

SolidPair arrange(ClosedForm form, Random& random) {
  switch (form) {
    case ClosedForm::sphere_box:
      return sphere_and_box(random);
    case ClosedForm::sphere_plane:
      return sphere_and_plane(random);
    case ClosedForm::box_plane:
      return box_and_plane(random);
    case ClosedForm::sphere_tube: {
      const Solid sphere = random_sphere(random);
      return in_tube(sphere, sphere.size.x(), random);
    }
    case ClosedForm::box_tube: {
      const Solid box = random_box(random);
      return in_tube(box, box.size.norm(), random);
    }
    case ClosedForm::sphere_sphere:
    case ClosedForm::count:
      break;
  }
  return spheres(random);
}

}  // namespace

const char* name_of(ClosedForm form) {
  constexpr const char* names[] = {"sphere-sphere", "sphere-box",  "sphere-plane",
                                   "box-plane",     "sphere-tube", "box-tube"};
  return names[static_cast<int>(form)];
}

SolidPair make_pair(ClosedForm form, std::uint64_t n) {
  Random random(static_cast<std::uint64_t>(form) + 200, n);
  SolidPair pair = arrange(form, random);
  const double scale = std::pow(10.0, random.uniform(-6, 6));
  const Vec3 away = (one_in(3, random) ? 1e6 : random.uniform(0, 10)) * random_unit(random);
  for (Solid* solid : {&pair.a, &pair.b}) {
    solid->size *= scale;
    solid->position = scale * (solid->position + away);
  }
  const bool two_bodies = form == ClosedForm::sphere_sphere || form == ClosedForm::sphere_box;
  pair.length = std::max({pair.a.size.maxCoeff(), pair.b.size.maxCoeff()});
  if (!two_bodies) pair.length = std::max(pair.length, (pair.a.position - pair.b.position).norm());
  pair.smallest =
      two_bodies ? std::min(pair.a.size.minCoeff(), pair.b.size.minCoeff()) : pair.a.size.minCoeff();
  return pair;
}

}  // namespace scree::oracle
