// Launches work on contacts colour by colour. For parallel libraries.
#pragma once

#include "core/parallel.hpp"
#include "sim/dynamics/coloring.hpp"

namespace scree {

/// For each colour in turn: make(first) gives a functor that takes the contact first + k as its item k.
template <class MakeFunctor>
void for_each_color(const char* label, const Coloring& coloring, MakeFunctor make) {
  for (std::int64_t c = 0; c < coloring.colors(); ++c) {
    const std::int64_t first = coloring.color_begin[static_cast<std::size_t>(c)];
    const std::int64_t n = coloring.color_begin[static_cast<std::size_t>(c) + 1] - first;
    const auto functor = make(first);
    const bool serial = coloring.last_is_serial && c + 1 == coloring.colors();
    if (serial) {
      for (std::int64_t k = 0; k < n; ++k) functor(k);
    } else {
      parallel::for_each<Host>(label, n, functor);
    }
  }
}

}  // namespace scree
