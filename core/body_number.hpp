// How a body is known, apart from where in the arrays it is.
#pragma once

#include <cstddef>
#include <cstdint>

namespace scree {

/// A body's number in the scene, from 0 on: it stays the same for the whole run, while the step may move the
/// body to another place in the arrays. Scene, records and outputs know no places, and write numbers as plain
/// integers; within the step a plain integer is a place. BodyFields::place() leads from one to the other.
enum class BodyNumber : std::int32_t {};

/// In tables that are in the order of numbers.
constexpr std::size_t index_of(BodyNumber number) { return static_cast<std::size_t>(number); }

}  // namespace scree
