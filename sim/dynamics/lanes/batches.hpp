// The contacts of a substep as batches for the kernels, colour by colour.
#pragma once

#include "core/array.hpp"
#include "narrowphase/contact.hpp"
#include "sim/dynamics/coloring.hpp"
#include "sim/dynamics/contact_row.hpp"
#include "sim/dynamics/lanes/lanes.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace scree {
struct Contact;
}

namespace scree::lanes {

/// The contact in each lane, or none, and its first row.
struct Members {
  std::int32_t contact[width];
  std::int64_t row[width];
  bool are_pairs;  ///< of BallPairs, whose contacts are made in the lanes and are no others' until they are
                   ///< listed
};

/// Batches of one kind and colour hold as many points each: kind 0 is pairs of balls, kind 1 other balls, the
/// rest are one more than their points.
inline constexpr std::size_t kinds = most_points + 2;
inline constexpr bool is_of_balls(std::size_t kind) { return kind < 2; }

/// The contacts, in their order, in parts of equal length: who has the same slabs of all colours has the same
/// bodies, but for few.
inline constexpr std::int64_t slabs = 128;

/// Where the batches of one kind and colour begin, slab by slab, and end.
using SlabBegins = std::array<std::int64_t, slabs + 1>;

struct Batches {
  Array<BallBatch, Host> balls;
  Array<BallParting, Host> partings;  ///< of the balls
  Array<Members, Host> ball_members;
  Array<PointBatch, Host> points;
  Array<Members, Host> point_members;
  Array<PointRow, Host> rows;
  Array<PointParting, Host> point_partings;               ///< of the rows
  Array<Rolling, Host> ball_rolling, point_rolling;       ///< of each batch; empty where nothing rolls
  std::vector<std::array<SlabBegins, kinds>> slab_begin;  ///< of each colour, among the balls or the points
  bool last_is_serial = false;                            ///< of the colours
  Array<std::int32_t, Host> lane_of;  ///< of each candidate of BallPairs that touches, in their order
  std::int32_t nobody = 0;            ///< the body that lanes without contact name
  std::vector<std::array<std::int64_t, kinds>> next_lane;  ///< scratch of arrange()

  void clear() {
    balls.resize(0);
    partings.resize(0);
    ball_members.resize(0);
    points.resize(0);
    point_members.resize(0);
    rows.resize(0);
    point_partings.resize(0);
    lane_of.resize(0);
    ball_rolling.resize(0);
    point_rolling.resize(0);
  }

  bool rolls() const { return ball_rolling.size() + point_rolling.size() > 0; }

  /// Calls act(i, j, impulse on j) for each contact of BallPairs with a body that is not free.
  template <class F>
  void for_each_driven_pair(F&& act) const {
    for (std::int64_t b = 0; b < balls.size(); ++b) {
      if (!ball_members.view()[b].are_pairs) continue;
      const BallBatch& batch = balls.view()[b];
      const LaneVec& p = batch.impulse.impulse;
      for (int l = 0; partings.view()[b].driven >> l != 0; ++l) {
        if ((partings.view()[b].driven >> l & 1) != 0 && batch.ends.i[l] != nobody)
          act(batch.ends.i[l], batch.ends.j[l], Vec3(p.x.at[l], p.y.at[l], p.z.at[l]));
      }
    }
  }
};

/// Says which contact is in which lane: the contacts given, and the rest that was coloured, which are those
/// of BallPairs. The batches keep their storage from call to call. `nobody`: the body that lanes without
/// contact name. `rolls`: some contacts have rolling friction.
void arrange(const Coloring& coloring, ConstView<Contact> contacts, std::int32_t nobody, bool rolls,
             Batches& batches);
/// Fills the batches, but for what BallPairs puts into its own; directions start anew. Of rows in batches of
/// points the masses are made here. `couples`: of each contact, if anything rolls. `lane_bodies`: the bodies
/// and nobody, of which only the masses count.
void load(ConstView<Contact> contacts, ConstView<ContactRow> rows, ConstView<Vec3> couples,
          ConstView<SolverBody> bodies, const Body* lane_bodies, const BallSource& balls, Batches& batches);
/// Gives the rows the masses that were made here.
void store_masses(const Batches& batches, View<ContactRow> rows);
/// Takes the impulses of the rows again; directions start anew. Couples are nobody else's to change.
void take_impulses(ConstView<ContactRow> rows, Batches& batches);
/// Of the contact in lane l of a batch, with its couple: the balls', then those of points.
void scale_impulse(Batches& batches, std::int64_t batch, int l, double scale);
/// Gives the rows their impulses, and, unless `change` is empty, what the last sweep changed of each contact.
void store_impulses(const Batches& batches, View<ContactRow> rows, View<ImpulseChange> change);
/// Gives the contacts their couples.
void store_couples(const Batches& batches, View<Vec3> couples);

}  // namespace scree::lanes
