// The sums over the bodies in a region of the scene.
#pragma once

#include "core/bodies.hpp"
#include "sim/scene/scene.hpp"

#include <cstdint>

namespace scree {

/// Sums over the free bodies whose centre lies in a region.
struct RegionContents {
  std::int64_t count = 0;
  double volume = 0;  ///< m^3
  double mass = 0;    ///< kg

  SCREE_HD friend RegionContents operator+(const RegionContents& a, const RegionContents& b) {
    return {a.count + b.count, a.volume + b.volume, a.mass + b.mass};
  }
};

template <class Space>
RegionContents contents_of(const Region& region, const Bodies<Space>& bodies);

}  // namespace scree
