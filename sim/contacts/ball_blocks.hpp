// Arguments and results of the kernels of visit_kernels.cpp that find contacts of balls and account for them
// on Host in double precision, eight side by side. These types are plain data without functions, since the
// kernels share no functions with other sources (sim/laws/simd/kernels.cpp).
#pragma once

#include "core/period.hpp"
#include "sim/contacts/layout.hpp"

#include <cstdint>

namespace scree::solver {

/// The centre of a body at the midpoint and how far from it the contacts of the body can be (m). Only balls
/// have a finite reach.
struct alignas(32) Reach {
  double x, y, z;
  double extent;  ///< radius plus margin; infinite if no ball, or with a late impact
};

/// Number of slots that one call of ContactKernels::near() tests.
inline constexpr int look = 64;

/// The bodies of the contacts of one block, two balls for each contact, and what is known of the contacts.
struct BallBlock {
  std::int32_t i[simd::width], j[simd::width];  ///< places of the bodies
  alignas(64) double friction[simd::width];
  V3<double> kick[simd::width];  ///< change of the velocity of j relative to i by the substep's forces (m/s)
  V3<double> impulse[simd::width];  ///< remembered impulse, times the ratio of the substeps' lengths (N s)
};

/// The arguments of ContactKernels::prepare_balls(), which makes contacts at the midpoint of balls that are
/// whole bodies and not parts of hubs.
struct PrepareBalls {
  const MidBody<double>* mid;
  BallContacts<double> contacts;
  const Period* period;  ///< null if the scene has no period
  double step;           ///< s
  double noise;          ///< largest separating speed that counts as none (m/s)
};

/// Sums of ContactTotals over blocks of contacts.
struct BlockTotals {
  double restitution = 0, friction = 0, work = 0;
  double gaps = 0;
  double deepest = 0;
  double residual_power = 0, impulse_power = 0;
  std::int64_t loaded = 0, ends = 0, gaining = 0;
};

/// The arguments of ContactKernels::account_balls(), which adds up the totals of contacts of balls and sets
/// their gaps at the end of the substep.
struct AccountBlocks {
  BallContacts<double> contacts;
  // Records of the bodies of the solver: before the substep's forces, with these forces, and with forces and
  // contacts.
  const BodyRecord<double>* before;
  const BodyRecord<double>* free;
  const BodyRecord<double>* solver;
  double step;      ///< s
  double rounding;  ///< share of a gain that is rounding: response_gain
  bool again;       ///< whether the gaps at the end have been set already
};

}  // namespace scree::solver
