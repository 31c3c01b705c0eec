// Contacts that a scene asks libccd about. On Host alone.
#pragma once

#include "core/shape_data.hpp"
#include "narrowphase/contact.hpp"
#include "narrowphase/general_contacts.hpp"
#include "narrowphase/settings.hpp"
#include "narrowphase/stats.hpp"

#include <cstdint>
#include <mutex>

namespace scree {

/// Two boxes, or two convex particles of which one is a capsule, a cylinder or a polyhedron. Several threads
/// may ask at once.
class LibccdContacts {
 public:
  explicit LibccdContacts(const NarrowPhaseSettings& settings) : settings_(settings) {}

  /// Whether the settings ask it about anything.
  bool is_needed() const;
  /// A search for contacts begins: it is another share of the pairs that is checked.
  void start_search() { ++searches_; }

  /// Whether it decides about two shapes.
  bool decides(Shape a, Shape b) const;
  /// The contacts of a pair of such shapes with a gap of at most `margin` (m). Returns how many.
  int find(const ShapedSolid& a, const ShapedSolid& b, const PairShapes& shapes, double margin,
           Manifold* out);

  /// Whether a pair of bodies is one of those that it is asked about too, by their numbers.
  bool checks(Shape a, Shape b, std::int32_t i, std::int32_t j) const;
  /// Compares its answer about such a pair with that of the axes.
  void check(const ShapedSolid& a, const ShapedSolid& b, const PairShapes& shapes);

  /// Since the last call of this.
  NarrowPhaseStats take_stats();

 private:
  NarrowPhaseSettings settings_;
  std::uint64_t searches_ = 0;
  std::mutex mutex_;
  NarrowPhaseStats stats_;
};

}  // namespace scree
