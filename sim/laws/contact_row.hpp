// One contact point as the solver sees it, and the local Coulomb problem at that point.
#pragma once

#include "core/math.hpp"

#include <algorithm>

namespace scree {

/// The state of a body that the solver reads and writes: its velocities, and its inverse mass and inertia at
/// the midpoint orientation (in an impact, at the orientation of that instant).
struct SolverBody {
  Vec3 velocity;
  Vec3 spin;
  double inverse_mass;   ///< inverse mass (1/kg); 0 for a body that is not free
  Mat3 inverse_inertia;  ///< inverse inertia tensor, world frame (1/(kg m^2))

  SCREE_HD bool is_free() const { return inverse_mass > 0; }
  SCREE_HD Vec3 velocity_at(const Vec3& arm) const { return velocity + spin.cross(arm); }
  SCREE_HD void push(const Vec3& arm, const Vec3& impulse) {
    velocity += inverse_mass * impulse;
    spin += inverse_inertia * arm.cross(impulse);
  }
};

/// A contact point between bodies i and j. An impulse acts on j, and its opposite on i, at one common point,
/// so that momentum and angular momentum are conserved to rounding.
struct ContactRow {
  Vec3 arm_i;  ///< arm from the centre of i to the common point (m)
  Vec3 arm_j;
  double gap;           ///< gap at the midpoint (m)
  double curvature;     ///< acceleration of the gap by the turning of the normal (m/s^2)
  double target;        ///< normal relative velocity to reach if the contact pushes (m/s)
  Vec3 impulse;         ///< accumulated impulse, world frame (N s)
  double normal_mass;   ///< effective mass 1 / (n.W n); W is the Delassus matrix of the point (kg)
  double tangent_mass;  ///< 1 / largest eigenvalue of W in the tangent plane (kg)

  SCREE_HD Vec3 relative_velocity(const Vec3& velocity_i, const Vec3& spin_i, const Vec3& velocity_j,
                                  const Vec3& spin_j) const {
    return velocity_j + spin_j.cross(arm_j) - (velocity_i + spin_i.cross(arm_i));
  }
  SCREE_HD Vec3 relative_velocity(const SolverBody& i, const SolverBody& j) const {
    return relative_velocity(i.velocity, i.spin, j.velocity, j.spin);
  }
  SCREE_HD void push(const Vec3& more, SolverBody& i, SolverBody& j) const {
    i.push(arm_i, -more);
    j.push(arm_j, more);
  }
};

/// The data that a row needs in addition if W couples the normal with the tangents, or if the tangents
/// differ.
struct RowCoupling {
  Mat3 stick;   ///< inverse of W (kg)
  Vec3 normal;  ///< W n: change of relative velocity by a unit normal impulse (1/kg)
};

/// The change of impulses and their size: sums of squares over rows, each divided by the effective mass of
/// its row (J), so that heavy and light contacts have the same weight.
struct ImpulseChange {
  double step = 0;
  double size = 0;

