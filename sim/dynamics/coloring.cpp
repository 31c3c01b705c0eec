#include "sim/dynamics/coloring.hpp"

#include <algorithm>
#include <bit>

namespace scree {

namespace {
constexpr int parallel_colors = 64;  // bits of the mask
}

void color_contacts(ConstView<ManifoldHeader> manifolds, ConstView<Mobility> mobility, Coloring& coloring) {
  const auto n = static_cast<std::size_t>(manifolds.size());
  coloring.used.assign(static_cast<std::size_t>(mobility.size()), 0);
  coloring.color_of.resize(n);
  std::vector<std::int64_t>& begin = coloring.color_begin;
  begin.assign(parallel_colors + 2, 0);
  int highest = -1;
  for (std::size_t m = 0; m < n; ++m) {
    const ManifoldHeader& contact = manifolds[static_cast<std::int64_t>(m)];
    // Bodies that are not free are only read, so they constrain nothing.
    const bool free_i = mobility[contact.i] == Mobility::free;
    const bool free_j = mobility[contact.j] == Mobility::free;
    std::uint64_t& used_i = coloring.used[static_cast<std::size_t>(contact.i)];
    std::uint64_t& used_j = coloring.used[static_cast<std::size_t>(contact.j)];
    const std::uint64_t taken = (free_i ? used_i : 0) | (free_j ? used_j : 0);
    const int color = std::countr_one(taken);
    if (color < parallel_colors) {
      if (free_i) used_i |= std::uint64_t{1} << color;
      if (free_j) used_j |= std::uint64_t{1} << color;
    }
    coloring.color_of[m] = static_cast<std::uint8_t>(color);
    highest = std::max(highest, color);
    ++begin[static_cast<std::size_t>(color) + 1];
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
