// The set of the volumes of one kind around all bodies, with the same interface for all kinds.
#pragma once

#include "broadphase/broad_phase.hpp"
#include "core/bodies.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace scree::bench {

class VolumeSet {
 public:
  virtual ~VolumeSet() = default;

  virtual const char* name() const = 0;
  /// Returns the number of volumes.
  virtual std::int64_t size() const = 0;
  /// Returns the size of one volume in bytes.
  virtual std::size_t bytes() const = 0;
  /// Makes all volumes from position and orientation.
  virtual void update() = 0;
  /// Returns how many of the pairs of volumes overlap.
  virtual std::int64_t count(const std::vector<Pair>& pairs) const = 0;
  /// Returns the pairs whose volumes overlap.
  virtual std::vector<Pair> overlapping(const std::vector<Pair>& pairs) const = 0;
  /// Returns a box around each volume.
  virtual std::vector<Aabb> boxes() const = 0;
  /// Returns the mean ratio of a volume to the body's own, over `sample` bodies.
  virtual double tightness(std::int64_t sample) const = 0;
};

/// Makes a set for each of AABB, sphere, OBB, capsule, rectangle-swept sphere, 8-DOP and 14-DOP around boxes,
/// and updates them. The volumes hold all points within `margin` of a body, relative to its smallest half
/// extent. The sets refer to the bodies.
std::vector<std::unique_ptr<VolumeSet>> all_volume_sets(const BodyTable& boxes, double margin);

}  // namespace scree::bench
