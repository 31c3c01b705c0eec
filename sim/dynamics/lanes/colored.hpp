// Launches work on batches, colour by colour or all at once.
#pragma once

#include "core/crew.hpp"
#include "core/timing.hpp"
#include "sim/dynamics/lanes/batches.hpp"

#include <algorithm>
#include <cstdint>

namespace scree::lanes {

namespace detail {

/// Batches that are not worth sharing out: some 2 us.
inline constexpr std::int64_t few = 16;

/// Of these slabs of a colour: balls(k) for each batch k of balls, then points(k, n) for the others from k
/// on, which may be visited at once: at most lanes::abreast.
template <class Balls, class Points>
void visit_slabs(const Batches& batches, std::size_t color, std::int64_t first, std::int64_t last,
                 const Balls& balls, const Points& points) {
  const bool serial = batches.last_is_serial && color + 1 == batches.slab_begin.size();
  const std::int64_t step = serial ? 1 : abreast;
  for (std::size_t kind = 0; kind < kinds; ++kind) {
    const SlabBegins& begin = batches.slab_begin[color][kind];
    std::int64_t k = begin[static_cast<std::size_t>(first)];
    const std::int64_t end = begin[static_cast<std::size_t>(last)];
    if (is_of_balls(kind)) {
      for (; k < end; ++k) balls(k);
    } else {
      for (; k < end; k += step) points(k, static_cast<int>(std::min(step, end - k)));
    }
  }
}

inline std::int64_t batches_of(const Batches& batches, std::size_t color) {
  std::int64_t count = 0;
  for (const SlabBegins& begin : batches.slab_begin[color]) count += begin[slabs] - begin[0];
  return count;
}

}  // namespace detail

/// For each colour in turn: balls(k) and points(k, n), as above.
template <class Balls, class Points>
void for_each_color(const char* label, const Batches& batches, const Balls& balls, const Points& points) {
  const scree::timing::Call<Host> call(label);
  const std::size_t colors = batches.slab_begin.size();
  // What is few, or shares bodies, is one thread's.
  const auto shares = [&](int phase) {
    const auto color = static_cast<std::size_t>(phase);
    const bool serial = batches.last_is_serial && color + 1 == colors;
    return serial || detail::batches_of(batches, color) < detail::few ? 1 : slabs;
  };
  const auto visit = [&](int phase, std::int64_t first, std::int64_t last) {
    const std::int64_t end = shares(phase) == 1 ? slabs : last;
    detail::visit_slabs(batches, static_cast<std::size_t>(phase), first, end, balls, points);
  };
  if (batches.balls.size() + batches.points.size() < detail::few) {
    for (std::size_t c = 0; c < colors; ++c) detail::visit_slabs(batches, c, 0, slabs, balls, points);
  } else {
    scree::detail::Crew::get().share_phases(static_cast<int>(colors), shares, visit);
  }
}

/// For all batches at once: balls(k), and points(k) for the others, by threads that have them in
/// for_each_color(), too.
template <class Balls, class Points>
void for_each_batch(const char* label, const Batches& batches, const Balls& balls, const Points& points) {
  const scree::timing::Call<Host> call(label);
  const auto visit = [&](std::int64_t first, std::int64_t last) {
    for (std::size_t c = 0; c < batches.slab_begin.size(); ++c)
      detail::visit_slabs(batches, c, first, last, balls, [&](std::int64_t k, int count) {
        for (std::int64_t end = k + count; k < end; ++k) points(k);
      });
  };
  if (batches.balls.size() + batches.points.size() < detail::few) {
    visit(0, slabs);
  } else {
    scree::detail::Crew::get().share(slabs, visit);
  }
}

}  // namespace scree::lanes
