#include "sim/dynamics/correction.hpp"

#include "core/parallel.hpp"
#include "core/tolerances.hpp"
#include "sim/dynamics/lanes/colored.hpp"
#include "sim/dynamics/rotation.hpp"

namespace scree {

struct PositionCorrector::Stage {
  BodyView bodies;
  ConstView<SolverBody> solver;
  ConstView<Contact> contacts;
  ConstView<ContactRow> rows;
  View<lanes::Body> displacement;  ///< of the centre (m), and turn (rad)
  double step;

  /// How far a gap has opened since the contact was seen. From the places that bodies struck late have come
  /// to; for the others from their velocities, which know of no origin.
  double flown(const Contact& c, const ContactRow& row) const {
    const SolverBody& i = solver[c.i];
    const SolverBody& j = solver[c.j];
    if (c.lead == 0) {
      return 0.5 * step * (c.normal.dot(row.relative_velocity(i, j)) + 0.25 * step * row.bend);
    }
    const Vec3 moved = bodies.position[c.j] - bodies.position[c.i] + row.arm_j - row.arm_i;
    const Vec3 turned = j.spin.cross(row.arm_j) - i.spin.cross(row.arm_i);
    return c.normal.dot(moved + (0.5 * step - c.lead) * turned);
  }

  /// Gap at the end of the substep, without displacements.
  double flown_gap(const Contact& c, const ContactRow& row) const {
    // What flies past is nearer to the other's tangent plane than to the other.
    if (c.flying && row.impulse.isZero(0)) return HUGE_VAL;
    return row.gap + flown(c, row);
  }

  double largest_part(const Contact& c) const {
    return tolerance::correction_cap * fmin(smallest_size(bodies.shape[c.i], bodies.size[c.i]),
                                            smallest_size(bodies.shape[c.j], bodies.size[c.j]));
  }
};

/// Fills the gaps of a batch's points and the largest part of each contact; returns the deepest overlap.
struct PositionCorrector::Fly {
  Stage stage;
  ConstView<lanes::Members> members;
  View<lanes::Lane> largest;
  View<lanes::Lane> gaps;
  double of(std::int64_t b, std::int64_t first_gap, int points) const {
    double deepest = 0;
    for (int l = 0; l < lanes::width; ++l) {
      const std::int32_t c = members[b].contact[l];
      largest[b].at[l] = c < 0 ? 0.0 : stage.largest_part(stage.contacts[c]);
      for (int k = 0; k < points; ++k) {
        double& gap = gaps[first_gap + k].at[l];
        gap = c < 0 ? 0.0 : stage.flown_gap(stage.contacts[c], stage.rows[stage.contacts[c].first_row + k]);
        deepest = fmax(deepest, -gap);
      }
    }
    return deepest;
  }
};

struct PositionCorrector::FlyBalls {
  Fly fly;
  double operator()(std::int64_t b) const { return fly.of(b, b, 1); }
};

struct PositionCorrector::FlyPoints {
  Fly fly;
  ConstView<lanes::PointBatch> batches;
  double operator()(std::int64_t b) const { return fly.of(b, batches[b].first_row, batches[b].count); }
};

struct PositionCorrector::Reset {
  Stage stage;
  void operator()(std::int64_t k) const {
    const bool nobody = k == stage.solver.size();
    stage.displacement[k] = {Vec3::Zero(), nobody ? 0.0 : stage.solver[k].inverse_mass, Vec3::Zero(), 0};
  }
};

struct PositionCorrector::PartBalls {
  ConstView<lanes::BallBatch> batches;
  ConstView<lanes::Lane> gaps, largest;
  lanes::Body* displacement;
  void operator()(std::int64_t b) const {
    lanes::kernels().part_balls(batches[b], gaps[b], largest[b], tolerance::correction_share, displacement);
  }
};

struct PositionCorrector::PartPoints {
  ConstView<lanes::PointBatch> batches;
  ConstView<lanes::PointRow> rows;
  ConstView<lanes::Lane> gaps, largest;
  lanes::Body* displacement;
  void operator()(std::int64_t b) const {
    const std::int64_t first = batches[b].first_row;
    lanes::kernels().part_points(batches[b], &rows[first], &gaps[first], largest[b],
                                 tolerance::correction_share, displacement);
  }
};

/// Moves a body and says what that changed, at velocities that stay.
struct PositionCorrector::Apply {
  Stage stage;
  Vec3 gravity;
  bool rotation;
  SCREE_HD Ledger operator()(std::int64_t k) const {
    const lanes::Body& d = stage.displacement[k];
    if (!stage.solver[k].is_free()) return {};
    const double mass = 1.0 / stage.solver[k].inverse_mass;
    const Vec3& spin = stage.bodies.spin[k];
    const Vec3& inverse_inertia = stage.bodies.inverse_inertia[k];
    Quat& q = stage.bodies.orientation[k];
    Ledger ledger;
    Vec3& position = stage.bodies.position[k];
    const Vec3 before = position;
    position += d.velocity;
    const Vec3 moved = position - before;  // far from the origin rounding drops some
    ledger.correction = mass * gravity.dot(moved);
    ledger.angular_correction = mass * moved.cross(stage.bodies.velocity[k]);
    if (rotation && !d.spin.isZero(0)) {
      const double energy = rotational_energy(q, spin, inverse_inertia);
      const Vec3 momentum = spin_momentum(q, spin, inverse_inertia);
      q = (rotation_of(d.spin) * q).normalized();
      ledger.correction -= rotational_energy(q, spin, inverse_inertia) - energy;
      ledger.angular_correction += spin_momentum(q, spin, inverse_inertia) - momentum;
    }
    return ledger;
  }
};

Ledger PositionCorrector::correct(double step, const ResponseParameters& parameters, BodyView bodies,
                                  const Array<SolverBody, Host>& solver, const ContactSet& set) {
  if (set.contacts.empty()) return {};
  const lanes::Batches& batches = set.batches;
  displacement_.resize(solver.size() + 1);
  ball_gaps_.resize(batches.balls.size());
  largest_of_balls_.resize(batches.balls.size());
  point_gaps_.resize(batches.rows.size());
  largest_of_points_.resize(batches.points.size());
  const Stage stage{bodies, solver.view(), set.contacts.view(), set.rows.view(), displacement_.view(), step};
  const FlyBalls fly_balls{{stage, batches.ball_members.view(), largest_of_balls_.view(), ball_gaps_.view()}};
  const FlyPoints fly_points{
      {stage, batches.point_members.view(), largest_of_points_.view(), point_gaps_.view()},
      batches.points.view()};
  const double deepest =
      fmax(parallel::max<double, Host>("correction.gaps", batches.balls.size(), fly_balls, 0.0),
           parallel::max<double, Host>("correction.gaps", batches.points.size(), fly_points, 0.0));
  if (deepest == 0) return {};
  parallel::for_each<Host>("correction.reset", displacement_.size(), Reset{stage});
  for (int sweep = 0; sweep < tolerance::correction_sweeps; ++sweep) {
    lanes::for_each_color(
        "correction.sweep", batches,
        PartBalls{batches.balls.view(), ball_gaps_.view(), largest_of_balls_.view(), displacement_.data()},
        PartPoints{batches.points.view(), batches.rows.view(), point_gaps_.view(), largest_of_points_.view(),
                   displacement_.data()});
  }
  return parallel::sum<Ledger, Host>("correction.apply", solver.size(),
                                     Apply{stage, parameters.gravity, parameters.rotation});
}

}  // namespace scree
