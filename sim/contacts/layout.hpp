// The layout of bodies and contacts in memory while they stay in a space.
#pragma once

#include "core/array.hpp"
#include "core/bodies.hpp"
#include "narrowphase/contact.hpp"
#include "sim/laws/simd/wide_laws.hpp"

#include <cmath>
#include <cstdint>

namespace scree::solver {

/// The two bodies of the solver on which a contact acts.
struct alignas(8) Ends {
  std::int32_t i, j;
};
enum class End { i, j };
template <End end>
SCREE_LAW std::int32_t body_at(const Ends& ends) {
  return end == End::i ? ends.i : ends.j;
}

template <class Real>
struct BodyRecord;
template <class Real>
struct CentreRecord;

/// The arithmetic of one contact to a thread, in the precision of the solution. Beyond what the laws require,
/// an arithmetic knows the number of contacts on which it works at once, loads and stores numbers of these
/// contacts, and loads and stores their bodies, which `ends` names. A body that is not free is never written.
template <class Number>
struct Scalar {
  using Real = Number;
  using V = Real;
  static constexpr int width = 1;
  SCREE_HD static Real root(Real a) { return std::sqrt(a); }
  SCREE_LAW static V all(Real a) { return a; }
  SCREE_LAW static V get(const Real* from) { return *from; }
  SCREE_LAW static void set(Real* to, V value) { *to = value; }
  SCREE_LAW static bool any(bool condition) { return condition; }
  /// Returns the largest of the numbers of all contacts on which the arithmetic works.
  SCREE_LAW static std::int32_t most(const std::int32_t* of) { return *of; }

  template <End end>
  SCREE_LAW static simd::Moving<Scalar> bodies(const BodyRecord<Real>* from, const Ends* ends) {
    const BodyRecord<Real> body = from[body_at<end>(*ends)];
    return body;
  }
  template <End end>
  SCREE_LAW static simd::Centre<Scalar> bodies(const CentreRecord<Real>* from, const Ends* ends) {
    const CentreRecord<Real> body = from[body_at<end>(*ends)];
    return body;
  }
  template <End end, class Record, class Body>
  SCREE_LAW static void put(const Body& body, Record* to, const Ends* ends) {
    Record record;
    static_cast<Body&>(record) = body;
    if (body.inverse_mass > 0) to[body_at<end>(*ends)] = record;
  }
};

template <class Real>
using V3 = simd::V3<Scalar<Real>>;
template <class Real>
using Moving = simd::Moving<Scalar<Real>>;

template <class Real>
SCREE_HD inline V3<Real> v3(const Vec3& a) {
  return {static_cast<Real>(a.x()), static_cast<Real>(a.y()), static_cast<Real>(a.z())};
}
template <class Real>
SCREE_HD inline Vec3 vec3(const V3<Real>& a) {
  return {static_cast<double>(a.x), static_cast<double>(a.y), static_cast<double>(a.z)};
}

template <class A>
SCREE_LAW auto is_zero(const simd::V3<A>& a) {
  return (a.x == 0) & (a.y == 0) & (a.z == 0);
}

/// The velocities of a body. The record is read and written as a whole.
template <class Real>
struct alignas(8 * sizeof(Real)) BodyRecord : Moving<Real> {};

/// The velocity of a body's centre, or in the position correction its displacement or its turn.
template <class Real>
struct alignas(4 * sizeof(Real)) CentreRecord : simd::Centre<Scalar<Real>> {};

/// The data of a body at the midpoint that the search for contacts reads, side by side.
template <class Real>
struct alignas(16) MidBody {
  Vec3 position;      ///< m
  double size;        ///< smallest_size (m)
  V3<Real> velocity;  ///< before the kick (m/s)
  Real margin;        ///< largest distance from its surface at which the body has contacts (m)
  Real inverse_mass;
  Real inverse_inertia;  ///< used for balls alone
  std::int32_t material;
  Shape shape;
  Mobility mobility;

  SCREE_HD bool is_free() const { return mobility == Mobility::free; }
};

/// A place where a contact may arise while the candidates stay: one surface of a candidate pair.
struct alignas(8) Slot {
  static constexpr std::int32_t empty = -1;

