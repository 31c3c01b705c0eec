// A contact in the form that the direct solver uses, and the number of contact points that make a heap.
#pragma once

#include "core/array.hpp"
#include "sim/laws/contact_row.hpp"

#include <cstdint>

namespace scree {

/// A contact of two bodies, with the range of the rows of its points.
struct Contact {
  std::int32_t i = 0;
  std::int32_t j = 0;
  std::int64_t first_row = 0;
  std::int32_t count = 0;  ///< number of its rows
  bool balls = false;      ///< contact of balls (see make_ball_row()): its row needs no coupling
  Vec3 normal = Vec3::Zero();
  double friction = 0;
  double rolling_reach = 0;  ///< largest couple against rolling, per normal impulse (m)
};

/// Returns the natural residual of a contact: the change of its rows' present impulses by the natural map.
SCREE_HD inline ImpulseChange natural_residual(const Contact& contact, const ContactRow* rows,
                                               const SolverBody& i, const SolverBody& j) {
  ImpulseChange residual;
  for (int k = 0; k < contact.count; ++k) {
    const Vec3 u = rows[k].relative_velocity(i, j);
    residual.add(rows[k], natural_map(rows[k], contact.normal, contact.friction, u) - rows[k].impulse);
  }
  return residual;
}

struct ContactCounts {
  std::int64_t contacts = 0;
  std::int64_t points = 0;  ///< points of all contacts
  SCREE_HD friend ContactCounts operator+(const ContactCounts& a, const ContactCounts& b) {
    return {a.contacts + b.contacts, a.points + b.points};
  }
};

}  // namespace scree
