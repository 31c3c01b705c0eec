// The state of all bodies as a structure of arrays. The fields are listed once, in for_each_field; resize,
// permute, snapshot, checkpoint and hash all use that list.
#pragma once

#include "core/archive.hpp"
#include "core/array.hpp"
#include "core/body_number.hpp"
#include "core/math.hpp"
#include "core/period.hpp"
#include "scree/body.hpp"

#include <cstdint>
#include <type_traits>
#include <vector>

namespace scree {

template <class T>
using HostVector = std::vector<T>;

/// Fields of N bodies. `Container` is an array type: HostVector for scenes and snapshots, Array<., Space>
/// in the simulation. SI units, world frame unless said.
/// A body has a number, by which the scene and all outputs know it, and a place, which is its index in the
/// fields. The step may move bodies to other places (sim/bodies/body_order.hpp); their numbers stay.
template <template <class> class Container>
struct BodyFields {
  Container<Vec3> position;         ///< centre of mass (m); for a plane, its point nearest to the origin
  Container<Quat> orientation;      ///< unit quaternion, from the body frame (principal axes) to the world
  Container<Vec3> velocity;         ///< velocity of the centre of mass (m/s)
  Container<Vec3> spin;             ///< angular velocity (rad/s)
  Container<Vec3> size;             ///< dimensions, see Shape (m)
  Container<double> inverse_mass;   ///< 1/kg; 0 for bodies that are not free
  Container<Vec3> inverse_inertia;  ///< inverse principal moments, 1/(kg m^2); 0 for bodies that are not free
  Container<Shape> shape;
  Container<Mobility> mobility;
  Container<std::int32_t> material;  ///< index into the scene's materials
  Container<BodyNumber> id;

  Period period = {};  ///< period of the space; not a field of the bodies
  /// The place of each body, by its number; empty if each place is equal to the number. Not a field of the
  /// bodies.
  Container<std::int32_t> place_of = {};

