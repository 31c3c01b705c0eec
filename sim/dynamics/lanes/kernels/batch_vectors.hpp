// Batches as vectors of the instruction set, and what gathers them from bodies side by side in memory. A part
// of kernels.cpp, as its neighbours: none of them stands alone.
#pragma once

#include "sim/dynamics/lanes/kernels/vectors.hpp"

namespace scree::lanes::SCREE_LANES {

namespace {

using Bodies = lanes::Moving<Lanes>;  // one of each contact
using Centres = lanes::Centre<Lanes>;
using Symmetric = lanes::Symmetric<Lanes>;
using Balls = lanes::Balls<Lanes>;
using Point = lanes::Point<Lanes>;
using PointLaw = lanes::PointLaw<Lanes>;

V all(double value) { return value - V{}; }

V get(const Lane& lane) { return *reinterpret_cast<const V*>(lane.at); }
void set(Lane& lane, const V& value) { *reinterpret_cast<V*>(lane.at) = value; }
V3 get(const LaneVec& lanes) { return {get(lanes.x), get(lanes.y), get(lanes.z)}; }
void set(LaneVec& lanes, const V3& value) {
  set(lanes.x, value.x);
  set(lanes.y, value.y);
  set(lanes.z, value.z);
}

Symmetric get(const Lane (&m)[6]) {
  return {get(m[0]), get(m[1]), get(m[2]), get(m[3]), get(m[4]), get(m[5])};
}
void set(Lane (&m)[6], const Symmetric& value) {
  set(m[0], value.xx);
  set(m[1], value.yy);
  set(m[2], value.zz);
  set(m[3], value.xy);
  set(m[4], value.xz);
  set(m[5], value.yz);
}
Balls get(const BallBatch& batch) {
  return {get(batch.normal), get(batch.arm_i),       get(batch.arm_j),       get(batch.friction),
          get(batch.target), get(batch.normal_mass), get(batch.tangent_mass)};
}
Point point_of(const PointRow& row) { return {get(row.arm_i), get(row.arm_j)}; }
PointLaw law_of(const PointRow& row) {
  return {get(row.stick), get(row.coupling), get(row.target), get(row.normal_mass), get(row.tangent_mass)};
}

static_assert(sizeof(Body) == sizeof(V) && offsetof(Body, inverse_mass) == 24 && offsetof(Body, spin) == 32);
static_assert(sizeof(Bodies) == width * sizeof(V));
V& whole(Body& body) { return reinterpret_cast<V&>(body); }
const V& whole(const Body& body) { return reinterpret_cast<const V&>(body); }

[[gnu::always_inline]] inline Bodies load(const Body* bodies, const std::int32_t* at) {
  V rows[width];
  for (int l = 0; l < width; ++l) rows[l] = whole(bodies[at[l]]);
  transpose<width>(rows);
  return {{rows[0], rows[1], rows[2]}, rows[3], {rows[4], rows[5], rows[6]}, rows[7]};
}

[[gnu::always_inline]] inline void store(const Bodies& from, Body* bodies, const std::int32_t* at) {
  V rows[width] = {from.velocity.x, from.velocity.y, from.velocity.z, from.inverse_mass,
                   from.spin.x,     from.spin.y,     from.spin.z,     from.inverse_inertia};
  transpose<width>(rows);
  for (int l = 0; l < width; ++l) {
    if (bodies[at[l]].inverse_mass > 0) whole(bodies[at[l]]) = rows[l];
  }
}

/// Of a body what does not turn is half.
Half& linear_half(Body& body) { return reinterpret_cast<Half&>(body); }
const Half& linear_half(const Body& body) { return reinterpret_cast<const Half&>(body); }

[[gnu::always_inline]] inline Centres load_centres(const Body* bodies, const std::int32_t* at) {
  V rows[half];
  for (int l = 0; l < half; ++l) {
    rows[l] = __builtin_shufflevector(linear_half(bodies[at[l]]), linear_half(bodies[at[l + half]]), 0, 1, 2,
                                      3, 4, 5, 6, 7);
  }
  transpose<half>(rows);
  return {{rows[0], rows[1], rows[2]}, rows[3]};
}

[[gnu::always_inline]] inline void store(const Centres& from, Body* bodies, const std::int32_t* at) {
  V rows[half] = {from.velocity.x, from.velocity.y, from.velocity.z, from.inverse_mass};
  transpose<half>(rows);
  for (int l = 0; l < half; ++l) {
    Body& low = bodies[at[l]];
    Body& high = bodies[at[l + half]];
    if (low.inverse_mass > 0) linear_half(low) = __builtin_shufflevector(rows[l], rows[l], 0, 1, 2, 3);
    if (high.inverse_mass > 0) linear_half(high) = __builtin_shufflevector(rows[l], rows[l], 4, 5, 6, 7);
  }
}

/// Halves of eight lines side by side: two rows of four numbers become four lanes of eight.
[[gnu::always_inline]] inline void interleave(const Half* low, V* rows) {
  for (int l = 0; l < half; ++l)
    rows[l] = __builtin_shufflevector(low[l], low[l + half], 0, 1, 2, 3, 4, 5, 6, 7);
  transpose<half>(rows);
}

std::uint64_t bits_of(const decltype(V{} > V{}) & lanes) {
  std::uint64_t bits = 0;
  for (int l = 0; l < width; ++l) bits |= static_cast<std::uint64_t>(lanes[l] & 1) << l;
  return bits;
}

/// A lane that is 1 where a byte is.
V spread(const std::uint8_t* bytes) {
  V lanes{};
  for (int l = 0; l < width; ++l) lanes[l] = bytes[l];
  return lanes;
}

static_assert(sizeof(InertiaRoot) == sizeof(V) && offsetof(InertiaRoot, zz) == 40);
[[gnu::always_inline]] inline lanes::Root<Lanes> load(const InertiaRoot* roots, const std::int32_t* at) {
  V rows[width];
  for (int l = 0; l < width; ++l) rows[l] = *reinterpret_cast<const V*>(roots + at[l]);
  transpose<width>(rows);
  return {rows[0], rows[1], rows[2], rows[3], rows[4], rows[5]};
}

}  // namespace

}  // namespace scree::lanes::SCREE_LANES
