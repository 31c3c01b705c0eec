// How bodies and contacts lie in memory while they stay in a space.
#pragma once

#include "core/array.hpp"
#include "core/bodies.hpp"
#include "narrowphase/contact.hpp"
#include "sim/dynamics/lanes/laws.hpp"

#include <cmath>
#include <cstdint>

namespace scree::resident {

/// Arithmetic of one contact to a thread, in the precision of the solution.
template <class Real>
struct Scalar {
  using V = Real;
  SCREE_HD static Real root(Real a) { return std::sqrt(a); }
};

template <class Real>
using V3 = lanes::V3<Scalar<Real>>;
template <class Real>
using Moving = lanes::Moving<Scalar<Real>>;

template <class Real>
SCREE_HD inline V3<Real> v3(const Vec3& a) {
  return {static_cast<Real>(a.x()), static_cast<Real>(a.y()), static_cast<Real>(a.z())};
}
template <class Real>
SCREE_HD inline Vec3 vec3(const V3<Real>& a) {
  return {static_cast<double>(a.x), static_cast<double>(a.y), static_cast<double>(a.z)};
}

template <class Real>
SCREE_HD inline bool is_zero(const V3<Real>& a) {
  return a.x == 0 && a.y == 0 && a.z == 0;
}

/// Velocities of a body, or its displacement and turn: a record that is read and written as a whole.
template <class Real>
struct alignas(8 * sizeof(Real)) BodyRecord : Moving<Real> {};

/// The centres alone.
template <class Real>
struct alignas(4 * sizeof(Real)) CentreRecord : lanes::Centre<Scalar<Real>> {};

/// What the search for contacts asks of a body at the midpoint, side by side.
template <class Real>
struct alignas(16) MidBody {
  Vec3 position;      ///< m
  double size;        ///< smallest_size (m)
  V3<Real> velocity;  ///< before the kick (m/s)
  Real margin;        ///< how far its contacts reach (m)
  Real inverse_mass;
  Real inverse_inertia;  ///< of a ball
  std::int32_t material;
  Shape shape;
  Mobility mobility;

  SCREE_HD bool is_free() const { return mobility == Mobility::free; }
};

/// A place where a contact may arise while the candidates stay: one surface of a candidate pair.
struct alignas(8) Slot {
  static constexpr std::int32_t empty = -1;

  std::int32_t i = empty, j = empty;          ///< places of the bodies, that with the smaller number first
  std::int32_t end_i = empty, end_j = empty;  ///< bodies of the solver: a hub has several, as a turning wall
  std::int32_t candidate = empty;             ///< number of the pair in the list of candidates
  std::int32_t surface = 0;                   ///< which of the pair's manifolds
};

/// Numbers of places, field by field.
template <class Real>
class Fields {
 public:
  Fields() = default;
  SCREE_HD Fields(Real* data, std::int64_t places) : data_(data), places_(places) {}

  SCREE_HD Real& at(int field, std::int64_t place) const { return data_[field * places_ + place]; }
  SCREE_HD V3<Real> vector(int field, std::int64_t place) const {
    return {at(field, place), at(field + 1, place), at(field + 2, place)};
  }
  SCREE_HD void set(int field, std::int64_t place, const V3<Real>& value) const {
    at(field, place) = value.x;
    at(field + 1, place) = value.y;
    at(field + 2, place) = value.z;
  }

 private:
  Real* data_ = nullptr;
  std::int64_t places_ = 0;
};

/// The bodies of the solver that a contact acts on.
struct alignas(8) Ends {
  std::int32_t i, j;
};

/// Contacts of balls with balls, or with bodies that are not free, tile by tile: those of a tile of slots are
/// at its front, in the order of the slots.
template <class Real>
struct BallContacts {
  enum Field {
    normal,
    arm_i = normal + 3,
    arm_j,
    friction,
    target,
    normal_mass,
    tangent_mass,
    impulse,
    last = impulse + 3,  ///< the impulse before the last sweep
    gap = last + 3,      ///< at the midpoint (m)
    flown,               ///< at the end of the substep, without correction (m)
    pushed,
    cap,
    count
  };

  View<Ends> ends;
  View<std::uint8_t> slot;  ///< of each contact, in its tile
  View<std::uint8_t> flags;
  Fields<Real> fields;
};

/// Contacts of any bodies, with up to Manifold::max_points points.
template <class Real>
struct PointContacts {
  enum Field { normal, friction = normal + 3, cap, count };
  enum PointField {
    arm_i,
    arm_j = arm_i + 3,
    stick = arm_j + 3,
    coupling = stick + 6,
    target = coupling + 3,
    normal_mass,
    tangent_mass,
    impulse,
    last = impulse + 3,
    gap = last + 3,
    flown,
    pushed,
    point_count
  };

  View<Ends> ends;
  View<std::uint8_t> slot;
  View<std::uint8_t> flags;
  View<std::int32_t> points;  ///< of each contact
  Fields<Real> fields;
  Fields<Real> point_fields;  ///< of point k: from k * point_count on

  SCREE_HD static int at_point(int k, int field) { return k * point_count + field; }
};

/// True if there is a contact in a place: `found` in each tile, at its front.
SCREE_HD inline bool has_contact(const std::int32_t* found, std::int64_t place) {
  return place % 256 < found[place / 256];
}

/// Of contacts.
enum Flag : std::uint8_t {
  flag_flying = 1,  ///< known not to meet in this substep: its rows only guard what the flight leaves free
  flag_late = 2     ///< its geometry is of a time after the midpoint
};

/// What slots remember from substep to substep.
template <class Real>
struct BallMemory {
  V3<Real> impulse;  ///< N s, world frame

  SCREE_HD bool is_loaded() const { return !is_zero<Real>(impulse); }
};
template <class Real>
struct PointMemory {
  V3<Real> impulse[Manifold::max_points];
  std::uint32_t feature[Manifold::max_points];
  std::int32_t count;

  SCREE_HD bool is_loaded() const {
    for (int k = 0; k < count; ++k)
      if (!is_zero<Real>(impulse[k])) return true;
    return false;
  }
};

}  // namespace scree::resident