  std::int32_t i = empty, j = empty;          ///< places of the bodies; i has the smaller number
  std::int32_t end_i = empty, end_j = empty;  ///< bodies of the solver; hubs and turning walls have several
  std::int32_t candidate = empty;             ///< number of the pair in the list of candidates
  std::int32_t surface = 0;                   ///< number of the pair's manifold
};

/// Arrays of `count` fields, with one element for each place. They are stored in blocks of simd::width
/// places, and field by field within a block: one instruction of Host works on a field of a block, and one
/// access to memory of a GPU loads it.
template <class Real, int count>
class Fields {
 public:
  Fields() = default;
  SCREE_HD explicit Fields(Real* data) : data_(data) {}
  /// Returns the number of elements for a number of places, which fill whole blocks.
  static std::int64_t size(std::int64_t places) { return places * count; }

  SCREE_LAW Real& at(int field, std::int64_t place) const {
    const auto k = static_cast<std::uint64_t>(place);
    constexpr std::uint64_t width = simd::width;
    return data_[(k / width * count + static_cast<std::uint64_t>(field)) * width + k % width];
  }
  /// Loads a field of as many consecutive places as the arithmetic works on.
  template <class A>
  SCREE_LAW typename A::V get(int field, std::int64_t place) const {
    return A::get(&at(field, place));
  }
  template <class A>
  SCREE_LAW simd::V3<A> vector(int field, std::int64_t place) const {
    return {get<A>(field, place), get<A>(field + 1, place), get<A>(field + 2, place)};
  }
  template <class A>
  SCREE_LAW void put(int field, std::int64_t place, const typename A::V& value) const {
    A::set(&at(field, place), value);
  }
  template <class A>
  SCREE_LAW void put(int field, std::int64_t place, const simd::V3<A>& value) const {
    put<A>(field, place, value.x);
    put<A>(field + 1, place, value.y);
    put<A>(field + 2, place, value.z);
  }
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
};

/// Contacts of balls with balls, or with bodies that are not free.
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
    count = last + 3
  };
  /// The fields that the sweeps for impulses do not read.
  enum GapField {
    gap,            ///< at the midpoint (m)
    predicted_gap,  ///< at the end of the substep, without correction (m)
    pushed,         ///< push of the position correction (kg m)
    pushed_before,  ///< the push before the last sweep of the correction
    cap,
    gap_count
  };

  Ends* ends;
  View<std::int32_t> slot;  ///< place of its slot among those of its kind; Slot::empty: no contact
  View<std::uint8_t> flags;
  Fields<Real, count> fields;
  Fields<Real, gap_count> gaps;
};

/// Contacts of any bodies, with up to Manifold::max_points points.
template <class Real>
struct PointContacts {
  enum Field {
    normal,
    friction = normal + 3,
    cap,
    inertia_i,  ///< inverse inertia of i in the world frame: xx, yy, zz, xy, xz, yz
    inertia_j = inertia_i + 6,
    count = inertia_j + 6
  };
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
    point_count = last + 3
  };
  enum GapField { gap, predicted_gap, pushed, pushed_before, gap_count };

  Ends* ends;
  View<std::int32_t> slot;
  View<std::uint8_t> flags;
  std::int32_t* points;  ///< number of points of each contact
  Fields<Real, count> fields;
  Fields<Real, Manifold::max_points * point_count> point_fields;
  Fields<Real, Manifold::max_points * gap_count> gaps;

  /// Returns the index of a field of point k.
  SCREE_LAW static int at_point(int k, PointField field) { return k * point_count + field; }
  SCREE_LAW static int at_point(int k, GapField field) { return k * gap_count + field; }
};

/// Bits of the flags of a contact.
enum Flag : std::uint8_t {
  flag_flying = 1,      ///< bodies known not to meet in this substep (ContactFlight)
  flag_late_impact = 2  ///< geometry found after the midpoint
};

/// The memory of a slot from substep to substep.
template <class Real>
struct BallMemory {
  V3<Real> impulse;  ///< impulse on j in the world frame (N s)

  SCREE_HD bool is_loaded() const { return !is_zero(impulse); }
};
template <class Real>
struct PointMemory {
  V3<Real> impulse[Manifold::max_points];
  std::uint32_t feature[Manifold::max_points];
  std::int32_t count;

  SCREE_HD bool is_loaded() const {
    for (int k = 0; k < count; ++k)
      if (!is_zero(impulse[k])) return true;
    return false;
  }
};

}  // namespace scree::solver
