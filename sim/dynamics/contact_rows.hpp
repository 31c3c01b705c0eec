// The rows of the contacts, as the bodies are at the midpoint.
#pragma once

#include "core/tolerances.hpp"
#include "narrowphase/tube.hpp"
#include "sim/dynamics/solve_stage.hpp"

#include <cmath>

namespace scree {

/// Arms, gaps and targets at the midpoint. Masses of points are for the lanes to make.
struct PrepareRows {
  SolveStage stage;
  SCREE_HD void operator()(std::int64_t c) const {
    Contact& contact = stage.contacts[c];
    const ManifoldHeader& m = stage.manifolds.headers[c];
    const ContactPoint* points = stage.manifolds.points_of(m);
    const BodyView& bodies = stage.bodies;
    // Where several points share the load, the closed shell keeps all of them in contact; a single point
    // rests at 0.
    const double shell = contact.count == 1 ? 0.0 : tolerance::closed_gap * contact.size;
    contact.aligned = contact.balls && turns_as_ball(contact.i) && turns_as_ball(contact.j);
    for (int k = 0; k < contact.count; ++k) {
      ContactRow& row = stage.rows_of(c)[k];
      const Vec3 impulse = row.impulse;
      const Vec3& point = points[k].position;
      const SolverBody& i = stage.solver[m.i];
      const SolverBody& j = stage.solver[m.j];
      Vec3 arm_i = point - (bodies.position[m.i] + contact.lead * i.velocity);
      Vec3 arm_j = point - (bodies.position[m.j] + contact.lead * j.velocity);
      bodies.period.make_nearest(arm_i);
      bodies.period.make_nearest(arm_j);
      row = contact.balls ? make_ball_row(arm_i, arm_j, points[k].gap, i, j)
                          : row_at(arm_i, arm_j, points[k].gap);
      row.impulse = impulse;
      // The next midpoint must not overlap: the gap may close by then, and no more (speculative contact).
      row.target = row.gap > shell ? -(row.gap - shell) / (stage.step - contact.lead) : 0.0;
      if (contact.balls) {
        row.bend = bend_of(m);
        row.target -= 0.5 * stage.step * row.bend;
      }
      // Held, a contact that was parting before the kick would gain energy, p.(u- + u+)/2: it may close as
      // fast.
      row.target = fmin(row.target, stage.noise - contact.normal.dot(stage.velocity_before(contact, row)));
      if (contact.flying) row.target = fmin(row.target, flight_speed(contact, row));
    }
  }

  SCREE_HD bool turns_as_ball(std::int32_t body) const {
    return stage.solver[body].is_free() || stage.solver[body].spin.isZero(0);
  }

  /// Of balls on one another, and of a ball along the wall of a tube: the normal turns with the centres.
  SCREE_HD double bend_of(const ManifoldHeader& m) const {
    const BodyView& bodies = stage.bodies;
    const Vec3 w = stage.solver[m.j].velocity - stage.solver[m.i].velocity;
    Vec3 across = w - w.dot(m.normal) * m.normal;
    const bool ball_i = bodies.shape[m.i] == Shape::sphere;
    const bool ball_j = bodies.shape[m.j] == Shape::sphere;
    if (ball_i && ball_j) return across.squaredNorm() / (bodies.size[m.i].x() + bodies.size[m.j].x());
    const std::int32_t other = ball_i ? m.j : m.i;
    if (bodies.shape[other] != Shape::tube || m.part != tube_wall) return 0;
    const Vec3 axis = bodies.orientation[other] * Vec3::UnitZ();
    across -= across.dot(axis) * axis;
    const double reach = bodies.size[other].x() - bodies.size[ball_i ? m.i : m.j].x();
    return reach > 0 ? -across.squaredNorm() / reach : 0.0;
  }

  /// A little faster than the flight closes along the normal, so that rounding pushes nobody.
  SCREE_HD double flight_speed(const Contact& contact, const ContactRow& row) const {
    const double speed = contact.normal.dot(stage.velocity_after(contact, row));
    return speed - tolerance::flight_margin * fabs(speed);
  }
};

}  // namespace scree
