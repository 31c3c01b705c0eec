// Random places without overlap.
#pragma once

#include "core/bodies.hpp"
#include "sim/scene/keys.hpp"

#include <cstdint>
#include <vector>

namespace scree {

/// Distance from the point to the surface of body b (m); negative inside a sphere or plane, 0 inside a box.
double distance_to(const BodyTable& bodies, std::size_t b, const Vec3& point);

/// Gives bodies first ... first + count - 1 random positions with centres in `box`, such that the sphere
/// around each keeps clear of all others of them and of the bodies listed in `obstacles`. Returns how many
/// fitted: less than `count` if one of them found no place in a bounded number of tries. The largest are
/// placed first.
std::int64_t scatter(BodyTable& bodies, std::int64_t first, std::int64_t count, const ScatterEntry& box,
                     const std::vector<std::int32_t>& obstacles, std::uint64_t seed);

}  // namespace scree
