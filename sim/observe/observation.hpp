// The state of a run at one instant: the quantities behind the measures of the scene language.
#pragma once

#include "core/math.hpp"
#include "narrowphase/stats.hpp"

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

namespace scree {

/// Energies that leave or enter, by cause, accumulated since t = 0 (J). Each is computed from its own
/// definition (docs/method.md), none as a remainder. Dissipated amounts are positive if energy is lost.
struct Ledger {
  double restitution = 0;  ///< energy dissipated by normal impulses
  double friction = 0;     ///< energy dissipated by tangential impulses
  double correction = 0;   ///< energy dissipated by position correction (negative: it lifted bodies)
  double work = 0;         ///< work done on the bodies by prescribed ones and by applied forces
  double integration = 0;  ///< drift of the energy of free rotation
  Vec3 angular_correction = Vec3::Zero();  ///< angular momentum added by position correction (kg m^2/s)

  SCREE_HD friend Ledger operator+(const Ledger& a, const Ledger& b) {
    return {a.restitution + b.restitution, a.friction + b.friction,
            a.correction + b.correction,   a.work + b.work,
            a.integration + b.integration, a.angular_correction + b.angular_correction};
  }
};

/// Amounts that bodies brought when they appeared, less those that bodies took when they were removed, since
/// t = 0.
struct Exchange {
  double mass = 0;                       ///< kg
  double energy = 0;                     ///< J
  Vec3 momentum = Vec3::Zero();          ///< kg m/s
  Vec3 angular_momentum = Vec3::Zero();  ///< angular momentum about the origin (kg m^2/s)

  friend Exchange operator+(const Exchange& a, const Exchange& b) {
    return {a.mass + b.mass, a.energy + b.energy, a.momentum + b.momentum,
            a.angular_momentum + b.angular_momentum};
  }
};

/// Depths of all overlapping pairs at the end of the step, by true geometry, planes included (m). `relative`:
/// divided by the smaller body's smallest_size.
struct Penetration {
  double max = 0;
  double mean = 0;
  double p99 = 0;
  double relative_max = 0;
  double relative_mean = 0;
  std::array<std::int32_t, 2> deepest{-1, -1};  ///< ids of the bodies of relative_max; -1: no pair overlaps

  static Penetration unknown() {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    return {nan, nan, nan, nan, nan, {-1, -1}};
  }
};

/// Counts of what the loops of the run did, since t = 0. Loops that hit their bound are counted, never
/// silent.
struct Counters {
  std::int64_t substeps = 0;
  std::int64_t redone = 0;         ///< steps that failed and were taken again, in smaller substeps
  std::int64_t cuts = 0;           ///< cuts of substeps, where a sliding contact came to stick
  std::int64_t sweeps = 0;         ///< sweeps over the contacts
  std::int64_t direct = 0;         ///< islands solved by Newton's method
  std::int64_t direct_failed = 0;  ///< islands not solved by Newton's method, left to the sweeps
  std::int64_t long_direct = 0;    ///< islands solved by a second direct solution, with higher limits
  std::int64_t long_direct_failed = 0;
  double residual = 0;       ///< largest natural residual left by the response, in the accurate mode
  std::int64_t scaled = 0;   ///< islands whose impulses were scaled down, since they would have gained energy
  std::int64_t impacts = 0;  ///< impacts found in free flight, with and without a bounce
  std::int64_t unconverged = 0;         ///< substeps that used all sweeps; raise response.iterations
  std::int64_t unfinished_impacts = 0;  ///< substeps with chains of impacts that hit the bound (then e = 0)
  std::int64_t pcs_made = 0;  ///< broad phases: at the start, and whenever the pairs could not be kept
  NarrowPhaseStats narrowphase;
};

/// The bodies that a region has removed, since t = 0.
struct Removed {
  std::int64_t count = 0;
  double mass = 0;  ///< kg

  Removed& operator+=(const Removed& more) {
    count += more.count;
    mass += more.mass;
    return *this;
  }
};

/// A region of the scene at one instant; its bodies are the free ones whose centre lies in it.
struct RegionState {
  std::int64_t count = 0;
  double fraction = 0;  ///< share of its volume that is solid
  double flux = 0;      ///< mass gained over the last step, divided by the step's length (kg/s)
  Removed removed;
};

struct Observation {
  double time = 0;
  std::int64_t step = 0;
  double kinetic_linear = 0;  ///< translational energy of the free bodies (J)
  double kinetic_angular = 0;
  double potential = 0;  ///< -sum m g.x
  Ledger ledger;
  Exchange exchange;
  double energy_scale = 0;  ///< largest K + |U - U0| so far (J)
  double unexplained = 0;   ///< |energy change that the ledger does not explain| / energy_scale
  Vec3 momentum = Vec3::Zero();
  Vec3 angular_momentum = Vec3::Zero();  ///< angular momentum about the origin
  Vec3 centre = Vec3::Zero();            ///< centre of mass of the free bodies (m); NaN if there are none
  Counters counters;
  Penetration penetration;
  double gap_mean = 0;         ///< mean |gap| of loaded contact points (m)
  std::int64_t contacts = 0;   ///< contact points that carried an impulse in the last substep
  std::int64_t pairs = 0;      ///< size of the PCS
  std::int64_t bodies = 0;     ///< bodies that are present
  std::int64_t left = 0;       ///< bodies that have left the world and were removed
  std::int64_t requested = 0;  ///< bodies that emitters were to send
  std::int64_t emitted = 0;    ///< bodies of emitters that found room
  double speed_max = 0;        ///< largest speed of the free bodies (m/s)
  double speed_rms = 0;
  double speed_kurtosis = 0;         ///< mean v^4 / (mean v^2)^2; NaN at rest
  double coordination_mean = 0;      ///< loaded contacts per free body, counted for each of the two bodies
  std::vector<RegionState> regions;  ///< regions in the order of the scene

  double kinetic() const { return kinetic_linear + kinetic_angular; }
  double total() const { return kinetic() + potential; }
};

/// The state of one body at one instant. All values are NaN while it is absent.
struct BodyState {
  Vec3 position = Vec3::Zero();
  Vec3 velocity = Vec3::Zero();
  Vec3 spin = Vec3::Zero();
  Quat orientation = Quat::Identity();
  Quat start_orientation = Quat::Identity();
  Vec3 acceleration = Vec3::Zero();  ///< mean rate of change of velocity over the last step (m/s^2)
  Vec3 force = Vec3::Zero();         ///< mean contact force over the last step: contact impulse / step (N)
  Vec3 torque = Vec3::Zero();        ///< moment of this force about the centre of a triangle (N m)

  static BodyState absent() {
    const Vec3 none = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
    const Quat no_orientation(none.x(), none.x(), none.x(), none.x());
    return {none, none, none, no_orientation, no_orientation, none, none, none};
  }
};

}  // namespace scree
