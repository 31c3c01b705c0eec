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

/// In place of a contact, where a lane has none.
inline constexpr std::int32_t none = -1;

/// The contact in each lane, or none, and its first row.
struct Members {
  std::int32_t contact[width];
  std::int64_t row[width];
};

struct Batches {
  Array<BallBatch, Host> balls;
  Array<BallParting, Host> partings;  ///< of the balls
  Array<Members, Host> ball_members;
  Array<PointBatch, Host> points;
  Array<Members, Host> point_members;
  Array<PointRow, Host> rows;
  std::vector<std::int64_t> ball_begin, point_begin;  ///< of each colour; one more than colours
  bool last_is_serial = false;
  std::vector<std::array<std::int64_t, most_points + 1>> next_lane;  ///< scratch of arrange()
};

/// Says which contact is in which lane. The batches keep their storage from call to call.
void arrange(const Coloring& coloring, ConstView<Contact> contacts, Batches& batches);
/// Fills the batches; directions start anew. `nobody`: the body that lanes without contact name. `step`: of
/// the substep (s).
void load(ConstView<Contact> contacts, ConstView<ContactRow> rows, ConstView<RowCoupling> couplings,
          ConstView<SolverBody> bodies, std::int32_t nobody, double step, Batches& batches);
/// Takes the impulses of the rows again; directions start anew.
void take_impulses(ConstView<ContactRow> rows, Batches& batches);
/// Gives the rows their impulses, and, unless `change` is empty, what the last sweep changed of each contact.
void store_impulses(const Batches& batches, View<ContactRow> rows, View<ImpulseChange> change);

}  // namespace scree::lanes
