#include "sim/dynamics/correction.hpp"

#include "core/parallel.hpp"
#include "core/tolerances.hpp"
#include "sim/dynamics/displace.hpp"
#include "sim/dynamics/lanes/colored.hpp"

#include <utility>

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
};

/// Flies a batch on from its midpoint; returns the deepest overlap (m).
struct PositionCorrector::FlyBalls {
  Stage stage;
  ConstView<lanes::Members> members;
  ConstView<lanes::BallBatch> batches;
  View<lanes::BallParting> partings;
  const lanes::Body* velocities;
  double operator()(std::int64_t b) const {
    lanes::BallParting& parting = partings[b];
    double deepest = lanes::kernels().fly_balls(batches[b], parting, velocities, stage.step);
    for (int l = 0; l < lanes::width; ++l) {
      if ((parting.apart >> l & 1) == 0) continue;
      parting.flown.at[l] =
          stage.flown_gap(stage.contacts[members[b].contact[l]], stage.rows[members[b].row[l]]);
      deepest = fmax(deepest, -parting.flown.at[l]);
    }
    return deepest;
  }
};

struct PositionCorrector::FlyPoints {
  Stage stage;
  ConstView<lanes::Members> members;
  ConstView<lanes::PointBatch> batches;
  View<lanes::Lane> caps;            ///< of each batch
  View<lanes::PointParting> points;  ///< of each of its points
  double operator()(std::int64_t b) const {
    const lanes::PointBatch& batch = batches[b];
    double deepest = 0;
    for (int l = 0; l < lanes::width; ++l) {
      const std::int32_t c = members[b].contact[l];
      caps[b].at[l] = c == lanes::none ? 0.0 : tolerance::correction_cap * stage.contacts[c].size;
      for (int k = 0; k < batch.count; ++k) {
        lanes::PointParting& point = points[batch.first_row + k];
        double& gap = point.flown.at[l];
        point.pushed.at[l] = 0;
        gap = c == lanes::none ? 0.0 : stage.flown_gap(stage.contacts[c], stage.rows[members[b].row[l] + k]);
        deepest = fmax(deepest, -gap);
      }
    }
    return deepest;
  }
};

/// Puts the velocities where the displacements will be.
struct PositionCorrector::LoadVelocity {
  Stage stage;
  void operator()(std::int64_t k) const {
    const bool exists = k < stage.solver.size();
    stage.displacement[k].velocity = exists ? stage.solver[k].velocity : Vec3::Zero();
    stage.displacement[k].inverse_mass = exists ? stage.solver[k].inverse_mass : 0;
  }
};

struct PositionCorrector::Reset {
  Stage stage;
  void operator()(std::int64_t k) const {
    lanes::Body& body = stage.displacement[k];
    body = {Vec3::Zero(), body.inverse_mass, Vec3::Zero(), 0};
  }
};

struct PositionCorrector::PartBalls {
  View<lanes::BallParting> partings;
  lanes::Body* displacement;
  double* deepest;  ///< overlap that a batch had, in units of the cap
  void operator()(std::int64_t b) const {
    deepest[b] = lanes::kernels().part_balls(partings[b], tolerance::correction_share, displacement);
  }
};

struct PositionCorrector::PartPoints {
  ConstView<lanes::PointBatch> batches;
  ConstView<lanes::PointRow> rows;
  View<lanes::PointParting> points;
  ConstView<lanes::Lane> caps;
  lanes::Body* displacement;
  double* deepest;
  void operator()(std::int64_t b) const {
    const std::int64_t first = batches[b].first_row;
    deepest[b] = lanes::kernels().part_points(batches[b], &rows[first], &points[first], caps[b],
                                              tolerance::correction_share, displacement);
  }
};

struct PositionCorrector::LoadDepth {
  ConstView<double> deepest;
  SCREE_HD double operator()(std::int64_t b) const { return deepest[b]; }
};

/// Moves a body and says what that changed, at velocities that stay.
struct PositionCorrector::Apply {
  Stage stage;
  Vec3 gravity;
  bool rotation;
  SCREE_HD Ledger operator()(std::int64_t k) const {
    const lanes::Body& d = stage.displacement[k];
    if (!stage.solver[k].is_free()) return {};
    return displace(stage.bodies, k, d.velocity, d.spin, gravity, rotation);
  }
};

Ledger PositionCorrector::correct(double step, const ResponseParameters& parameters, BodyView bodies,
                                  const Array<SolverBody, Host>& solver, ContactSet& set) {
  overlap_ = 0;
  if (set.contact_count() == 0) return {};
  lanes::Batches& batches = set.batches;
  displacement_.resize(solver.size() + 1);
  points_.resize(batches.rows.size());
  caps_.resize(batches.points.size());
  const Stage stage{bodies, solver.view(), set.contacts.view(), set.rows.view(), displacement_.view(), step};
  parallel::for_each<Host>("correction.velocities", displacement_.size(), LoadVelocity{stage});
  const FlyBalls fly_balls{stage, batches.ball_members.view(), batches.balls.view(), batches.partings.view(),
                           displacement_.data()};
  const FlyPoints fly_points{stage, batches.point_members.view(), batches.points.view(), caps_.view(),
                             points_.view()};
  const double deepest =
      fmax(parallel::max<double, Host>("correction.gaps", batches.balls.size(), fly_balls, 0.0),
           parallel::max<double, Host>("correction.gaps", batches.points.size(), fly_points, 0.0));
  if (deepest == 0) return {};
  parallel::for_each<Host>("correction.reset", displacement_.size(), Reset{stage});
  const std::int64_t balls = batches.balls.size();
  deepest_.resize(balls + batches.points.size());
  // Few cost nothing; in a heap what is left is for the next substeps.
  const int most = !set.is_heap() ? 100 : set.shares_loads() ? 24 : 6;
  bool corrected = false;
  for (int sweep = 0; sweep < most && !corrected; ++sweep) {
    lanes::for_each_color("correction.sweep", batches,
                          PartBalls{batches.partings.view(), displacement_.data(), deepest_.data()},
                          PartPoints{batches.points.view(), batches.rows.view(), points_.view(), caps_.view(),
                                     displacement_.data(), deepest_.data() + balls});
    const double overlap = tolerance::correction_cap *
                           parallel::max<double, Host>("correction.deepest", deepest_.size(),
                                                       LoadDepth{std::as_const(deepest_).view()}, 0.0);
    if (sweep == 0) overlap_ = overlap;
    corrected = overlap <= tolerance::corrected_overlap;
  }
  return parallel::sum<Ledger, Host>("correction.apply", solver.size(),
                                     Apply{stage, parameters.gravity, parameters.rotation});
}

}  // namespace scree
