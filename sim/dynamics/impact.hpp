// One impact, at its own time.
#pragma once

#include "sim/dynamics/flight_stage.hpp"

namespace scree {

/// What an impact gave to body j, and reversed to i.
struct Impact {
  std::int32_t i, j;
  Vec3 impulse;  ///< N s
  Vec3 point;    ///< m
};

/// Newton's law u+ = -e u- at all points that touch and close, at one configuration, with Coulomb friction;
/// then gives both bodies the flights that lead on from it. Adds to `ledger` what it moved. False, and
/// nothing has changed, if no point closes.
bool resolve_impact(const FlightStage& stage, std::int32_t i, std::int32_t j, const Meeting& meeting,
                    Impact& impact, Ledger& ledger);

}  // namespace scree
