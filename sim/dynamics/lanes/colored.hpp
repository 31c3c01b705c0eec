// Launches work on batches colour by colour. For parallel libraries.
#pragma once

#include "core/parallel.hpp"
#include "sim/dynamics/lanes/batches.hpp"

#include <limits>

namespace scree::lanes {

/// For each colour in turn: balls(k) for its batches k of balls, then points(k) for the others.
template <class Balls, class Points>
void for_each_color(const char* label, const Batches& batches, Balls balls, Points points) {
  // Batches worth waking threads for: some 5 us.
  const std::int64_t fewest = parallel::is_alone() ? std::numeric_limits<std::int64_t>::max() : 48;
  const std::size_t colors = batches.ball_begin.size() - 1;
  for (std::size_t c = 0; c < colors; ++c) {
    const bool serial = batches.last_is_serial && c + 1 == colors;
    const auto run = [&](std::int64_t first, std::int64_t last, auto work) {
      if (serial) {
        for (std::int64_t k = first; k < last; ++k) work(k);
      } else {
        parallel::for_each<Host>(
            label, last - first, [=](std::int64_t k) { work(first + k); }, fewest);
      }
    };
    run(batches.ball_begin[c], batches.ball_begin[c + 1], balls);
    run(batches.point_begin[c], batches.point_begin[c + 1], points);
  }
}

}  // namespace scree::lanes
