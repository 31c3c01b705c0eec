// The volumes of one kind around all bodies, behind an interface that is the same for all kinds.
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
  /// How many volumes there are.
  virtual std::int64_t size() const = 0;
  /// Of one volume.
  virtual std::size_t bytes() const = 0;
  /// Makes all volumes from position and orientation.
  virtual void update() = 0;
  /// How many of the pairs overlap.
  virtual std::int64_t count(const std::vector<Pair>& pairs) const = 0;
  /// Those that do.
  virtual std::vector<Pair> overlapping(const std::vector<Pair>& pairs) const = 0;
  /// A box around each volume.
  virtual std::vector<Aabb> boxes() const = 0;
  /// Mean volume over the body's own, of `sample` bodies.
  virtual double tightness(std::int64_t sample) const = 0;
};

/// AABB, sphere, OBB, capsule, rectangle-swept sphere, 8-DOP and 14-DOP around boxes, updated. They hold what
/// is within `margin` of a body, relative to its smallest half extent. Refers to the bodies.
std::vector<std::unique_ptr<VolumeSet>> all_volume_sets(const BodyTable& boxes, double margin);

}  // namespace scree::bench
