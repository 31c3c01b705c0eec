// The contacts of one substep, prepared for the response, and the impulses remembered for the next.
#pragma once

#include "core/array.hpp"
#include "core/bodies.hpp"
#include "narrowphase/contact.hpp"
#include "sim/dynamics/coloring.hpp"
#include "sim/dynamics/contact_row.hpp"
#include "sim/dynamics/state.hpp"

#include <cstdint>
#include <vector>

namespace scree {

/// One manifold with its law and its rows.
struct Contact {
  std::int32_t i;
  std::int32_t j;
  std::int32_t manifold;  ///< its place in the order of the narrow phase
  int count;              ///< rows in use
  Vec3 normal;
  double friction;
  double restitution;
  bool loaded;    ///< carried an impulse in the last substep: it does not bounce
  bool falling;   ///< on its way to an impact after this substep: its rows must not slow it down
  int free_ends;  ///< how many of its two bodies are free
  Vec3 impulse;   ///< all that it gave to j in this substep, impacts and rows (N s)
};

/// Restitution and friction of a pair of materials.
struct PairLaw {
  double restitution;
  double friction;
};

/// Impulses of the last substep, by pair, part and feature. Ordered by (i, j, part), as manifolds are.
class ImpulseMemory {
 public:
  /// Finds the last impulses of a manifold's points (N s, world frame). False if none of the pair's points on
  /// that part carried any: where one corner rests, the others do not bounce.
  bool recall(const Manifold& manifold, Vec3 impulses[Manifold::max_points]) const;
  void clear() { entries_.clear(); }

  struct Entry {
    std::int32_t i;
    std::int32_t j;
    std::int32_t part;
    int count;
    std::uint32_t feature[Manifold::max_points];
    Vec3 impulse[Manifold::max_points];
  };
  std::vector<Entry>& entries() { return entries_; }

 private:
  std::vector<Entry> entries_;
};

/// What the response works on.
struct ContactSet {
  Coloring coloring;
  Array<Contact, Host> contacts;  ///< in the order of the colours
  Array<ContactRow, Host> rows;   ///< Manifold::max_points for each contact
  Array<Vec3, Host> shift;        ///< of each body's midpoint position, by impacts of this substep (m)
};

/// Which law holds between two bodies, and which bodies move freely.
struct ContactLaws {
  ConstView<Mobility> mobility;      ///< of each body
  ConstView<std::int32_t> material;  ///< of each body
  ConstView<PairLaw> table;          ///< materials x materials
  std::int64_t materials = 0;

  const PairLaw& between(std::int32_t i, std::int32_t j) const {
    return table[material[i] * materials + material[j]];
  }
};

/// Fills the contacts, in the order of the colours, with their laws and with the impulses remembered, scaled
/// by `scale` (ratio of the substeps' lengths) and projected on the cone at the new normal.
void prepare_contacts(ConstView<Manifold> manifolds, const ContactLaws& laws, const ImpulseMemory& memory,
                      double scale, const ResponseParameters& parameters, ContactSet& set);

/// Stores the impulses of the rows, in the order of the manifolds.
void remember_impulses(ConstView<Manifold> manifolds, const ContactSet& set, ImpulseMemory& memory);

}  // namespace scree