  SCREE_HD std::int32_t place(BodyNumber number) const {
    const auto k = static_cast<std::int32_t>(number);
    return place_of.size() == 0 ? k : place_of.data()[k];
  }
  std::int64_t count() const { return static_cast<std::int64_t>(position.size()); }
  void archive(Archive& archive);  ///< the number of bodies must be the same as when they were saved
};

/// Calls f(name, field...) for each field of one or more BodyFields, in a fixed order.
template <class F, class... Fields>
void for_each_field(F&& f, Fields&... fields) {
  f("position", fields.position...);
  f("orientation", fields.orientation...);
  f("velocity", fields.velocity...);
  f("spin", fields.spin...);
  f("size", fields.size...);
  f("inverse_mass", fields.inverse_mass...);
  f("inverse_inertia", fields.inverse_inertia...);
  f("shape", fields.shape...);
  f("mobility", fields.mobility...);
  f("material", fields.material...);
  f("id", fields.id...);
}

template <template <class> class Container>
void BodyFields<Container>::archive(Archive& archive) {
  const std::int64_t bodies = count();
  for_each_field(
      [&](const char* name, auto& field) {
        archive(name, field);
        archive.expect(static_cast<std::int64_t>(field.size()) == bodies, name);
      },
      *this);
}

/// Bodies on the host, in growable vectors. Scenes are built as such tables, and they are recorded and drawn.
using BodyTable = BodyFields<HostVector>;

namespace detail {
template <class Space>
struct ArrayIn {
  template <class T>
  using type = Array<T, Space>;
};
// Another spelling of ConstView, for nvcc: as a template argument, it takes the alias of View<const T> for
// View itself.
template <class T>
using ReadOnly = View<std::add_const_t<T>>;
}  // namespace detail

/// Bodies in a space; the step works on these.
template <class Space>
using Bodies = BodyFields<detail::ArrayIn<Space>::template type>;

/// Views of every field, read-write or read-only, as kernels take them.
using BodyView = BodyFields<View>;
using ConstBodyView = BodyFields<detail::ReadOnly>;

template <template <class> class Container>
BodyView view_of(BodyFields<Container>& bodies) {
  BodyView views;
  for_each_field([](const char*, auto& v, auto& field) { v = field.view(); }, views, bodies);
  views.period = bodies.period;
  views.place_of = bodies.place_of.view();
  return views;
}
template <template <class> class Container>
ConstBodyView view_of(const BodyFields<Container>& bodies) {
  ConstBodyView views;
  for_each_field([](const char*, auto& v, const auto& field) { v = field.view(); }, views, bodies);
  views.period = bodies.period;
  views.place_of = bodies.place_of.view();
  return views;
}

/// Copies every field, the period and the places from `from` to `to`; the two may live in different spaces.
template <template <class> class To, template <class> class From>
void copy_bodies(BodyFields<To>& to, const BodyFields<From>& from) {
  for_each_field([](const char*, auto& t, const auto& f) { copy(t, f); }, to, from);
  to.period = from.period;
  copy(to.place_of, from.place_of);
}

/// Moves every field into the order given: element k becomes the old element order[k].
void permute(BodyTable& bodies, const std::vector<std::int32_t>& order);

/// Returns the 64-bit XXH3 over every field in the order of the list. The bodies must lie in the order of
/// their numbers.
std::uint64_t hash_of(const BodyTable& bodies);

/// Returns the radius of the smallest sphere around the centre that holds the body (m); infinite for a plane.
SCREE_HD inline double bounding_radius(Shape shape, const Vec3& size) {
  if (shape == Shape::plane) return HUGE_VAL;
  switch (shape) {
    case Shape::sphere:
      return size.x();
    case Shape::tube:
    case Shape::triangle:
    case Shape::cylinder:
      return hypot(size.x(), size.z());
    case Shape::capsule:
      return size.z();
    default:
      return size.norm();
  }
}

/// Returns true for shapes that have other bodies inside, and that are never free.
SCREE_HD inline bool is_boundary(Shape shape) { return shape == Shape::plane || shape == Shape::tube; }

/// Returns true for shapes that are surfaces without an inside of their own, and that are never free.
SCREE_HD inline bool is_surface(Shape shape) { return is_boundary(shape) || shape == Shape::triangle; }

/// Returns true for shapes that neither the closed forms nor the 15 separating axes of boxes cover. The step
/// handles them on Host.
SCREE_HD inline bool is_general(Shape shape) { return shape > Shape::tube; }

/// Returns the length to which a body's tolerances are relative (m): its radius or its smallest half extent.
/// It is infinite for surfaces, so that the body that touches them sets the length.
SCREE_HD inline double smallest_size(Shape shape, const Vec3& size) {
  if (is_surface(shape)) return HUGE_VAL;
  return shape == Shape::sphere ? size.x() : size.minCoeff();
}

/// Returns the radius on which a body rolls (m); infinite for flat faces, and for walls around other bodies.
SCREE_HD inline double rolling_radius(Shape shape, const Vec3& size) {
  return shape == Shape::sphere || shape == Shape::capsule || shape == Shape::cylinder ? size.x() : HUGE_VAL;
}

/// Returns the volume of a body that can be free (m^3). For a polyhedron it is that of the box around it; the
/// polyhedron's own volume is Hull::volume.
SCREE_HD inline double volume_of(Shape shape, const Vec3& size) {
  const double disc = pi * size.x() * size.x();
  switch (shape) {
    case Shape::sphere:
      return 4.0 / 3.0 * pi * size.x() * size.x() * size.x();
    case Shape::cylinder:
      return 2.0 * disc * size.z();
    case Shape::capsule:
      return disc * (2.0 * (size.z() - size.x()) + 4.0 / 3.0 * size.x());
    default:
      return 8.0 * size.prod();
  }
}

/// Returns true if all principal moments are equal (spheres, cubes): the spin is then constant in free flight
/// and there is no gyroscopic term.
SCREE_HD inline bool has_equal_moments(const Vec3& inverse_inertia) {
  return inverse_inertia.x() == inverse_inertia.y() && inverse_inertia.y() == inverse_inertia.z();
}

}  // namespace scree
