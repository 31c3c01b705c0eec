// The penetration of bodies in a space.
#pragma once

#include "broadphase/broad_phase.hpp"
#include "core/array.hpp"
#include "core/bodies.hpp"
#include "sim/observation.hpp"

namespace scree::resident {

/// Over all overlapping pairs among the candidates: of each its deepest point, true geometry.
template <class Space>
Penetration measure_overlaps(const ConstBodyView& bodies, ConstView<Pair> candidates);

}  // namespace scree::resident
