// The broad phase by bricks: the fastest where objects are not too unlike in size and not too unevenly
// spread.
#pragma once

#include "broadphase/broad_phase.hpp"

#include <cstdint>
#include <memory>
#include <optional>

namespace scree {

/// On Host there is no such thing: its caches do as well for the grid.
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
  /// The PCS, and its statistics; nothing if bricks do not suit the objects.
  std::optional<ConstView<Pair>> find(ConstView<Aabb> bounds, ConstView<Mobility> mobility,
                                      BroadPhaseStats& stats);

 private:
  struct Arrays;
  std::unique_ptr<Arrays> arrays_;
};

}  // namespace scree
