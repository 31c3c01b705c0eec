// Data on the inner workings of a running scene, which are computed only on request.
#pragma once

#include "core/math.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace scree {

/// The bodies of a potentially colliding pair, i < j.
using BodyPair = std::array<std::int32_t, 2>;

/// The box of a body in the broad phase (m, relative to the simulation's local origin); inverted if the body
/// has no box: planes, and absent bodies.
struct BodyBox {
  std::array<float, 3> lo;
  std::array<float, 3> hi;
};

/// A contact of the last substep.
struct ContactForce {
  std::int32_t i;
  std::int32_t j;
  Vec3 force;  ///< force on j (N)
  Vec3 point;  ///< point where the force acts (m)
};

/// The contact problem of a substep, in the world frame. Its solution is an impulse for each contact point,
/// within its friction cone, such that with the velocities that all impulses together give to the bodies no
/// point closes faster than its target, points with an impulse are at their target, and friction opposes the
/// slip.
struct ContactProblem {
  struct Body {
    double inverse_mass;   ///< 1/kg; 0: not free
    Mat3 inverse_inertia;  ///< 1/(kg m^2)
    Vec3 velocity;         ///< velocity without the contacts (m/s)
    Vec3 spin;             ///< spin without the contacts (rad/s)
  };
  struct Contact {
    std::int32_t i;
    std::int32_t j;
    std::int64_t first_point;
    std::int32_t count;  ///< number of its points, which follow one another
    Vec3 normal;         ///< unit normal, from i to j
    double friction;
    bool balls;  ///< whether it is between balls, or between a ball and a body that is not free: arms of
                 ///< bodies that turn lie along the normal
  };
  struct Point {
    Vec3 arm_i;     ///< vector from the centre of i to the point (m)
    Vec3 arm_j;     ///< vector from the centre of j to the point (m)
    double target;  ///< target of the normal velocity of j relative to i (m/s)
    Vec3 impulse;   ///< impulse on j that the response has found (N s)
  };
  std::vector<Body> bodies;  ///< bodies by id, and then points of turning walls, if contacts act on these
  std::vector<Contact> contacts;
  std::vector<Point> points;
};

/// An occupied cell of the hierarchical grid.
struct OccupiedCell {
  std::int32_t level;  ///< number of the level, counted from the smallest cells
  Vec3 low;            ///< lower corner of the cell (m)
  double width;        ///< width of the cell (m)

  friend bool operator==(const OccupiedCell&, const OccupiedCell&) = default;
};

/// The hierarchical grid of the last pairs; empty for other broad phases.
struct GridOccupancy {
  std::vector<double> width;        ///< width of the cells of each level (m)
  std::vector<std::int32_t> level;  ///< level of each body; 0 for bodies in no cell: planes, and absent ones
  std::vector<OccupiedCell> cells;  ///< occupied cells, each once
};

}  // namespace scree
