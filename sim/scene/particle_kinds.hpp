// The shapes that a body of a file can have, with their words, and with their numbers in particle formats.
// `scree export` writes these numbers, and a scene that takes such a file reads them.
#pragma once

#include "core/bodies.hpp"

#include <array>
#include <cstddef>

namespace scree {

/// The shapes in the order of their numbers, which begin at 1.
inline constexpr std::array shapes_of_kinds = {Shape::sphere, Shape::box, Shape::capsule, Shape::cylinder,
                                               Shape::polyhedron};

/// The words for the shapes in files and scenes, in the same order.
inline constexpr std::array shape_words = {"sphere", "box", "capsule", "cylinder", "polyhedron"};
static_assert(shape_words.size() == shapes_of_kinds.size());

/// The explanation of the numbers that `scree export` writes into a comment of each frame, where the format
/// has comments.
inline constexpr const char* particle_kinds =
    "1 sphere, 2 box, 3 capsule, 4 cylinder, 5 polyhedron as the box around it";

/// Returns the number of a shape, which must be one of shapes_of_kinds.
constexpr int kind_of(Shape shape) {
  int kind = 1;
  while (shapes_of_kinds[static_cast<std::size_t>(kind - 1)] != shape) ++kind;
  return kind;
}
constexpr const char* word_of(Shape shape) {
  return shape_words[static_cast<std::size_t>(kind_of(shape) - 1)];
}

}  // namespace scree
