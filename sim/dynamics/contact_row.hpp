// One contact point as the solver sees it, and the local Coulomb problem at that point.
#pragma once

#include "core/math.hpp"

#include <algorithm>

namespace scree {

/// What the solver reads and writes of a body: velocities, and the inverse masses at the midpoint
/// orientation.
struct SolverBody {
  Vec3 velocity;
  Vec3 spin;
  double inverse_mass;   ///< 0: not free
  Mat3 inverse_inertia;  ///< world frame

  SCREE_HD bool is_free() const { return inverse_mass > 0; }
  SCREE_HD Vec3 velocity_at(const Vec3& arm) const { return velocity + spin.cross(arm); }
  SCREE_HD void push(const Vec3& arm, const Vec3& impulse) {
    velocity += inverse_mass * impulse;
    spin += inverse_inertia * arm.cross(impulse);
  }
};

/// A contact point between bodies i and j. Impulses act on j, and reversed on i, at one common point, so that
/// momentum and angular momentum are conserved to rounding.
struct ContactRow {
  Vec3 arm_i;  ///< from the centre of i to the common point (m)
  Vec3 arm_j;
  double gap;           ///< at the midpoint (m)
  double target;        ///< normal velocity to reach if the contact pushes (m/s)
  Vec3 impulse;         ///< accumulated, world frame (N s)
  Mat3 stick;           ///< inverse of the Delassus matrix W of the point (kg)
  Vec3 coupling;        ///< W n: change of relative velocity by a unit normal impulse (1/kg)
  double normal_mass;   ///< 1 / (n.W n) (kg)
  double tangent_mass;  ///< 1 / largest eigenvalue of W in the tangent plane (kg)

  SCREE_HD Vec3 relative_velocity(const SolverBody& i, const SolverBody& j) const {
    return j.velocity_at(arm_j) - i.velocity_at(arm_i);
  }
  SCREE_HD void push(const Vec3& change, SolverBody& i, SolverBody& j) const {
    i.push(arm_i, -change);
    j.push(arm_j, change);
  }
};

/// Delassus matrix of one body at an arm: its share of the change of relative velocity by an impulse (1/kg).
SCREE_HD inline Mat3 delassus_share(const SolverBody& body, const Vec3& arm) {
  Mat3 cross;
  cross << 0, -arm.z(), arm.y(), arm.z(), 0, -arm.x(), -arm.y(), arm.x(), 0;
  return body.inverse_mass * Mat3::Identity() - cross * body.inverse_inertia * cross;
}

/// Prepares a row with zero impulse and target. At least one of the bodies is free.
SCREE_HD inline ContactRow make_row(const Vec3& normal, const Vec3& arm_i, const Vec3& arm_j, double gap,
                                    const SolverBody& i, const SolverBody& j) {
  const Mat3 w = delassus_share(i, arm_i) + delassus_share(j, arm_j);
  const Vec3 t = tangent_of(normal);
  const Vec3 b = normal.cross(t);
  const double tt = t.dot(w * t);
  const double bb = b.dot(w * b);
  const double tb = t.dot(w * b);
  const double half_difference = 0.5 * (tt - bb);
  ContactRow row;
  row.arm_i = arm_i;
  row.arm_j = arm_j;
  row.gap = gap;
  row.target = 0;
  row.impulse = Vec3::Zero();
  row.stick = w.inverse();
  row.coupling = w * normal;
  row.normal_mass = 1.0 / normal.dot(row.coupling);
  row.tangent_mass = 1.0 / (0.5 * (tt + bb) + sqrt(half_difference * half_difference + tb * tb));
  return row;
}

/// Splits an impulse into Coulomb's cone: normal part at least 0, tangential part on the disc of radius mu *
/// normal.
SCREE_HD inline Vec3 project_on_cone(const Vec3& impulse, const Vec3& normal, double friction) {
  const double pn = impulse.dot(normal);
  if (pn <= 0) return Vec3::Zero();
  const Vec3 pt = impulse - pn * normal;
  const double radius = friction * pn;
  const double length = pt.norm();
  return length <= radius ? impulse : Vec3(pn * normal + (radius / length) * pt);
}

/// The impulse that the point should carry in place of row.impulse, given the relative velocity u that holds
/// now. First the impulse that makes the point stick; if it leaves the cone, the normal impulse that reaches
/// the target and one projected step of the tangential one. For spheres W is diagonal and this is the exact
/// local solution; otherwise its fixed points are (Coulomb's disc, both tangents together).
SCREE_HD inline Vec3 coulomb_update(const ContactRow& row, const Vec3& normal, double friction,
                                    const Vec3& u) {
  const double pn_old = row.impulse.dot(normal);
  if (friction > 0) {
    const Vec3 sticking = row.impulse - row.stick * (u - row.target * normal);
    const double pn = sticking.dot(normal);
    if (pn >= 0 && (sticking - pn * normal).squaredNorm() <= friction * friction * pn * pn) return sticking;
  }
  const double pn = fmax(0.0, pn_old - (u.dot(normal) - row.target) * row.normal_mass);
  if (friction == 0 || pn == 0) return pn * normal;
  const Vec3 v = u + row.coupling * (pn - pn_old);
  const Vec3 vt = v - v.dot(normal) * normal;
  const Vec3 pt = row.impulse - pn_old * normal - row.tangent_mass * vt;
  const double radius = friction * pn;
  const double length = pt.norm();
  return pn * normal + (length <= radius ? pt : Vec3((radius / length) * pt));
}

/// One Gauss-Seidel sweep over the rows of a contact, with its two bodies at hand.
SCREE_HD inline void sweep_rows(ContactRow* rows, int count, const Vec3& normal, double friction,
                                SolverBody& i, SolverBody& j) {
  for (int k = 0; k < count; ++k) {
    ContactRow& row = rows[k];
    const Vec3 impulse = coulomb_update(row, normal, friction, row.relative_velocity(i, j));
    row.push(impulse - row.impulse, i, j);
    row.impulse = impulse;
  }
}

}  // namespace scree
