// The broad phase by bricks. It is the fastest one if objects do not differ too much in size and are not too
// unevenly distributed.
#pragma once

#include "broadphase/broad_phase.hpp"

#include <cstdint>
#include <memory>
#include <optional>

namespace scree {

/// The version for Host, where bricks are not used: caches make the grid as fast there.
template <class Space>
class Bricks {
 public:
  std::optional<ConstView<Pair>> find(ConstView<Aabb>, ConstView<Mobility>, BroadPhaseStats&) { return {}; }
};

struct Device;

template <>
class Bricks<Device> {
 public:
  Bricks();
  ~Bricks();
  /// Returns the PCS and sets its statistics; returns nothing if bricks do not suit the objects.
  std::optional<ConstView<Pair>> find(ConstView<Aabb> bounds, ConstView<Mobility> mobility,
                                      BroadPhaseStats& stats);

 private:
  struct Arrays;
  std::unique_ptr<Arrays> arrays_;
};

}  // namespace scree
