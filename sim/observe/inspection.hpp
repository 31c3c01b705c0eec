// What a running scene lets be seen of its workings; made when asked for.
#pragma once

#include "core/math.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace scree {

/// The bodies of a potentially colliding pair, i < j.
using BodyPair = std::array<std::int32_t, 2>;

/// The box of a body in the broad phase (m, relative to the simulation's local origin); inverted where the
/// body is in none: planes, and absent ones.
struct BodyBox {
  std::array<float, 3> lo;
  std::array<float, 3> hi;
};

/// A contact of the last substep.
struct ContactForce {
  std::int32_t i;
  std::int32_t j;
  Vec3 force;  ///< on j (N)
  Vec3 point;  ///< where it acts (m)
};

/// The contact problem of a substep: an impulse for each point, in its Coulomb cone, such that with the
/// velocities of the bodies by all of them no point closes faster than its target, those that push are at it,
/// and friction opposes the slip. World frame.
struct ContactProblem {
  struct Body {
    double inverse_mass;   ///< 1/kg; 0: not free
    Mat3 inverse_inertia;  ///< 1/(kg m^2)
    Vec3 velocity;         ///< without the contacts (m/s)
    Vec3 spin;             ///< likewise (rad/s)
  };
  struct Contact {
    std::int32_t i;
    std::int32_t j;
    std::int64_t first_point;
    std::int32_t count;  ///< of its points, which follow one another
    Vec3 normal;         ///< from i to j
    double friction;
    bool balls;  ///< between balls and bodies that are not free: arms of what turns lie along the normal
  };
  struct Point {
    Vec3 arm_i;     ///< from the centre of i (m)
    Vec3 arm_j;     ///< from the centre of j (m)
    double target;  ///< of the normal velocity of j relative to i (m/s)
    Vec3 impulse;   ///< on j, as the response has found it (N s)
  };
  std::vector<Body> bodies;  ///< by id, and then points of walls that turn, if contacts act on these
  std::vector<Contact> contacts;
  std::vector<Point> points;
};

/// An occupied cell of the hierarchical grid.
struct OccupiedCell {
  std::int32_t level;  ///< counted from the smallest cells
  Vec3 low;            ///< its lower corner (m)
  double width;        ///< m

  friend bool operator==(const OccupiedCell&, const OccupiedCell&) = default;
};

/// The hierarchical grid of the last pairs. Empty for other methods.
struct GridOccupancy {
  std::vector<double> width;        ///< of each level's cells (m)
  std::vector<std::int32_t> level;  ///< of each body; 0 for those in no cell: planes, and absent ones
  std::vector<OccupiedCell> cells;  ///< each once
};

}  // namespace scree