  SCREE_HD bool within(double tolerance) const { return step <= tolerance * tolerance * size; }
  SCREE_HD void add(const ContactRow& row, const Vec3& change) {
    step += change.squaredNorm() / row.normal_mass;
    size += row.impulse.squaredNorm() / row.normal_mass;
  }
  SCREE_HD friend ImpulseChange operator+(const ImpulseChange& a, const ImpulseChange& b) {
    return {a.step + b.step, a.size + b.size};
  }
};

/// Returns the Delassus matrix of one body at an arm: its share of the change of relative velocity by a unit
/// impulse (1/kg).
SCREE_HD inline Mat3 delassus_share(const SolverBody& body, const Vec3& arm) {
  Mat3 cross;
  cross << 0, -arm.z(), arm.y(), arm.z(), 0, -arm.x(), -arm.y(), arm.x(), 0;
  return body.inverse_mass * Mat3::Identity() - cross * body.inverse_inertia * cross;
}

/// Returns a row with its lever arms and gap. Its impulse, target and curvature are 0; the caller sets the
/// effective masses.
SCREE_HD inline ContactRow row_at(const Vec3& arm_i, const Vec3& arm_j, double gap) {
  ContactRow row;
  row.arm_i = arm_i;
  row.arm_j = arm_j;
  row.gap = gap;
  row.curvature = row.target = 0;
  row.impulse.setZero();
  return row;
}

/// Returns the largest eigenvalue of a symmetric matrix in the plane across a normal.
SCREE_HD inline double largest_across(const Mat3& w, const Vec3& normal) {
  const Vec3 t = tangent_of(normal);
  const Vec3 b = normal.cross(t);
  const double tt = t.dot(w * t);
  const double bb = b.dot(w * b);
  const double tb = t.dot(w * b);
  const double half_difference = 0.5 * (tt - bb);
  return 0.5 * (tt + bb) + sqrt(half_difference * half_difference + tb * tb);
}

/// Returns a row with zero impulse and target, and sets its coupling. At least one of the bodies is free.
SCREE_HD inline ContactRow make_row(const Vec3& normal, const Vec3& arm_i, const Vec3& arm_j, double gap,
                                    const SolverBody& i, const SolverBody& j, RowCoupling& coupling) {
  const Mat3 w = delassus_share(i, arm_i) + delassus_share(j, arm_j);
  coupling.stick = w.inverse();
  coupling.normal = w * normal;
  ContactRow row = row_at(arm_i, arm_j, gap);
  row.normal_mass = 1.0 / normal.dot(coupling.normal);
  row.tangent_mass = 1.0 / largest_across(w, normal);
  return row;
}

/// The effective masses of a contact of balls along the normal and along the tangents (a body that is not
/// free counts as a ball). The arms of balls lie along the normal, so that W is diagonal with equal tangents
/// and nothing couples.
struct BallMasses {
  double normal, tangent;  ///< kg
};
SCREE_HD inline BallMasses ball_masses(double inverse_mass_i, double inverse_inertia_i, double arm_square_i,
                                       double inverse_mass_j, double inverse_inertia_j, double arm_square_j) {
  const double normal = inverse_mass_i + inverse_mass_j;
  return {1.0 / normal, 1.0 / (normal + inverse_inertia_i * arm_square_i + inverse_inertia_j * arm_square_j)};
}

/// Returns the row that make_row() would return, for a contact of balls.
SCREE_HD inline ContactRow make_ball_row(const Vec3& arm_i, const Vec3& arm_j, double gap,
                                         const SolverBody& i, const SolverBody& j) {
  ContactRow row = row_at(arm_i, arm_j, gap);
  const BallMasses masses = ball_masses(i.inverse_mass, i.inverse_inertia(0, 0), arm_i.squaredNorm(),
                                        j.inverse_mass, j.inverse_inertia(0, 0), arm_j.squaredNorm());
  row.normal_mass = masses.normal;
  row.tangent_mass = masses.tangent;
  return row;
}

/// Returns an impulse cut to Coulomb's cone: its normal part is at least 0, and its tangential part lies in
/// the disc of radius mu * normal part.
SCREE_HD inline Vec3 project_on_cone(const Vec3& impulse, const Vec3& normal, double friction) {
  const double pn = impulse.dot(normal);
  if (pn <= 0) return Vec3::Zero();
  const Vec3 pt = impulse - pn * normal;
  const double radius = friction * pn;
  const double length = pt.norm();
  return length <= radius ? impulse : Vec3(pn * normal + (radius / length) * pt);
}

/// Returns the impulse with the normal part pn >= 0 and the tangential part pt, which is cut to Coulomb's
/// disc.
SCREE_HD inline Vec3 on_disc(double pn, const Vec3& pt, const Vec3& normal, double friction) {
  const double radius = friction * pn;
  const double square = pt.squaredNorm();
  return pn * normal + (square <= radius * radius ? pt : Vec3((radius / sqrt(square)) * pt));
}

/// Returns the impulse that the point should carry in place of row.impulse, given its present relative
/// velocity u. This is the impulse that makes the point stick. If that leaves the cone, it is the normal
/// impulse that reaches the target, with one projected step of the tangential impulse. The fixed points are
/// the local solutions (Coulomb's disc, both tangents together).
SCREE_HD inline Vec3 coulomb_update(const ContactRow& row, const RowCoupling& coupling, const Vec3& normal,
                                    double friction, const Vec3& u) {
  const double pn_old = row.impulse.dot(normal);
  if (friction > 0) {
    Vec3 sticking = row.impulse - coupling.stick * (u - row.target * normal);
    const double pn = sticking.dot(normal);
    if (pn >= 0 && (sticking - pn * normal).squaredNorm() <= friction * friction * pn * pn) return sticking;
  }
  const double pn = fmax(0.0, pn_old - (u.dot(normal) - row.target) * row.normal_mass);
  if (friction == 0 || pn == 0) return pn * normal;
  const Vec3 v = u + coupling.normal * (pn - pn_old);
  const Vec3 vt = v - v.dot(normal) * normal;
  return on_disc(pn, row.impulse - pn_old * normal - row.tangent_mass * vt, normal, friction);
}

/// Returns the point to which a projected step, with the effective masses as its length, takes row.impulse,
/// given the present relative velocity u. Impulses solve the contact problem if this natural map leaves all
/// of them unchanged. For a contact of balls its value is the exact local solution.
SCREE_HD inline Vec3 natural_map(const ContactRow& row, const Vec3& normal, double friction, const Vec3& u) {
  const double pn_old = row.impulse.dot(normal);
  const double un = u.dot(normal);
  const double pn = fmax(0.0, pn_old - (un - row.target) * row.normal_mass);
  if (friction == 0 || pn == 0) return pn * normal;
  return on_disc(pn, row.impulse - pn_old * normal - row.tangent_mass * (u - un * normal), normal, friction);
}

/// Does one Gauss-Seidel sweep over the rows of a contact, and updates its two bodies.
SCREE_HD inline void sweep_rows(ContactRow* rows, const RowCoupling* couplings, int count, const Vec3& normal,
                                double friction, SolverBody& i, SolverBody& j) {
  for (int k = 0; k < count; ++k) {
    ContactRow& row = rows[k];
    const Vec3 impulse = coulomb_update(row, couplings[k], normal, friction, row.relative_velocity(i, j));
    row.push(impulse - row.impulse, i, j);
    row.impulse = impulse;
  }
}

}  // namespace scree
