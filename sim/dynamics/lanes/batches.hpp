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

/// The contact in each lane; -1 where there is none.
struct Members {
  std::int32_t contact[width];
};

struct Batches {
  Array<BallBatch, Host> balls;
  Array<Members, Host> ball_members;
  Array<PointBatch, Host> points;
  Array<Members, Host> point_members;
  Array<PointRow, Host> rows;
  std::vector<std::int64_t> ball_begin, point_begin;  ///< of each colour; one more than colours
  bool last_is_serial = false;
  std::vector<std::array<std::int64_t, Manifold::max_points + 1>> next_lane;  ///< scratch of arrange()
};

/// Says which contact is in which lane. The batches keep their storage from call to call.
void arrange(const Coloring& coloring, ConstView<Contact> contacts, Batches& batches);
/// Fills the batches but for the impulses. `nobody`: the body that lanes without contact name.
void load(ConstView<Contact> contacts, ConstView<ContactRow> rows, ConstView<RowCoupling> couplings,
          ConstView<SolverBody> bodies, std::int32_t nobody, Batches& batches);
/// Takes the impulses of the rows; directions start anew.
void load_impulses(ConstView<Contact> contacts, ConstView<ContactRow> rows, Batches& batches);
/// Gives the rows their impulses, and what the last sweep changed of each contact.
void store_impulses(ConstView<Contact> contacts, const Batches& batches, View<ContactRow> rows,
                    View<ImpulseChange> change);

}  // namespace scree::lanes
