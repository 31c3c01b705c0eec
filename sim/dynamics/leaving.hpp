// Bodies that go.
#pragma once

#include "core/bodies.hpp"
#include "sim/scene/scene.hpp"

#include <cstdint>
#include <vector>

namespace scree {

/// Body k is not there from now on.
SCREE_HD inline void set_absent(std::int64_t k, const BodyView& bodies) {
  bodies.mobility[k] = Mobility::absent;
  bodies.inverse_mass[k] = 0;
  bodies.inverse_inertia[k] = Vec3::Zero();
}

/// The free bodies whose centre is outside of the world, in order.
template <class Space>
std::vector<std::int32_t> bodies_beyond(const World& world, const Bodies<Space>& bodies);

/// Takes out these bodies, and returns them as they were.
template <class Space>
BodyTable take_out(const std::vector<std::int32_t>& ids, Bodies<Space>& bodies);

}  // namespace scree
