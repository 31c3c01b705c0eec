// The contacts of one substep, prepared for the response, and the impulses remembered for the next.
#pragma once

#include "core/array.hpp"
#include "core/bodies.hpp"
#include "narrowphase/contact.hpp"
#include "sim/dynamics/coloring.hpp"
#include "sim/dynamics/contact_row.hpp"
#include "sim/dynamics/lanes/batches.hpp"
#include "sim/dynamics/state.hpp"

#include <algorithm>
#include <cstdint>

namespace scree {

/// One manifold with its law and its rows.
struct Contact {
  std::int32_t i;
  std::int32_t j;
  std::int32_t manifold;  ///< its place in the order of the narrow phase
  std::int32_t count;     ///< rows in use
  std::int64_t first_row;
  Vec3 normal;
  double friction;
  double restitution;
  bool loaded;    ///< carried an impulse in the last substep: it does not bounce
  bool flying;    ///< known not to meet in this substep: its rows only guard what the flight leaves free
  bool balls;     ///< between balls and bodies that are not free: its row needs no coupling
  bool aligned;   ///< of balls, and what is not free does not turn: only arms along the normal matter
  int free_ends;  ///< how many of its two bodies are free
  double lead;    ///< how long after the midpoint its geometry is of (s)
  Vec3 impulse;   ///< all that its rows gave to j in this substep (N s)
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

/// Restitution and friction of a pair of materials.
struct PairLaw {
  double restitution;
  double friction;
};

/// What the response works on.
struct ContactSet {
  Coloring coloring;
  Array<std::int32_t, Host> counts;  ///< of the points of each contact, and where its rows begin
  Array<std::int64_t, Host> first_row;
  Array<Contact, Host> contacts;       ///< in the order of the colours
  Array<ContactRow, Host> rows;        ///< of one contact after the other
  Array<RowCoupling, Host> couplings;  ///< of the rows; not set for those of balls
  lanes::Batches batches;              ///< the same for the kernels
};

/// Impulses of the last substep, by pair, part and feature. Ordered by (i, j, part), as manifolds are, with
/// the place where those of each i begin.
class ImpulseMemory {
 public:
  /// Finds the last impulses of a manifold's points (N s, world frame). False if none of the pair's points on
  /// that part carried any: where one corner rests, the others do not bounce.
  bool recall(const Manifold& manifold, Vec3 impulses[Manifold::max_points]) const;
  /// Whether a part of the pair i, j carried an impulse.
  bool is_loaded(std::int32_t i, std::int32_t j, std::int32_t part) const;
  /// Takes the impulses of the rows; `bodies` is their number.
  void remember(ConstView<Manifold> manifolds, const ContactSet& set, std::int64_t bodies);

  struct Entry {
    std::int32_t j;
    std::int32_t part;
    std::int32_t count;
    std::uint32_t feature[Manifold::max_points];
    Vec3 impulse[Manifold::max_points];

    bool is_loaded() const {
      return std::any_of(impulse, impulse + count, [](const Vec3& p) { return !p.isZero(0); });
    }
  };

 private:
  /// Those of a part of a pair.
  ConstView<Entry> entries_of(std::int32_t i, std::int32_t j, std::int32_t part) const;

  Array<Entry, Host> entries_;
  Array<std::int64_t, Host> begin_;  ///< of the entries of each i; one more than bodies, empty at first
};

/// Which law holds between two bodies, and what they are.
struct ContactLaws {
  ConstView<Shape> shape;            ///< of each body
  ConstView<Mobility> mobility;      ///< of each body
  ConstView<std::int32_t> material;  ///< of each body
  ConstView<PairLaw> table;          ///< materials x materials
  std::int64_t materials = 0;

  bool is_free(std::int32_t body) const { return mobility[body] == Mobility::free; }
  bool acts_as_ball(std::int32_t body) const { return shape[body] == Shape::sphere || !is_free(body); }
  const PairLaw& between(std::int32_t i, std::int32_t j) const {
    return table[material[i] * materials + material[j]];
  }
};

/// Fills the contacts, in the order of the colours, with their laws and with the impulses remembered, scaled
/// by `scale` (ratio of the substeps' lengths) and projected on the cone at the new normal.
void prepare_contacts(ConstView<Manifold> manifolds, const ContactLaws& laws, const ImpulseMemory& memory,
                      double scale, const ResponseParameters& parameters, ContactSet& set);

}  // namespace scree
