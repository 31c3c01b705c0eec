// The shapes that a body of a file can have: their words, and their numbers in the formats of particles, as
// `scree export` writes them and a scene that takes such a file reads them.
#pragma once

#include "core/bodies.hpp"

#include <array>
#include <cstddef>

namespace scree {

/// In the order of the numbers, which begin at 1.
inline constexpr std::array shapes_of_kinds = {Shape::sphere, Shape::box, Shape::capsule, Shape::cylinder,
                                               Shape::polyhedron};

/// As files and scenes write them, in the same order.
inline constexpr std::array shape_words = {"sphere", "box", "capsule", "cylinder", "polyhedron"};
static_assert(shape_words.size() == shapes_of_kinds.size());

/// In a comment of each frame, where the format has comments.
inline constexpr const char* particle_kinds =
    "1 sphere, 2 box, 3 capsule, 4 cylinder, 5 polyhedron as the box around it";

/// Of a shape that is one of them.
constexpr int kind_of(Shape shape) {
  int kind = 1;
  while (shapes_of_kinds[static_cast<std::size_t>(kind - 1)] != shape) ++kind;
  return kind;
}
constexpr const char* word_of(Shape shape) {
  return shape_words[static_cast<std::size_t>(kind_of(shape) - 1)];
}

}  // namespace scree
