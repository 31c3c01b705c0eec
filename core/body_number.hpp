// The number of a body, as opposed to its place in the arrays.
#pragma once

#include <cstddef>
#include <cstdint>

namespace scree {

/// A body's number in the scene, from 0 on: it stays the same for the whole run, while the step may move the
/// body to another place in the arrays. The scene, the records and the outputs use no places, and write
/// numbers as plain integers; within the step a plain integer is a place. BodyFields::place() converts a
/// number to a place.
enum class BodyNumber : std::int32_t {};

/// Returns the index of a body in tables that are in the order of numbers.
constexpr std::size_t index_of(BodyNumber number) { return static_cast<std::size_t>(number); }

}  // namespace scree
