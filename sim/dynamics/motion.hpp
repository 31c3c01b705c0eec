// Free motion: the two half steps of Moreau's midpoint rule.
#pragma once

#include "core/archive.hpp"
#include "core/array.hpp"
#include "core/bodies.hpp"
#include "sim/dynamics/new_pairs.hpp"
#include "sim/dynamics/rotation.hpp"
#include "sim/dynamics/state.hpp"

#include <cstdint>

namespace scree {

/// Moves every free body by its velocity and spin for the time dt (s), in place. Returns the drift of their
/// rotational energy (J), which the ledger books as integration.
template <class Space>
double advance(Bodies<Space>& bodies, double dt, const ResponseParameters& parameters);

/// How far contacts of each body must reach so that nothing it can meet within dt is missed (m):
/// its travel, and a slack as a share of its smallest_size.
template <class Space>
void contact_margins(const Bodies<Space>& bodies, double dt, double slack,
                     const ResponseParameters& parameters, Array<double, Space>& margin);

/// The largest of them, and at least 0 (m).
template <class Space>
double largest_margin(const Array<double, Space>& margin);

/// Boxes around the bodies, fat enough that pairs found with them last while nobody moves far.
template <class Space>
class FatBoxes {
 public:
  /// Around the bodies where they are, with room for their travel within dt (s), as far as their period lets
  /// them look, and for contacts that reach as far as given (m).
  void put_around(const Bodies<Space>& bodies, double dt, const ResponseParameters& parameters,
                  const Array<double, Space>& contact_margin);
  /// Whether all bodies that may be in contact, wherever they are now, and with contacts that reach as far as
  /// given (m), are among the pairs that were found with the boxes: all are in their boxes, or those outside
  /// are few and have no NewPairs.
  bool pairs_last(const Bodies<Space>& bodies, const Array<double, Space>& contact_margin);
  /// The same with contact_margins() within dt (s), which are set.
  bool pairs_last(const Bodies<Space>& bodies, double dt, const ResponseParameters& parameters,
                  Array<double, Space>& contact_margin);
  /// How many bodies were outside their boxes when that was last asked.
  std::int64_t outside() const { return new_pairs_.outside(); }
  /// Raises the margins (m) by what each body has moved since the boxes were put around it.
  void add_travel(const Bodies<Space>& bodies, Array<double, Space>& contact_margin) const;
  const Array<double, Space>& margin() const { return margin_; }  ///< (m)
  void archive(Archive& archive) {
    archive("margin", margin_);
    archive("position", position_);
    archive("orientation", orientation_);
  }

 private:
  bool pairs_last_now(const ConstBodyView& now, const Array<double, Space>& contact_margin);

  Array<double, Space> margin_;
  Array<Vec3, Space> position_;
  Array<Quat, Space> orientation_;
  NewPairs<Space> new_pairs_;
};

/// Work of the forces that accelerate the bodies so (m/s^2) on their way from `start` to where they are (J).
template <class Space>
double work_of_forces(const Bodies<Space>& bodies, const Array<Vec3, Space>& start,
                      ConstView<Vec3> acceleration);

/// Sums over the free bodies: what every step asks for,
struct Energies {
  double kinetic_linear = 0;
  double kinetic_angular = 0;
  double potential = 0;  ///< about the reference point
  /// Bodies with a number in their state that is not finite.
  std::int64_t not_finite = 0;

  double kinetic() const { return kinetic_linear + kinetic_angular; }
  SCREE_HD friend Energies operator+(const Energies& a, const Energies& b) {
    return {a.kinetic_linear + b.kinetic_linear, a.kinetic_angular + b.kinetic_angular,
            a.potential + b.potential, a.not_finite + b.not_finite};
  }
};
/// and what an observation does.
struct Totals : Energies {
  double mass = 0;
  Vec3 momentum = Vec3::Zero();
  Vec3 angular_momentum = Vec3::Zero();  ///< about the origin
  Vec3 first_moment = Vec3::Zero();      ///< sum of m (x - reference)
  double speed_squared = 0;
  double speed_fourth = 0;
  std::int64_t count = 0;

  SCREE_HD friend Totals operator+(const Totals& a, const Totals& b) {
    return {static_cast<const Energies&>(a) + static_cast<const Energies&>(b),
            a.mass + b.mass,
            a.momentum + b.momentum,
            a.angular_momentum + b.angular_momentum,
            a.first_moment + b.first_moment,
            a.speed_squared + b.speed_squared,
            a.speed_fourth + b.speed_fourth,
            a.count + b.count};
  }
};

/// Whether position, orientation, velocity and spin are finite.
SCREE_HD inline bool is_finite(const ConstBodyView& bodies, std::int64_t k) {
  // Zero times what is not finite is not zero.
  const double zero = (0 * bodies.position[k]).sum() + (0 * bodies.orientation[k].coeffs()).sum() +
                      (0 * bodies.velocity[k]).sum() + (0 * bodies.spin[k]).sum();
  return zero == 0;
}

/// One body's share; nothing unless it is free. Potential energy is -m g.(x - reference).
SCREE_HD inline Energies energies_of_body(const ConstBodyView& bodies, std::int64_t k, const Vec3& gravity,
                                          const Vec3& reference) {
  if (bodies.mobility[k] != Mobility::free) return {};
  const double mass = 1.0 / bodies.inverse_mass[k];
  return {0.5 * mass * bodies.velocity[k].squaredNorm(),
          rotational_energy(bodies.orientation[k], bodies.spin[k], bodies.inverse_inertia[k]),
          -mass * gravity.dot(bodies.position[k] - reference), is_finite(bodies, k) ? 0 : 1};
}
SCREE_HD inline Totals totals_of_body(const ConstBodyView& bodies, std::int64_t k, const Vec3& gravity,
                                      const Vec3& reference) {
  if (bodies.mobility[k] != Mobility::free) return {};
  const double mass = 1.0 / bodies.inverse_mass[k];
  const Vec3& x = bodies.position[k];
  const Vec3& v = bodies.velocity[k];
  Totals t{energies_of_body(bodies, k, gravity, reference)};
  t.mass = mass;
  t.momentum = mass * v;
  t.angular_momentum =
      mass * x.cross(v) + spin_momentum(bodies.orientation[k], bodies.spin[k], bodies.inverse_inertia[k]);
  t.first_moment = mass * (x - reference);
  t.speed_squared = v.squaredNorm();
  t.speed_fourth = t.speed_squared * t.speed_squared;
  t.count = 1;
  return t;
}

template <class Space>
Energies energies_of(const Bodies<Space>& bodies, const Vec3& gravity, const Vec3& reference);
template <class Space>
Totals totals_of(const Bodies<Space>& bodies, const Vec3& gravity, const Vec3& reference);
template <class Space>
double largest_speed(const Bodies<Space>& bodies);

}  // namespace scree
