#include "sim/dynamics/coloring.hpp"

#include "sim/dynamics/ball_pairs.hpp"

#include <algorithm>
#include <bit>

namespace scree {

namespace {
constexpr int parallel_colors = 64;  // bits of the mask
}

void color_contacts(const BallPairs& balls, ConstView<ManifoldHeader> manifolds, ConstView<Mobility> mobility,
                    Coloring& coloring) {
  const std::size_t n = balls.touching().size() + static_cast<std::size_t>(manifolds.size());
  coloring.used.assign(static_cast<std::size_t>(mobility.size()), 0);
  coloring.color_of.resize(n);
  std::vector<std::int64_t>& begin = coloring.color_begin;
  begin.assign(parallel_colors + 2, 0);
  int highest = -1;
  std::size_t next_contact = 0;
  const auto color = [&](std::int32_t i, std::int32_t j) {
    // Bodies that are not free are only read, so they constrain nothing.
    const bool free_i = mobility[i] == Mobility::free;
    const bool free_j = mobility[j] == Mobility::free;
    std::uint64_t& used_i = coloring.used[static_cast<std::size_t>(i)];
    std::uint64_t& used_j = coloring.used[static_cast<std::size_t>(j)];
    const std::uint64_t taken = (free_i ? used_i : 0) | (free_j ? used_j : 0);
    const int first = std::countr_one(taken);
    if (first < parallel_colors) {
      if (free_i) used_i |= std::uint64_t{1} << first;
      if (free_j) used_j |= std::uint64_t{1} << first;
    }
    coloring.color_of[next_contact++] = static_cast<std::uint8_t>(first);
    highest = std::max(highest, first);
    ++begin[static_cast<std::size_t>(first) + 1];
  };
  for (const ManifoldHeader& m : manifolds) color(m.i, m.j);
  for (const std::int32_t candidate : balls.touching()) {
    const auto [i, j] = balls.pair(candidate);
    color(i, j);
  }
  begin.resize(static_cast<std::size_t>(highest) + 2);
  for (std::size_t c = 1; c < begin.size(); ++c) begin[c] += begin[c - 1];
  coloring.order.resize(n);
  std::vector<std::int64_t> next(begin.begin(), begin.end());
  for (std::size_t m = 0; m < n; ++m) {
    coloring.order[static_cast<std::size_t>(next[coloring.color_of[m]]++)] = static_cast<std::int32_t>(m);
  }
  coloring.last_is_serial = highest == parallel_colors;
}

}  // namespace scree
