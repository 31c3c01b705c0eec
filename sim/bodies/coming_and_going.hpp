// Functions that find, bring in and remove bodies, in either space.
#pragma once

#include "core/bodies.hpp"
#include "sim/scene/scene.hpp"

#include <cstdint>
#include <vector>

namespace scree {

/// Makes the body at place k absent.
SCREE_HD inline void set_absent(std::int64_t k, const BodyView& bodies) {
  bodies.mobility[k] = Mobility::absent;
  bodies.inverse_mass[k] = 0;
  bodies.inverse_inertia[k] = Vec3::Zero();
}

/// Returns the numbers of the free bodies whose centre is outside of the world, in order.
template <class Space>
std::vector<BodyNumber> bodies_beyond(const World& world, const Bodies<Space>& bodies);

/// Returns the numbers of the free bodies whose centre is in a region, in order.
template <class Space>
std::vector<BodyNumber> bodies_in(const Region& region, const Bodies<Space>& bodies);

/// Returns the bodies that are present and whose bounding sphere reaches into the box from `low` to `high`
/// (m), and all planes and tubes, in the order of their numbers.
template <class Space>
BodyTable bodies_near(const Vec3& low, const Vec3& high, const Bodies<Space>& bodies);

/// Sets the state of each body whose number is in `those` to the state given there.
template <class Space>
void bring_in(const BodyTable& those, Bodies<Space>& bodies);

/// Makes the bodies with these numbers absent, and returns them as they were.
template <class Space>
BodyTable take_out(const std::vector<BodyNumber>& numbers, Bodies<Space>& bodies);

}  // namespace scree
