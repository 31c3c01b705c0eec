// The measurement of overlaps of bodies in a space.
#pragma once

#include "broadphase/broad_phase.hpp"
#include "core/array.hpp"
#include "core/bodies.hpp"
#include "core/shape_data.hpp"
#include "sim/observe/observation.hpp"

namespace scree {

/// Whether Penetration::p99 is found, for which all depths must be sorted; if not, it is NaN.
enum class Quantiles { none, p99 };

/// Measures the overlapping pairs among the candidates, each at its deepest point, by true geometry.
/// `shapes`: shape data of each body, by its place; empty if no body's shape is general.
template <class Space>
Penetration measure_overlaps(const ConstBodyView& bodies, ConstView<ShapeData> shapes,
                             ConstView<Pair> candidates, Quantiles quantiles = Quantiles::p99);

}  // namespace scree
