// Contacts of balls as Host finds and totals them in double precision: eight side by side, by the kernels of
// visit_kernels.cpp. What is asked for and given here no function comes with.
#pragma once

#include "core/period.hpp"
#include "sim/contacts/layout.hpp"

#include <cstdint>

namespace scree::solver {

/// How far the contacts of a ball at the midpoint reach; those of other bodies reach everywhere.
struct alignas(32) Reach {
  double x, y, z;
  double extent;  ///< radius and margin (m)
};

/// Slots that are looked at in one call.
inline constexpr int look = 64;

/// Two balls for each contact of a block.
struct BallBlock {
  std::int32_t i[simd::width], j[simd::width];  ///< places
  alignas(64) double friction[simd::width];
  V3<double> kick[simd::width];  ///< what the substep's forces add to the velocity of j relative to i (m/s)
  V3<double> impulse[simd::width];  ///< that the last substep has left, by the ratio of their lengths (N s)
};

/// Makes contacts of balls that are whole bodies, at the midpoint.
struct PrepareBalls {
  const MidBody<double>* mid;
  BallContacts<double> contacts;
  const Period* period;  ///< null: none
  double step;           ///< s
  double noise;          ///< parting speeds that count as none (m/s)
};

/// What blocks of contacts have moved: sums of ContactTotals.
struct BlockTotals {
  double restitution = 0, friction = 0, work = 0;
  double gaps = 0;
  double deepest = 0;
  double gap_power = 0, kick_power = 0;
  std::int64_t loaded = 0, ends = 0, gaining = 0;
};

/// ContactTotals contacts of balls, and sets their gaps at the end.
struct AccountBlocks {
  BallContacts<double> contacts;
  // Of each body of the solver: before the substep's forces, with these, and with the contacts.
  const BodyRecord<double>* before;
  const BodyRecord<double>* free;
  const BodyRecord<double>* solver;
  double step;      ///< s
  double rounding;  ///< response_gain
  bool again;       ///< the gaps at the end are set already
};

}  // namespace scree::solver
