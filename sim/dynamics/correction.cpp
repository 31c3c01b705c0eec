#include "sim/dynamics/correction.hpp"

#include "core/parallel_loops.hpp"
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
  View<lanes::Body> displacement;  ///< of the centre (m), and turn, as PointParting has it
  View<lanes::InertiaRoot> roots;
  double step;

  /// How far a gap has opened since the contact was seen. From the places that bodies struck late have come
  /// to; for the others from their velocities, which know of no origin.
  double flown(const Contact& c, const ContactRow& row) const {
    const SolverBody& i = solver[c.i];
    const SolverBody& j = solver[c.j];
    if (c.lead == 0) {
      return 0.5 * step * (c.normal.dot(row.relative_velocity(i, j)) + 0.25 * step * row.bend);
    }
    const Vec3 apart = bodies.period.nearest(bodies.position[c.j] - bodies.position[c.i]);
    const Vec3 moved = apart + row.arm_j - row.arm_i;
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

/// Flies a batch on from its midpoint, and sets its deepest overlap (m).
struct PositionCorrector::FlyBalls {
  Stage stage;
  ConstView<lanes::Members> members;
  ConstView<lanes::BallBatch> batches;
  View<lanes::BallParting> partings;
  double* deepest;
  void operator()(std::int64_t b) const {
    lanes::BallParting& parting = partings[b];
    deepest[b] = lanes::kernels().fly_balls(batches[b], parting, stage.displacement.data(), stage.step);
    for (int l = 0; l < lanes::width; ++l) {
      if ((parting.apart >> l & 1) == 0) continue;
      parting.flown.at[l] =
          stage.flown_gap(stage.contacts[members[b].contact[l]], stage.rows[members[b].row[l]]);
      deepest[b] = fmax(deepest[b], -parting.flown.at[l]);
    }
  }
};

struct PositionCorrector::FlyPoints {
  Stage stage;
  ConstView<lanes::Members> members;
  ConstView<lanes::PointBatch> batches;
  ConstView<lanes::PointRow> rows;
  View<lanes::PointParting> points;
  double* deepest;
  void operator()(std::int64_t b) const {
    const lanes::PointBatch& batch = batches[b];
    const std::int64_t first = batch.first_row;
    deepest[b] = lanes::kernels().fly_points(batch, &rows[first], &points[first], stage.displacement.data(),
                                             stage.roots.data(), stage.step);
    for (int l = 0; batch.apart >> l != 0; ++l) {
      if ((batch.apart >> l & 1) == 0) continue;
      for (int k = 0; k < batch.count; ++k) {
        double& gap = points[first + k].gap.at[l];
        gap = stage.flown_gap(stage.contacts[members[b].contact[l]], stage.rows[members[b].row[l] + k]);
        deepest[b] = fmax(deepest[b], -gap);
      }
    }
  }
};

/// Puts the velocities where the displacements will be.
struct PositionCorrector::LoadBody {
  Stage stage;
  void operator()(std::int64_t k) const {
    if (k == stage.solver.size()) {
      stage.displacement[k] = {Vec3::Zero(), 0, Vec3::Zero(), 0};
      stage.roots[k] = {};
      return;
    }
    const SolverBody& body = stage.solver[k];
    stage.displacement[k] = {body.velocity, body.inverse_mass, body.spin, 0};
    stage.roots[k] = root_of(body.inverse_inertia);
  }
  /// Cholesky's factor.
  static lanes::InertiaRoot root_of(const Mat3& m) {
    lanes::InertiaRoot root{};
    if (m(0, 0) == 0) return root;
    root.xx = sqrt(m(0, 0));
    root.xy = m(0, 1) / root.xx;
    root.xz = m(0, 2) / root.xx;
    root.yy = sqrt(m(1, 1) - root.xy * root.xy);
    root.yz = (m(1, 2) - root.xy * root.xz) / root.yy;
    root.zz = sqrt(m(2, 2) - root.xz * root.xz - root.yz * root.yz);
    return root;
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
  View<lanes::PointParting> points;
  lanes::Body* displacement;
  double* deepest;
  void operator()(std::int64_t b, int count) const {
    lanes::kernels().part_points(&batches[b], count, points.data(), tolerance::correction_share, displacement,
                                 deepest + b);
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
    const lanes::InertiaRoot& root = stage.roots[k];
    const Vec3 turn(root.xx * d.spin.x(), root.xy * d.spin.x() + root.yy * d.spin.y(),
                    root.xz * d.spin.x() + root.yz * d.spin.y() + root.zz * d.spin.z());
    return displace(stage.bodies, k, d.velocity, turn, gravity, rotation);
  }
};

Ledger PositionCorrector::correct(double step, const ResponseParameters& parameters, BodyView bodies,
                                  const Array<SolverBody, Host>& solver, ContactSet& set) {
  overlap_ = 0;
  if (set.contact_count() == 0) return {};
  lanes::Batches& batches = set.batches;
  displacement_.resize(solver.size() + 1);
  roots_.resize(displacement_.size());
  const Stage stage{bodies,        solver.view(), set.contacts.view(), set.rows.view(), displacement_.view(),
                    roots_.view(), step};
  parallel::for_each<Host>("correction.load", displacement_.size(), LoadBody{stage});
  const std::int64_t balls = batches.balls.size();
  deepest_.resize(balls + batches.points.size());
  const auto deepest = [this] {
    return parallel::max<double, Host>("correction.deepest", deepest_.size(),
                                       LoadDepth{std::as_const(deepest_).view()}, 0.0);
  };
  lanes::for_each_batch(
      "correction.gaps", batches,
      FlyBalls{stage, batches.ball_members.view(), batches.balls.view(), batches.partings.view(),
               deepest_.data()},
      FlyPoints{stage, batches.point_members.view(), batches.points.view(), batches.rows.view(),
                batches.point_partings.view(), deepest_.data() + balls});
  if (deepest() == 0) return {};
  parallel::for_each<Host>("correction.reset", displacement_.size(), Reset{stage});
  // Few cost nothing; in a heap what is left is for the next substeps.
  const int most = !set.is_heap() ? 100 : set.shares_loads() ? 24 : 6;
  bool corrected = false;
  for (int sweep = 0; sweep < most && !corrected; ++sweep) {
    lanes::for_each_color("correction.sweep", batches,
                          PartBalls{batches.partings.view(), displacement_.data(), deepest_.data()},
                          PartPoints{batches.points.view(), batches.point_partings.view(),
                                     displacement_.data(), deepest_.data() + balls});
    for (const Guide& guide : parameters.guides) guide.hold(displacement_.view()[guide.body].velocity);
    const double overlap = tolerance::correction_cap * deepest();
    if (sweep == 0) overlap_ = overlap;
    corrected = overlap <= tolerance::corrected_overlap;
  }
  return parallel::sum<Ledger, Host>("correction.apply", solver.size(),
                                     Apply{stage, parameters.gravity, parameters.rotation});
}

}  // namespace scree
