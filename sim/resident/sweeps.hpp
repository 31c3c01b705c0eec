// Visits to one contact of a substep: those that find its impulse, and those that part what overlaps.
#pragma once

#include "sim/resident/layout.hpp"

#include <cstdint>

namespace scree::resident {

/// Loads and stores of the two bodies of a contact; one that is not free is never written.
template <class Record>
SCREE_HD inline void store_free(Record* bodies, std::int32_t k, const Record& body) {
  if (body.inverse_mass > 0) bodies[k] = body;
}

/// What the sweeps of a substep know of one another.
struct SweepState {
  double last_step = 0;
  double beta = 0;  ///< by how much the next sweep goes on
  std::int32_t sweeps = 0;
  bool pushed = false;  ///< the bodies have what the contacts remember
  bool converged = false;
};

/// Change of the impulses by a sweep, and their size: as ImpulseChange.
template <class Real>
struct SweepChange {
  Real step = 0;
  Real size = 0;
  SCREE_HD friend SweepChange operator+(const SweepChange& a, const SweepChange& b) {
    return {a.step + b.step, a.size + b.size};
  }
};

template <class Real>
SCREE_HD inline lanes::Balls<Scalar<Real>> balls_at(const BallContacts<Real>& contacts, std::int64_t c) {
  using C = BallContacts<Real>;
  const Fields<Real>& f = contacts.fields;
  return {f.vector(C::normal, c), f.at(C::arm_i, c),       f.at(C::arm_j, c),       f.at(C::friction, c),
          f.at(C::target, c),     f.at(C::normal_mass, c), f.at(C::tangent_mass, c)};
}

template <class Real>
SCREE_HD inline lanes::Point<Scalar<Real>> point_at(const PointContacts<Real>& contacts, std::int64_t c,
                                                    int k) {
  using C = PointContacts<Real>;
  const Fields<Real>& f = contacts.point_fields;
  return {f.vector(C::at_point(k, C::arm_i), c), f.vector(C::at_point(k, C::arm_j), c)};
}

template <class Real>
SCREE_HD inline lanes::PointLaw<Scalar<Real>> law_at(const PointContacts<Real>& contacts, std::int64_t c,
                                                     int k) {
  using C = PointContacts<Real>;
  const Fields<Real>& f = contacts.point_fields;
  const auto at = [&](int field) { return f.at(C::at_point(k, field), c); };
  return {{at(C::stick), at(C::stick + 1), at(C::stick + 2), at(C::stick + 3), at(C::stick + 4),
           at(C::stick + 5)},
          f.vector(C::at_point(k, C::coupling), c),
          at(C::target),
          at(C::normal_mass),
          at(C::tangent_mass)};
}

/// Inverse inertia of a body, world frame.
template <class Real>
struct alignas(8 * sizeof(Real)) InertiaRecord : lanes::Symmetric<Scalar<Real>> {};

/// Gives the bodies of a contact of balls what its impulse is.
template <class Real>
struct PushBalls {
  BallContacts<Real> contacts;
  BodyRecord<Real>* bodies;

  SCREE_HD void operator()(std::int64_t c) const {
    const Ends ends = contacts.ends[c];
    BodyRecord<Real> i = bodies[ends.i];
    BodyRecord<Real> j = bodies[ends.j];
    push(balls_at(contacts, c), contacts.fields.vector(BallContacts<Real>::impulse, c), i, j);
    store_free(bodies, ends.i, i);
    store_free(bodies, ends.j, j);
  }
};

template <class Real>
struct PushPoints {
  PointContacts<Real> contacts;
  const InertiaRecord<Real>* inertia;
  BodyRecord<Real>* bodies;

  SCREE_HD void operator()(std::int64_t c) const {
    using C = PointContacts<Real>;
    const Ends ends = contacts.ends[c];
    BodyRecord<Real> i = bodies[ends.i];
    BodyRecord<Real> j = bodies[ends.j];
    const InertiaRecord<Real> inertia_i = inertia[ends.i];
    const InertiaRecord<Real> inertia_j = inertia[ends.j];
    for (int p = 0; p < contacts.points[c]; ++p) {
      const V3<Real> impulse = contacts.point_fields.vector(C::at_point(p, C::impulse), c);
      push<Scalar<Real>>(inertia_i, inertia_j, point_at(contacts, c, p), impulse, i, j);
    }
    store_free(bodies, ends.i, i);
    store_free(bodies, ends.j, j);
  }
};

/// Solves a contact of balls. What the last sweep changed is gone on with by beta, which the bodies have done
/// already.
template <class Real>
struct SweepBalls {
  BallContacts<Real> contacts;
  BodyRecord<Real>* bodies;
  bool momentum;  ///< else beta is 0, and the last sweep is not remembered

