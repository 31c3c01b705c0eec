// Launches work on batches colour by colour. For parallel libraries.
#pragma once

#include "core/parallel.hpp"
#include "sim/dynamics/lanes/batches.hpp"

#include <algorithm>
#include <limits>

namespace scree::lanes {

/// For each colour in turn: balls(k) for its batches k of balls, then points(k, n) for the others from k on,
/// which may be visited at once: at most lanes::abreast.
template <class Balls, class Points>
void for_each_color(const char* label, const Batches& batches, Balls balls, Points points) {
  // Batches worth waking threads for: some 5 us.
  const std::int64_t fewest = parallel::is_alone() ? std::numeric_limits<std::int64_t>::max() : 48;
  const std::size_t colors = batches.ball_begin.size() - 1;
  for (std::size_t c = 0; c < colors; ++c) {
    const bool serial = batches.last_is_serial && c + 1 == colors;
    const std::int64_t step = serial ? 1 : abreast;
    const auto run = [&](std::int64_t visits, auto visit) {
      if (serial) {
        for (std::int64_t k = 0; k < visits; ++k) visit(k);
      } else {
        parallel::for_each<Host>(label, visits, visit, fewest);
      }
    };
    const std::int64_t first_ball = batches.ball_begin[c];
    run(batches.ball_begin[c + 1] - first_ball, [=](std::int64_t k) { balls(first_ball + k); });
    const std::int64_t first = batches.point_begin[c], last = batches.point_begin[c + 1];
    run((last - first + step - 1) / step, [=](std::int64_t visit) {
      const std::int64_t k = first + visit * step;
      points(k, static_cast<int>(std::min(step, last - k)));
    });
  }
}

}  // namespace scree::lanes
