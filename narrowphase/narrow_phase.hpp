// The narrow phase: pairs of the PCS in, manifolds out.
#pragma once

#include "broadphase/broad_phase.hpp"
#include "core/array.hpp"
#include "core/bodies.hpp"
#include "narrowphase/contact.hpp"
#include "narrowphase/settings.hpp"
#include "narrowphase/solid.hpp"
#include "narrowphase/stats.hpp"

#include <cstdint>

namespace scree {

namespace detail {
/// Stands for a manifold while they are put in order.
struct ManifoldSlot {
  std::int32_t j;
  std::int64_t source;  ///< its place among those found; grows in the order of the pair's test
};
}  // namespace detail

/// The contacts of one pair by the closed forms and the 15 axes, with gaps of at most `margin` (m): sets
/// everything of its manifolds but i and j, and returns their number, at most max_pair_manifolds. Boundaries
/// (planes and tubes) make no contact with each other.
int find_pair_contacts(Shape shape_a, const Solid& a, Shape shape_b, const Solid& b, double margin,
                       Manifold* out);

/// Bodies that are seen later than the others: where they are before, they have never been.
class LateBodies {
 public:
  virtual ~LateBodies() = default;
  /// When a pair is to be seen (s); at most `now()` for a pair that is to be seen as it is.
  virtual double time_of(std::int32_t i, std::int32_t j) const = 0;
  virtual double now() const = 0;
  virtual Solid solid_at(std::int32_t body, double time) const = 0;
};

/// Finds the contacts of bodies on the host.
class NarrowPhase {
 public:
  explicit NarrowPhase(const NarrowPhaseSettings& settings) : settings_(settings) {}

  /// All manifolds with a gap of at most margin[i] + margin[j] (m), for the pairs given and for every
  /// plane with every body that is not fixed; ordered by (i, j, part), each pair tested once. Bodies that are
  /// not free make no contact with each other. The view is valid until the next call.
  ConstView<Manifold> find(const ConstBodyView& bodies, ConstView<Pair> pairs, ConstView<double> margin,
                           const LateBodies* late = nullptr);

  /// Of the last search.
  const NarrowPhaseStats& stats() const { return stats_; }

 private:
  void list_planes(const ConstBodyView& bodies);
  /// Fills manifolds_ with the first `count` of found_.
  void sort_by_pair(std::int64_t body_count, std::int64_t count);

  NarrowPhaseSettings settings_;
  NarrowPhaseStats stats_;
  std::uint64_t searches_ = 0;
  // Buffers that keep their capacity from step to step.
  Array<std::int32_t, Host> planes_;
  Array<Manifold, Host> found_;        ///< in the order of finding; grows to the most found so far
  Array<std::int32_t, Host> counts_;   ///< manifolds of each first body
  Array<std::int64_t, Host> offsets_;  ///< where its manifolds begin
  Array<detail::ManifoldSlot, Host> slots_;
  Array<Manifold, Host> manifolds_;
};

}  // namespace scree
