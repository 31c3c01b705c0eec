// The contacts of one substep, prepared for the response, and the impulses remembered for the next.
#pragma once

#include "core/archive.hpp"
#include "core/array.hpp"
#include "core/bodies.hpp"
#include "narrowphase/contact.hpp"
#include "sim/dynamics/ball_pairs.hpp"
#include "sim/dynamics/coloring.hpp"
#include "sim/dynamics/contact_laws.hpp"
#include "sim/dynamics/contact_row.hpp"
#include "sim/dynamics/lanes/batches.hpp"
#include "sim/dynamics/state.hpp"

#include <cstdint>

namespace scree {

/// One manifold with its law and its rows: it has the manifold's number, and its rows those of the points.
struct Contact {
  std::int32_t i;
  std::int32_t j;
  std::int64_t first_row;
  std::int32_t count;  ///< rows in use
  bool loaded;         ///< carried an impulse in the last substep: it does not bounce
  bool flying;         ///< known not to meet in this substep: its rows only guard what the flight leaves free
  bool balls;          ///< between balls and bodies that are not free: its row needs no coupling
  bool aligned;        ///< of balls, and what is not free does not turn: only arms along the normal matter
  std::int8_t free_ends;  ///< how many of its two bodies are free
  Vec3 normal;
  double friction;
  double rolling_reach;  ///< couple against rolling for each normal impulse, at most (m)
  double lead;           ///< how long after the midpoint its geometry is of (s)
  double size;           ///< the smaller smallest_size of the two (m)
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

/// What the response works on.
struct ContactSet {
  Coloring coloring;
  Array<Contact, Host> contacts;
  Array<ContactRow, Host> rows;  ///< of one contact after the other
  Array<Vec3, Host> couples;     ///< of each contact against rolling, on j (N m s); empty if nothing rolls
  lanes::Batches batches;        ///< the same for the kernels, colour by colour
  bool rolls = false;            ///< rolling friction is computed
  std::int64_t pairs = 0;        ///< contacts of BallPairs: only in the batches, until all are listed
  bool all_are_listed = false;  ///< those too, after the others, and the masses of rows, which are made there

  std::int64_t contact_count() const { return contacts.size() + (all_are_listed ? 0 : pairs); }
  std::int64_t point_count() const { return rows.size() + (all_are_listed ? 0 : pairs); }
  /// How many contacts are not of BallPairs.
  std::int64_t others() const { return contact_count() - pairs; }
  /// Lists what only the batches have, for those who look at contacts one by one.
  void list_all(ConstView<SolverBody> bodies);

  bool is_heap() const { return scree::is_heap(point_count()); }
  bool shares_loads() const { return scree::shares_loads(contact_count(), point_count()); }
  /// All that a contact's rows gave to its body j in the last substep (N s).
  Vec3 impulse_of(const Contact& contact) const {
    Vec3 impulse = Vec3::Zero();
    for (int k = 0; k < contact.count; ++k) impulse += rows.view()[contact.first_row + k].impulse;
    return impulse;
  }
};

/// Impulses of the last substep, by pair, part and feature. Ordered by (i, j, part), as manifolds are, with
/// the place where those of each i begin.
class ImpulseMemory {
 public:
  BallPairs balls;  ///< which remember their own

  /// Finds the last impulses of a manifold's points (N s, world frame). False if none of the pair's points on
  /// that part carried any: where one corner rests, the others do not bounce.
  bool recall(const ManifoldHeader& manifold, const ContactPoint* points, Vec3* impulses) const;
  /// The last couple of a manifold's pair on that part (N m s); of scenes in which bodies roll.
  Vec3 recall_couple(const ManifoldHeader& manifold) const;
  /// Takes the impulses of the rows and of the batches; `bodies` is their number.
  void remember(const Manifolds& manifolds, const ContactSet& set, std::int64_t bodies);

  void archive(Archive& archive) {
    archive.part("balls", balls);
    archive("entries", entries_);
    archive("points", points_);
    archive("couples", couples_);
    archive("begin", begin_);
  }

  /// A manifold.
  struct Entry {
    std::int32_t j;
    std::int32_t part;
    std::int32_t count;
    bool loaded;
    std::int64_t first_point;

    SCREE_HD bool is_before(std::int32_t other_j, std::int32_t other_part) const {
      return j != other_j ? j < other_j : part < other_part;
    }
  };
  struct Point {
    Vec3 impulse;
    std::uint32_t feature;
  };
  /// Where the entries are, for functors.
  struct Index {
    ConstView<Entry> entries;
    ConstView<std::int64_t> begin;
    BallPairs::Index balls;

    /// Those of a part of a pair.
    SCREE_HD ConstView<Entry> of(std::int32_t i, std::int32_t j, std::int32_t part) const {
      if (begin.size() == 0) return {};
      // A floor may have as many entries as there are bodies.
      std::int64_t first = begin[i];
      for (std::int64_t last = begin[i + 1]; first < last;) {
        const std::int64_t middle = first + (last - first) / 2;
        if (entries[middle].is_before(j, part)) {
          first = middle + 1;
        } else {
          last = middle;
        }
      }
      std::int64_t end = first;
      while (end < begin[i + 1] && entries[end].j == j && entries[end].part == part) ++end;
      return {entries.data() + first, end - first};
    }
    /// Whether a part of the pair i, j carried an impulse.
    SCREE_HD bool is_loaded(std::int32_t i, std::int32_t j, std::int32_t part) const {
      const ConstView<Entry> those = of(i, j, part);
      for (const Entry& entry : those) {
        if (entry.loaded) return true;
      }
      return those.size() == 0 && balls.is_loaded(balls.candidate_of(i, j));
    }
  };
  Index index() const { return {entries_.view(), begin_.view(), balls.index()}; }

 private:
  Array<Entry, Host> entries_;
  Array<Point, Host> points_;
  Array<Vec3, Host> couples_;        ///< of each entry; empty if nothing rolls
  Array<std::int64_t, Host> begin_;  ///< of the entries of each i; one more than bodies, empty at first
};

/// Fills the contacts of the manifolds with their laws, and the rows with the impulses remembered, scaled by
/// `scale` (ratio of the substeps' lengths) and projected on the cone at the new normal.
void prepare_contacts(const Manifolds& manifolds, const ContactLaws& laws, const ImpulseMemory& memory,
                      double scale, const ResponseParameters& parameters, ContactSet& set);

}  // namespace scree
