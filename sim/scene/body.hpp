// Functions that make the state of one body from one item of `bodies`, or from one row of a body file.
#pragma once

#include "core/bodies.hpp"
#include "core/geometry.hpp"
#include "sim/scene/body_file.hpp"
#include "sim/scene/keys.hpp"

#include <cstdint>

namespace scree {

/// Writes body `id` of the table, the k-th body of the entry: everything but its material. The position of a
/// scattered body is set later; a body that will be emitted is in the middle of the emitter's box until it
/// appears. All random draws are from the stream of (seed, id). Returns false if the mass or the inertia of a
/// free body, or the inverse of one of them, is not a positive finite number. `hull`: the hull of the body if
/// it is a polyhedron.
bool make_body(const BodyEntry& entry, std::int64_t k, std::int32_t id, std::uint64_t seed, double density,
               const Hull* hull, BodyTable& bodies);

/// Writes body `id` of the table, one triangle of the entry's mesh: everything but its material.
void make_body(const BodyEntry& entry, const PlacedTriangle& triangle, std::int32_t id, BodyTable& bodies);

/// Writes body `id` of the table from a row of the entry's file: everything but its material. If the entry
/// gives a shape with its size, each row has that shape, and its size is drawn from the stream of (seed, id).
/// If the entry says that its bodies are fixed, they have no velocity, whatever the row says, and are no
/// servos. Returns false in the same cases as the first make_body().
bool make_body(const BodyEntry& entry, const BodyRow& row, std::int32_t id, std::uint64_t seed,
               double density, const Hull* hull, BodyTable& bodies);

/// Returns the prescribed motion of one of the entry's bodies.
Motion motion_of(const MotionEntry& entry, std::int32_t body);

}  // namespace scree
