// Contacts in lanes: eight of one colour side by side, so that one instruction works on all of them. Layouts,
// and the kernels that work on them.
#pragma once

#include "core/period.hpp"
#include "sim/dynamics/lanes/laws.hpp"

#include <cstdint>
#include <vector>

namespace scree::lanes {

/// In place of a contact or of a candidate, where a lane has none.
inline constexpr std::int32_t none = -1;

inline constexpr int most_points = 4;  ///< of a contact

/// A number of each contact.
struct alignas(64) Lane {
  double at[width];
};
struct LaneVec {
  Lane x, y, z;
};

/// A body: its velocities, or in the position correction its displacement and turn. One cache line.
struct alignas(64) Body {
  Vec3 velocity;
  double inverse_mass;  ///< 0: not free, and never written
  Vec3 spin;
  double inverse_inertia;  ///< of a ball
};

/// How far a ball's contacts reach, or a plane's.
struct alignas(32) Reach {
  Vec3 position;
  double extent;  ///< radius and margin; of a plane, the margin (m)
};

/// A ball at the midpoint before gravity's kick, or a plane that does not turn. One cache line.
struct alignas(64) Ball {
  Vec3 position;
  double radius;  ///< 0: of a plane
  Vec3 velocity;
  double inverse_mass;  ///< 0: not free
};

/// Two bodies that may touch.
struct Two {
  std::int32_t i, j;
};

/// Three numbers that no function comes with.
struct Triple {
  double x, y, z;
};

/// The two bodies of each contact. A lane without contact names a body of its own that is not free.
struct Ends {
  std::int32_t i[width], j[width];
};

struct LaneImpulse {
  LaneVec impulse;  ///< of ContactRow
  LaneVec last;     ///< before the last sweep (N s)
};

/// Eight contacts of balls with balls or with bodies that are not free and do not turn: of the lever arms
/// only what is along the normal matters (Contact::aligned).
struct BallBatch {
  Ends ends;
  LaneVec normal;
  Lane arm_i, arm_j;  ///< along the normal (m)
  Lane friction, target, normal_mass, tangent_mass;
  LaneImpulse impulse;
};

/// Eight contacts of any bodies, with the same number of points.
struct PointBatch {
  Ends ends;
  LaneVec normal;
  Lane cap;  ///< most that one visit of the position correction parts (m)
  Lane friction;
  Lane inertia_i[6], inertia_j[6];  ///< inverse, world frame: xx, yy, zz, xy, xz, yz
  std::int64_t first_row;
  std::int32_t count;  ///< of points
  std::int32_t apart;  ///< as of BallParting
};

/// One point of each contact of a PointBatch.
struct PointRow {
  LaneVec arm_i, arm_j;
  Lane stick[6];     ///< of RowCoupling, as the inertia
  LaneVec coupling;  ///< RowCoupling::normal
  Lane target, normal_mass, tangent_mass;
  LaneImpulse impulse;
};

/// Rolling friction of the contacts of a batch of either kind.
struct Rolling {
  Lane reach;          ///< couple for each normal impulse, at most (m)
  LaneImpulse couple;  ///< on j, and reversed on i, across the normal (N m s)
};

/// What the position correction knows of a BallBatch, side by side: it is gone over again and again.
struct BallParting {
  Ends ends;
  LaneVec normal;
  Lane normal_mass;
  Lane gap;                                   ///< at the midpoint (m)
  Lane bend;                                  ///< of ContactRow
  Lane flown;                                 ///< gap at the end of the substep without displacements (m)
  Lane pushed;                                ///< impulse so far (kg m)
  Lane cap;                                   ///< most that one visit parts (m)
  std::uint8_t loaded[width], flying[width];  ///< of Contact
  // A bit for each lane:
  std::int32_t apart;   ///< its gap at the end is not told by the flight from the midpoint
  std::int32_t driven;  ///< one of the two bodies is not free
};

/// And of one point of each contact of a PointBatch. Turns of bodies are in coordinates in which their
/// inverse inertia is 1: those that L of Root turns into the world's.
struct PointParting {
  LaneVec turn_i, turn_j;  ///< of the bodies by a push along the normal, away from it and along it
  Lane normal_mass;
  Lane gap;     ///< at the midpoint; then, flown, that at the end of the substep without displacements (m)
  Lane pushed;  ///< as of BallParting
};

/// Transpose of Cholesky's factor of a body's inverse inertia in the world frame; 0: it does not turn. One
/// cache line.
struct alignas(64) InertiaRoot {
  double xx, xy, yy, xz, yz, zz;
};

/// Of a batch: ImpulseChange.
struct Change {
  double step, size;
  SCREE_HD friend Change operator+(const Change& a, const Change& b) {
    return {a.step + b.step, a.size + b.size};
  }
};

/// Of a batch: what its impulses move (J), of Ledger.
struct Books {
  double restitution = 0, friction = 0, work = 0;
  SCREE_HD friend Books operator+(const Books& a, const Books& b) {
    return {a.restitution + b.restitution, a.friction + b.friction, a.work + b.work};
  }
};

/// What the impulses of each contact of a batch dissipate (J), and all together.
struct alignas(64) Losses {
  Lane of;
  Books books;
};

/// Eight bodies that turn freely, as Top has them.
struct Tops {
  Lane w;
  LaneVec v, spin, inverse_inertia;
  Lane drift;        ///< of the rotational energy (J)
  std::int32_t far;  ///< a bit for each that would turn further than one step of the splitting may
};

/// What contacts of balls are made of.
struct BallSource {
  // Of each body, and of nobody:
  const Ball* balls;
  const double* inverse_inertia;
  const Triple* up;      ///< normals of planes
  const Triple* kick;    ///< what the substep's forces add to the velocity (m/s)
  bool forces;           ///< whether it differs between free bodies
  double step;           ///< s
  double noise;          ///< parting speeds that count as none (m/s)
  const Period* period;  ///< null: none
};
/// Batches of points that a kernel may visit at once, if they are of one colour: what one visit waits for,
/// the other does not.
inline constexpr int abreast = 2;

/// One visit. Going on by beta of what the last sweep has changed, which the bodies have done already, waits
/// for it. The local law is that of coulomb_update() and natural_map(). `rows` are those of all batches.
struct SweepKernels {
  Change (*balls)(BallBatch&, Body* bodies, double beta);
  void (*points)(const PointBatch* batches, int count, PointRow* rows, Body* bodies, double beta,
                 int block_sweeps, Change* change);
};

/// Candidates that touch() looks at in one call.
inline constexpr int look = 64;

/// Each works on one batch; batches of one colour may be worked on at once.
struct Kernels {
  SweepKernels rough;   ///< any friction
  SweepKernels smooth;  ///< no friction in any contact: the same bits where balls do not spin
  /// A bit for each of `look` pairs that come as close as they reach; of balls, in a period if there is one.
  std::uint64_t (*touch_balls)(const Reach*, const Two* pairs, const Period*);
  std::uint64_t (*touch_planes)(const Reach*, const Triple* up, const Two* pairs);
  /// Prepares contacts that know their bodies, friction, and the impulses that they start from.
  void (*prepare_balls)(const BallSource&, BallBatch&, BallParting&);
  /// Of the couples of contacts that a visit has just given their impulses.
  Change (*roll_balls)(const BallBatch&, Rolling&, Body* bodies, double beta);
  Change (*roll_points)(const PointBatch&, const PointRow* rows, Rolling&, Body* bodies, double beta);
  /// Sets the masses of points that know their arms, their bodies' inertia, and their bodies.
  void (*prepare_points)(const PointBatch&, PointRow* rows, PointParting* points, const Body* bodies);
  /// `mean`: velocities halfway between those before and after the substep.
  void (*book_balls)(const BallBatch&, const Body* mean, Losses&);
  void (*book_points)(const PointBatch&, const PointRow* rows, const Body* mean, Losses&);
  /// Of each contact, Moved::square. `kicked`: velocities without impulses.
  void (*square_of_balls)(const BallBatch&, const Body* kicked, const Body* after, Lane&);
  void (*square_of_points)(const PointBatch&, const PointRow* rows, const Body* kicked, const Body* after,
                           Lane&);
  /// The same of couples, added to what the contacts have.
  void (*book_rolling)(const Ends&, const Rolling&, const Body* mean, Losses&);
  void (*square_of_rolling)(const Ends&, const Rolling&, const Body* kicked, const Body* after, Lane&);
  /// Flies the gaps on to the end of the substep, half a step after the midpoint. Returns the deepest overlap
  /// (m).
  double (*fly_balls)(const BallBatch&, BallParting&, const Body* velocities, double step);
  /// Of points that are not apart (the gaps of the others are infinite then); and prepares all to be parted.
  double (*fly_points)(const PointBatch&, const PointRow* rows, PointParting* points, const Body* velocities,
                       const InertiaRoot* roots, double step);
  /// Turns for a time (s) those that do not turn far.
  void (*turn)(Tops&, double dt, bool fourth_order);
  /// Goes on by beta of what has changed since the last time.
  void (*accelerate)(Body* bodies, Body* last, std::int64_t count, double beta);
  /// Gives the bodies what the impulses are.
  void (*push_balls)(const BallBatch&, Body* bodies);
  void (*push_points)(const PointBatch&, const PointRow* rows, Body* bodies);
  void (*push_rolling_balls)(const BallBatch&, const Rolling&, Body* bodies);
  void (*push_rolling_points)(const PointBatch&, const Rolling&, Body* bodies);
  /// Parts what overlaps: by a share of the overlap, but at most by the cap (m). Returns the deepest overlap
  /// met, in units of the cap.
  double (*part_balls)(BallParting&, double share, Body* bodies);
  void (*part_points)(const PointBatch* batches, int count, PointParting* points, double share, Body* bodies,
                      double* deepest);
};

/// Those that this processor can run, the widest last. All give the same bits.
struct NamedKernels {
  const char* name;
  const Kernels* kernels;
};
std::vector<NamedKernels> supported_kernels();

/// The widest of them.
const Kernels& kernels();

// One for each way in which kernels.cpp is compiled; not all exist on every processor.
namespace baseline {
extern const Kernels kernels;
}
namespace avx2 {
extern const Kernels kernels;
}
namespace avx512 {
extern const Kernels kernels;
}

}  // namespace scree::lanes
