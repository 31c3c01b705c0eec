#include "sim/dynamics/correction.hpp"

#include "core/parallel.hpp"
#include "core/tolerances.hpp"
#include "sim/dynamics/colored.hpp"
#include "sim/dynamics/rotation.hpp"

namespace scree {

struct PositionCorrector::Stage {
  BodyView bodies;
  ConstView<SolverBody> solver;
  ConstView<Contact> contacts;
  ConstView<ContactRow> rows;
  View<double> flown_gap;  ///< of each row at the end of the substep, without displacements
  View<Displacement> displacement;
  double step;

  /// Gap at the end of the substep, to first order in what moved since the midpoint.
  SCREE_HD double gap_at_end(const Contact& c, std::int64_t row) const {
    const Displacement& i = displacement[c.i];
    const Displacement& j = displacement[c.j];
    return flown_gap[row] + c.normal.dot(j.linear + j.angular.cross(rows[row].arm_j) - i.linear -
                                         i.angular.cross(rows[row].arm_i));
  }

  /// How far a gap has opened since the contact was seen. From the places that bodies struck late have come
  /// to; for the others from their velocities, which know of no origin.
  SCREE_HD double flown(const Contact& c, const ContactRow& row) const {
    const SolverBody& i = solver[c.i];
    const SolverBody& j = solver[c.j];
    if (c.lead == 0) {
      return 0.5 * step * (c.normal.dot(row.relative_velocity(i, j)) + 0.25 * step * row.bend);
    }
    const Vec3 moved = bodies.position[c.j] - bodies.position[c.i] + row.arm_j - row.arm_i;
    const Vec3 turned = j.spin.cross(row.arm_j) - i.spin.cross(row.arm_i);
    return c.normal.dot(moved + (0.5 * step - c.lead) * turned);
  }

  SCREE_HD void move(std::int32_t body, const Vec3& arm, const Vec3& impulse) const {
    const SolverBody& b = solver[body];
    if (!b.is_free()) return;
    displacement[body].linear += b.inverse_mass * impulse;
    displacement[body].angular += b.inverse_inertia * arm.cross(impulse);
  }
};

/// Fills the gaps of a contact's rows and returns its deepest overlap.
struct PositionCorrector::Fly {
  Stage stage;
  SCREE_HD double operator()(std::int64_t k) const {
    const Contact& c = stage.contacts[k];
    double deepest = 0;
    for (std::int64_t r = c.first_row; r < c.first_row + c.count; ++r) {
      const ContactRow& row = stage.rows[r];
      // What flies past is nearer to the other's tangent plane than to the other.
      if (c.flying && row.impulse.isZero(0)) {
        stage.flown_gap[r] = HUGE_VAL;
        continue;
      }
      stage.flown_gap[r] = row.gap + stage.flown(c, row);
      deepest = fmax(deepest, -stage.flown_gap[r]);
    }
    return deepest;
  }
};

struct PositionCorrector::Sweep {
  Stage stage;
  std::int64_t first;
  SCREE_HD void operator()(std::int64_t k) const {
    const Contact& c = stage.contacts[first + k];
    const double largest =
        tolerance::correction_cap * fmin(smallest_size(stage.bodies.shape[c.i], stage.bodies.size[c.i]),
                                         smallest_size(stage.bodies.shape[c.j], stage.bodies.size[c.j]));
    for (std::int64_t r = c.first_row; r < c.first_row + c.count; ++r) {
      const double overlap = -stage.gap_at_end(c, r);
      if (overlap <= 0) continue;
      const ContactRow& row = stage.rows[r];
      const double part = fmin(tolerance::correction_share * overlap, largest);
      const Vec3 impulse = (part * row.normal_mass) * c.normal;
      stage.move(c.i, row.arm_i, -impulse);
      stage.move(c.j, row.arm_j, impulse);
    }
  }
};

/// Moves a body and says what that changed, at velocities that stay.
struct PositionCorrector::Apply {
  Stage stage;
  Vec3 gravity;
  bool rotation;
  SCREE_HD Ledger operator()(std::int64_t k) const {
    const Displacement& d = stage.displacement[k];
    if (!stage.solver[k].is_free()) return {};
    const double mass = 1.0 / stage.solver[k].inverse_mass;
    const Vec3& spin = stage.bodies.spin[k];
    const Vec3& inverse_inertia = stage.bodies.inverse_inertia[k];
    Quat& q = stage.bodies.orientation[k];
    Ledger ledger;
    Vec3& position = stage.bodies.position[k];
    const Vec3 before = position;
    position += d.linear;
    const Vec3 moved = position - before;  // far from the origin rounding drops some
    ledger.correction = mass * gravity.dot(moved);
    ledger.angular_correction = mass * moved.cross(stage.bodies.velocity[k]);
    if (rotation && !d.angular.isZero(0)) {
      const double energy = rotational_energy(q, spin, inverse_inertia);
      const Vec3 momentum = spin_momentum(q, spin, inverse_inertia);
      q = (rotation_of(d.angular) * q).normalized();
      ledger.correction -= rotational_energy(q, spin, inverse_inertia) - energy;
      ledger.angular_correction += spin_momentum(q, spin, inverse_inertia) - momentum;
    }
    return ledger;
  }
};

Ledger PositionCorrector::correct(double step, const ResponseParameters& parameters, BodyView bodies,
                                  const Array<SolverBody, Host>& solver, ContactSet& set) {
  displacement_.resize(solver.size());
  if (set.contacts.empty()) return {};
  flown_gap_.resize(set.rows.size());
  const Stage stage{bodies,
                    solver.view(),
                    std::as_const(set.contacts).view(),
                    std::as_const(set.rows).view(),
                    flown_gap_.view(),
                    displacement_.view(),
                    step};
  const double deepest = parallel::max<double, Host>("correction.gaps", set.contacts.size(), Fly{stage}, 0.0);
  if (deepest == 0) return {};
  parallel::fill("correction.reset", displacement_, Displacement{});
  for (int sweep = 0; sweep < tolerance::correction_sweeps; ++sweep) {
    for_each_color("correction.sweep", set.coloring, [&stage](std::int64_t first) {
      return Sweep{stage, first};
    });
  }
  return parallel::sum<Ledger, Host>("correction.apply", solver.size(),
                                     Apply{stage, parameters.gravity, parameters.rotation});
}

}  // namespace scree