  SCREE_HD SweepChange<Real> operator()(std::int64_t c, Real beta) const {
    using C = BallContacts<Real>;
    const Ends ends = contacts.ends[c];
    BodyRecord<Real> i = bodies[ends.i];
    BodyRecord<Real> j = bodies[ends.j];
    const V3<Real> before = contacts.fields.vector(C::impulse, c);
    const V3<Real> last = momentum ? contacts.fields.vector(C::last, c) : before;
    const V3<Real> ahead = before + beta * (before - last);
    // Many contacts are open and stay so: they need no more.
    if (is_zero<Real>(before) && is_zero<Real>(last) &&
        dot(contacts.fields.vector(C::normal, c), j.velocity - i.velocity) >=
            contacts.fields.at(C::target, c))
      return {};
    const auto balls = balls_at(contacts, c);
    const V3<Real> p = impulse_of(balls, ahead, i, j);
    const V3<Real> change = p - ahead;
    push(balls, change, i, j);
    store_free(bodies, ends.i, i);
    store_free(bodies, ends.j, j);
    if (momentum) contacts.fields.set(C::last, c, before);
    contacts.fields.set(C::impulse, c, p);
    return {dot(change, change) / balls.normal_mass, dot(p, p) / balls.normal_mass};
  }
};

template <class Real>
struct SweepPoints {
  PointContacts<Real> contacts;
  const InertiaRecord<Real>* inertia;
  BodyRecord<Real>* bodies;
  int block_sweeps;

  SCREE_HD SweepChange<Real> operator()(std::int64_t c, Real beta) const {
    using C = PointContacts<Real>;
    const Ends ends = contacts.ends[c];
    BodyRecord<Real> i = bodies[ends.i];
    BodyRecord<Real> j = bodies[ends.j];
    const InertiaRecord<Real> inertia_i = inertia[ends.i];
    const InertiaRecord<Real> inertia_j = inertia[ends.j];
    const V3<Real> n = contacts.fields.vector(C::normal, c);
    const Real friction = contacts.fields.at(C::friction, c);
    const int count = contacts.points[c];
    const Fields<Real>& f = contacts.point_fields;
    V3<Real> now[Manifold::max_points];
    V3<Real> ahead[Manifold::max_points];
    for (int p = 0; p < count; ++p) {
      const V3<Real> before = f.vector(C::at_point(p, C::impulse), c);
      now[p] = ahead[p] = before + beta * (before - f.vector(C::at_point(p, C::last), c));
      f.set(C::at_point(p, C::last), c, before);
    }
    const int sweeps = count > 1 ? block_sweeps : 1;
    for (int sweep = 0; sweep < sweeps; ++sweep) {
      for (int p = 0; p < count; ++p) {
        const auto at = point_at(contacts, c, p);
        const V3<Real> impulse =
            impulse_of(law_at(contacts, c, p), n, friction, now[p], velocity_at(at, i, j));
        push<Scalar<Real>>(inertia_i, inertia_j, at, impulse - now[p], i, j);
        now[p] = impulse;
      }
    }
    store_free(bodies, ends.i, i);
    store_free(bodies, ends.j, j);
    SweepChange<Real> total;
    for (int p = 0; p < count; ++p) {
      f.set(C::at_point(p, C::impulse), c, now[p]);
      const V3<Real> change = now[p] - ahead[p];
      const Real mass = f.at(C::at_point(p, C::normal_mass), c);
      total = total + SweepChange<Real>{dot(change, change) / mass, dot(now[p], now[p]) / mass};
    }
    return total;
  }
};

/// Velocities are linear in the impulses: what beta does to these it does to them.
template <class Real>
struct Accelerate {
  BodyRecord<Real>* bodies;
  BodyRecord<Real>* last;
  SCREE_HD void operator()(std::int64_t k, Real beta) const {
    const BodyRecord<Real> now = bodies[k];
    if (beta > 0) {
      BodyRecord<Real> ahead = now;
      const BodyRecord<Real> before = last[k];
      ahead.velocity = now.velocity + beta * (now.velocity - before.velocity);
      ahead.spin = now.spin + beta * (now.spin - before.spin);
      bodies[k] = ahead;
    }
    last[k] = now;
  }
};

/// Overlaps as a sweep has found them, of the cap.
struct Overlaps {
  float deepest = 0;
  float sum = 0;
  float count = 0;

