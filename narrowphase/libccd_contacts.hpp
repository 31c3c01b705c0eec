// Contacts of the pairs that a scene has libccd decide, and the crosscheck with libccd. This file is for Host
// only.
#pragma once

#include "core/shape_data.hpp"
#include "narrowphase/contact.hpp"
#include "narrowphase/general_contacts.hpp"
#include "narrowphase/settings.hpp"
#include "narrowphase/stats.hpp"

#include <cstdint>
#include <mutex>

namespace scree {

/// The use of libccd for pairs of two boxes, or of two convex particles of which one is a capsule, a cylinder
/// or a polyhedron. Several threads may call it at once.
class LibccdContacts {
 public:
  explicit LibccdContacts(const NarrowPhaseSettings& settings) : settings_(settings) {}

  /// Returns whether the settings use libccd for anything.
  bool is_needed() const;
  /// Begins a search for contacts. Each search crosschecks another share of the pairs.
  void start_search() { ++searches_; }

  /// Returns whether libccd decides about two shapes.
  bool decides(Shape a, Shape b) const;
  /// Finds the contacts of a pair of such shapes with a gap of at most `margin` (m), and returns their
  /// number.
  int find(const ShapedSolid& a, const ShapedSolid& b, const PairShapes& shapes, double margin,
           Manifold* out);

  /// Returns whether the pair of the bodies with numbers i and j is chosen for the crosscheck.
  bool checks(Shape a, Shape b, std::int32_t i, std::int32_t j) const;
  /// Compares libccd's answer about such a pair with that of the axes.
  void check(const ShapedSolid& a, const ShapedSolid& b, const PairShapes& shapes);

  /// Returns the counts since the last call of this function.
  NarrowPhaseStats take_stats();

 private:
  NarrowPhaseSettings settings_;
  std::uint64_t searches_ = 0;
  std::mutex mutex_;
  NarrowPhaseStats stats_;
};

}  // namespace scree
