// What each kind of bounding volume costs the search for contacts of one family of boxes, and what it saves.
#pragma once

#include "bench/volumes/bodies.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace scree::bench {

/// One kind of volume in one family. Times are medians of interleaved rounds, CPU time of one thread (ns).
struct VolumeRow {
  const char* name;
  std::size_t bytes;    ///< of one volume
  double tightness;     ///< mean volume over the body's own
  double tests;         ///< that scree's grid makes with boxes around these volumes, per body
  double pairs;         ///< of volumes that overlap, per body
  double false_pairs;   ///< of these, those whose bodies do not overlap, per body
  double left;          ///< of the AABBs' pairs, those that this volume leaves and that are false, per body
  std::int64_t missed;  ///< pairs of bodies that overlap although their volumes do not

  double update;       ///< of one volume from position and orientation
  double random_test;  ///< of two bodies taken at random
  double near_test;    ///< of two bodies as near as those that a grid tests
  double second_test;  ///< of two bodies whose AABBs overlap
  double narrow;       ///< narrow phase, per false pair; 0 if there are under 200
  double narrow_left;  ///< likewise, of those that this volume leaves of the AABBs'
};

struct FamilyReport {
  double fraction;              ///< that the bodies' volumes fill
  double true_pairs;            ///< of bodies that overlap, per body
  double random_pairs;          ///< the same without walls, by the closed form of the excluded volume
  std::vector<VolumeRow> rows;  ///< AABB first

  /// Per body, if this volume alone makes the PCS (ns): its update, the tests of the grid, the narrow phase
  /// of what is false. What all volumes have in common is left out: sorting into cells, and pairs that touch.
  static double alone(const VolumeRow& row);
  /// The same if AABBs make the PCS, and this volume is tested for its pairs.
  double after_aabb(const VolumeRow& row) const;
};

struct ComparisonSettings {
  std::int64_t bodies;
  double overlaps_per_body;  ///< how many others each overlaps, without walls
  double margin;             ///< of the volumes, relative to the body's smallest half extent
  int rounds;
};

FamilyReport compare_volumes(BoxFamily family, const ComparisonSettings& settings);

}  // namespace scree::bench
