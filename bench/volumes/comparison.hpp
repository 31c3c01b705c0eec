// The costs and savings of each kind of bounding volume in the search for contacts, for one family of boxes.
#pragma once

#include "bench/volumes/bodies.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace scree::bench {

/// The results of one kind of volume in one family. Times are medians of interleaved rounds, in CPU time of
/// one thread (ns).
struct VolumeRow {
  const char* name;
  std::size_t bytes;    ///< size of one volume
  double tightness;     ///< mean ratio of a volume to the body's own
  double tests;         ///< tests that scree's grid makes with boxes around these volumes, per body
  double pairs;         ///< pairs of volumes that overlap, per body
  double false_pairs;   ///< pairs of volumes that overlap although their bodies do not, per body
  double left;          ///< false pairs that this volume leaves of the AABBs' pairs, per body
  std::int64_t missed;  ///< pairs of bodies that overlap although their volumes do not

  double update;       ///< update of one volume from position and orientation
  double random_test;  ///< test of two random bodies
  double near_test;    ///< test of two bodies as near as those that a grid tests
  double second_test;  ///< test of two bodies whose AABBs overlap
  double narrow;       ///< narrow phase, per false pair; 0 if there are under 200
  double narrow_left;  ///< narrow phase, per false pair that this volume leaves of the AABBs' pairs; 0 if
                       ///< under 200
};

struct FamilyReport {
  double fraction;      ///< share of the cube that the bodies' volumes add up to
  double true_pairs;    ///< pairs of bodies that overlap, per body
  double random_pairs;  ///< expected true pairs without walls, by the closed form of the excluded volume
  std::vector<VolumeRow> rows;  ///< rows of the volumes, AABB first

  /// Returns the time per body if this volume alone makes the PCS (ns): its update, the tests of the grid,
  /// and the narrow phase of false pairs. Costs common to all volumes are left out: sorting into cells, and
  /// pairs that touch.
  static double alone(const VolumeRow& row);
  /// Returns the time per body if AABBs make the PCS, and this volume is tested for its pairs (ns).
  double after_aabb(const VolumeRow& row) const;
};

struct ComparisonSettings {
  std::int64_t bodies;
  double overlaps_per_body;  ///< how many others each body overlaps, without walls
  double margin;             ///< margin of the volumes, relative to the body's smallest half extent
  int rounds;
};

FamilyReport compare_volumes(BoxFamily family, const ComparisonSettings& settings);

}  // namespace scree::bench
