// A contact as the direct solver sees it, and how many contacts make a heap.
#pragma once

#include "core/array.hpp"
#include "sim/laws/contact_row.hpp"

#include <cstdint>

namespace scree {

/// Two bodies, and the rows of their points.
struct Contact {
  std::int32_t i = 0;
  std::int32_t j = 0;
  std::int64_t first_row = 0;
  std::int32_t count = 0;  ///< rows in use
  bool balls = false;      ///< between balls and bodies that are not free: its row needs no coupling
  Vec3 normal = Vec3::Zero();
  double friction = 0;
  double rolling_reach = 0;  ///< couple against rolling for each normal impulse, at most (m)
};

/// What the natural map changes in the impulses of a contact's rows, as they are.
SCREE_HD inline ImpulseChange natural_residual(const Contact& contact, const ContactRow* rows,
                                               const SolverBody& i, const SolverBody& j) {
  ImpulseChange residual;
  for (int k = 0; k < contact.count; ++k) {
    const Vec3 u = rows[k].relative_velocity(i, j);
    residual.add(rows[k], natural_map(rows[k], contact.normal, contact.friction, u) - rows[k].impulse);
  }
  return residual;
}

/// So many points that solving them to the end in every substep is not worth what it costs: what is left is
/// for the next ones, which start from there.
SCREE_HD inline bool is_heap(std::int64_t points) {
  constexpr std::int64_t fewest = 2500;
  return points >= fewest;
}
/// Whether contacts have several points, among which the load moves slowly.
SCREE_HD inline bool shares_loads(std::int64_t contacts, std::int64_t points) { return points > contacts; }

struct ContactCounts {
  std::int64_t contacts = 0;
  std::int64_t points = 0;  ///< of theirs
  SCREE_HD friend ContactCounts operator+(const ContactCounts& a, const ContactCounts& b) {
    return {a.contacts + b.contacts, a.points + b.points};
  }
};

}  // namespace scree
