// The kernel that turns eight bodies freely.
#pragma once

#include "sim/laws/simd/kernels/vectors.hpp"

namespace scree::simd::SCREE_SIMD {

namespace {

V get(const Lane& lane) { return *reinterpret_cast<const V*>(lane.at); }
void set(Lane& lane, const V& value) { *reinterpret_cast<V*>(lane.at) = value; }
V3 get(const LaneVec& lanes) { return {get(lanes.x), get(lanes.y), get(lanes.z)}; }
void set(LaneVec& lanes, const V3& value) {
  set(lanes.x, value.x);
  set(lanes.y, value.y);
  set(lanes.z, value.z);
}

void turn(RotatingBodies& bodies, double dt, bool fourth_order) {
  const V3 inverse_inertia = get(bodies.inverse_inertia);
  const V3 inertia = {1.0 / inverse_inertia.x, 1.0 / inverse_inertia.y, 1.0 / inverse_inertia.z};
  RotatingBody<Lanes> body{{get(bodies.w), get(bodies.v)}, get(bodies.spin), inertia, inverse_inertia};
  const auto start = start_of(body);
  const V turn = start.fastest * (dt < 0 ? -dt : dt);
  const auto hardly = turn < tolerance::hardly_a_turn;
  const auto splits = (turn >= tolerance::hardly_a_turn) & (turn <= tolerance::split_turn);
  bodies.far = static_cast<std::int32_t>(bits_of(turn > tolerance::split_turn));
  V drift{};
  const RotatingBody<Lanes> before = body;
  if (Lanes::any(hardly)) {
    RotatingBody<Lanes> turned = before;
    turn_little(turned, start, dt);
    choose(hardly, turned, body);
  }
  if (Lanes::any(splits)) {
    RotatingBody<Lanes> turned = before;
    const V drifted = turn_by_splitting(turned, start, dt, 1, fourth_order);
    choose(splits, turned, body);
    drift = splits ? drifted : drift;
  }
  set(bodies.w, body.orientation.w);
  set(bodies.v, body.orientation.v);
  set(bodies.spin, body.spin);
  set(bodies.drift, drift);
}

}  // namespace

}  // namespace scree::simd::SCREE_SIMD