  SCREE_HD static Overlaps of_gap(float gap) {
    if (!(gap < 0)) return {};
    return {-gap, -gap, 1};
  }
  SCREE_HD friend Overlaps operator+(const Overlaps& a, const Overlaps& b) {
    return {a.deepest > b.deepest ? a.deepest : b.deepest, a.sum + b.sum, a.count + b.count};
  }
};

/// Parts the bodies of a contact of balls: as the position correction of Host.
template <class Real>
struct PartBalls {
  BallContacts<Real> contacts;
  CentreRecord<Real>* bodies;
  Real share;

  SCREE_HD Overlaps operator()(std::int64_t c) const {
    using C = BallContacts<Real>;
    const Ends ends = contacts.ends[c];
    CentreRecord<Real> i = bodies[ends.i];
    CentreRecord<Real> j = bodies[ends.j];
    const Fields<Real>& f = contacts.fields;
    const V3<Real> n = f.vector(C::normal, c);
    const Real gap = f.at(C::flown, c) + dot(n, j.velocity - i.velocity);
    Real pushed = f.at(C::pushed, c);
    if (!(gap < 0) && pushed == 0) return {};
    const Real cap = f.at(C::cap, c);
    const Real more = lanes::parting<Scalar<Real>>(gap, cap, share, f.at(C::normal_mass, c), pushed);
    push_centres(more * n, i, j);
    store_free(bodies, ends.i, i);
    store_free(bodies, ends.j, j);
    f.at(C::pushed, c) = pushed;
    return Overlaps::of_gap(static_cast<float>(gap / cap));
  }
};

template <class Real>
struct PartPoints {
  PointContacts<Real> contacts;
  const InertiaRecord<Real>* inertia;
  CentreRecord<Real>* bodies;
  CentreRecord<Real>* turns;
  Real share;

  SCREE_HD Overlaps operator()(std::int64_t c) const {
    using C = PointContacts<Real>;
    const Ends ends = contacts.ends[c];
    Moving<Real> i = load(ends.i);
    Moving<Real> j = load(ends.j);
    const InertiaRecord<Real> inertia_i = inertia[ends.i];
    const InertiaRecord<Real> inertia_j = inertia[ends.j];
    const V3<Real> n = contacts.fields.vector(C::normal, c);
    const Real cap = contacts.fields.at(C::cap, c);
    const Fields<Real>& f = contacts.point_fields;
    Real least = 0;
    for (int p = 0; p < contacts.points[c]; ++p) {
      const auto at = point_at(contacts, c, p);
      const Real gap = f.at(C::at_point(p, C::flown), c) + dot(n, velocity_at(at, i, j));
      Real pushed = f.at(C::at_point(p, C::pushed), c);
      if (gap < 0 || pushed > 0) {
        const Real more =
            lanes::parting<Scalar<Real>>(gap, cap, share, f.at(C::at_point(p, C::normal_mass), c), pushed);
        push<Scalar<Real>>(inertia_i, inertia_j, at, more * n, i, j);
        f.at(C::at_point(p, C::pushed), c) = pushed;
      }
      least = gap < least ? gap : least;
    }
    store(ends.i, i);
    store(ends.j, j);
    return Overlaps::of_gap(static_cast<float>(least / cap));
  }

 private:
  SCREE_HD Moving<Real> load(std::int32_t k) const {
    return {bodies[k].velocity, bodies[k].inverse_mass, turns[k].velocity, turns[k].inverse_mass};
  }
  SCREE_HD void store(std::int32_t k, const Moving<Real>& body) const {
    if (!(body.inverse_mass > 0)) return;
    bodies[k].velocity = body.velocity;
    turns[k].velocity = body.spin;
  }
};

}  // namespace scree::resident
