#include "broadphase/grid_plan.hpp"

#include "broadphase/bounds.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>

namespace scree {

namespace {

// The search of half of the 3x3x3 cells: the number of rows looked up, and the number of cells with
// candidates.
constexpr double own_rows = 5;
constexpr double own_cells = 13.5;
// fill_share is the share of space that the cubes around objects fill in the region where there are objects.
// It bounds the occupancy of cells from below if the domain is mostly empty: one outlier must not make the
// model believe that all others are far apart. An object counts with at most the cube of widest_neighbour
// cells: an oversize object says little about the space in which small objects lie.
constexpr double widest_neighbour = 8;
constexpr double fill_share = 0.3;
// Largest number of cells per object of its level in a dense table, and a number of cells that any level may
// have.
constexpr double dense_cells_per_object = 4;
constexpr double dense_cells_floor = 4096;
// Largest factor by which the cells of a sparse level may be wider than its objects, so that a dense table
// holds them. If the objects are all in one place after all, this costs seven times the tests, of which there
// are few (fill_share), and saves half of the rows.
constexpr double widest_sparse = 1.9;
// Number of cells per object in a hashed table, rounded up to a power of two, and the largest number of cells
// of any table.
constexpr double hashed_cells_per_object = 2;
constexpr double largest_table = 0x1p28;

/// A level that is being chosen: consecutive bins of the histogram.
struct Group {
  double count = 0;
  double volume = 0;  ///< volume of the cubes around its objects (m^3)
  float cell = 0;     ///< width of its cells: the largest extent (m)
};

class CostModel {
 public:
  CostModel(const Census& census, const GridCosts& costs) : costs_(costs) {
    for (int a = 0; a < 3; ++a)
      length_[a] = static_cast<double>(census.hi[a]) - static_cast<double>(census.lo[a]);
  }

  double cells(double cell) const {
    double product = 1;
    for (const double length : length_) product *= length / cell + 1;
    return product;
  }

  /// Returns the number of objects of a group per cell of its own width, in the region where the group has
  /// objects.
  double occupancy(const Group& group, const std::vector<Group>& all) const {
    const double cell_volume = std::pow(group.cell, 3.0);
    double filled = 0;
    for (const Group& g : all) {
      filled += std::min(g.volume, g.count * std::pow(widest_neighbour, 3.0) * cell_volume);
    }
    return group.count / std::max(1.0, std::min(cells(group.cell), filled / (fill_share * cell_volume)));
  }

  double own(const Group& g, double occupancy) const {
    return g.count * (own_rows + std::min(own_cells * occupancy, g.count) * costs_.test);
  }

  /// Returns the cost if all objects of `from` search the cells of `to`, which are wider.
  double up(const Group& from, const Group& to, double occupancy_to) const {
    const double width = static_cast<double>(from.cell) / to.cell + 2;
    return from.count *
           (width * width + std::min(width * width * width * occupancy_to, to.count) * costs_.test);
  }

  /// Returns the cost if all objects of `from` search the cells of `to`, which are narrower. A very large
  /// object tests all objects of `to` instead.
  double down(const Group& from, const Group& to, double occupancy_to) const {
    const double width = static_cast<double>(from.cell) / to.cell + 2;
    const double rows = width * width * (1 + width / brick_row);
    const double tests = std::min(width * width * width * occupancy_to, to.count);
    return from.count * std::min(rows + tests * costs_.test, to.count * costs_.test);
  }

 private:
  GridCosts costs_;
  double length_[3];
};

std::vector<double> occupancies(const CostModel& model, const std::vector<Group>& groups) {
  std::vector<double> all;
  for (const Group& group : groups) all.push_back(model.occupancy(group, groups));
  return all;
}

double total_cost(const CostModel& model, const std::vector<Group>& groups) {
  const std::vector<double> occupancy = occupancies(model, groups);
  double cost = 0;
  for (std::size_t j = 0; j < groups.size(); ++j) {
    cost += model.own(groups[j], occupancy[j]);
    for (std::size_t i = 0; i < j; ++i) {
      cost += std::min(model.up(groups[i], groups[j], occupancy[j]),
                       model.down(groups[j], groups[i], occupancy[i]));
    }
  }
  return cost;
}

/// Returns the smallest useful width of cells: a 2^24th of the typical distance from the origin. Narrower
/// cells would distinguish coordinates that floats cannot, and run out of numbers. The typical distance is
/// the geometric mean, because an outlier must not widen the cells of all others.
float narrowest_cell(const Census& census) {
  const auto mean = static_cast<std::int32_t>(census.distance_classes / census.present);
  const float distance = std::bit_cast<float>(static_cast<std::uint32_t>(mean) << 20);
  return std::max(distance * 0x1p-24f, FLT_MIN);
}

/// Returns one group per octave of sizes. Bins that differ by less than the narrowest cell share a group.
std::vector<Group> octaves(const Census& census, const SizeHistogram& sizes) {
  const float narrowest = narrowest_cell(census);
  std::vector<Group> groups;
  int octave = -1;
  for (int bin = 0; bin < SizeHistogram::bins; ++bin) {
    const double count = sizes.count[static_cast<std::size_t>(bin)];
    if (count == 0) continue;
    const bool is_last = bin == SizeHistogram::bins - 1;
    const float end = is_last ? census.largest : std::min(class_end(sizes.first_class + bin), census.largest);
    const float size = std::max(end, narrowest);
    if (size_class(size) / classes_per_octave != octave) groups.emplace_back();
    octave = size_class(size) / classes_per_octave;
    Group& group = groups.back();
    group.count += count;
    group.volume += count * std::pow(size, 3.0);
    group.cell = size;
  }
  return groups;
}

std::vector<Group> merged(const std::vector<Group>& groups, std::size_t k) {
  std::vector<Group> fewer = groups;
  fewer[k + 1].count += fewer[k].count;
  fewer[k + 1].volume += fewer[k].volume;
  fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(k));
  return fewer;
}

/// Chooses the levels. It starts with one level per octave and merges neighbours, each time the two that gain
/// most, as long as that gains anything, or until there are as many levels as are forced.
std::vector<Group> choose(const CostModel& model, std::vector<Group> groups, int forced) {
  const int limit = forced > 0 ? std::min(forced, max_grid_levels) : max_grid_levels;
  double cost = total_cost(model, groups);
  while (groups.size() > 1) {
    std::vector<Group> best;
    double best_cost = INFINITY;
    for (std::size_t k = 0; k + 1 < groups.size(); ++k) {
      std::vector<Group> candidate = merged(groups, k);
      const double candidate_cost = total_cost(model, candidate);
      if (best.empty() || candidate_cost < best_cost) {
        best_cost = candidate_cost;
        best = std::move(candidate);
      }
    }
    const bool too_many = groups.size() > static_cast<std::size_t>(limit);
    if (!too_many && (forced > 0 || best_cost >= cost)) break;
    groups = std::move(best);
    cost = best_cost;
  }
  return groups;
}

void set_cell(GridLevel& level, double cell) {
  level.cell = cell * (1 + cell_slack);
  level.inverse_cell = 1 / level.cell;
}

/// Sets the cells in use and the layout of a dense table, and returns its number of cells, which may be too
/// large.
double lay_out_dense(GridLevel& level, const Census& census) {
  double columns[3];
  for (int a = 0; a < 3; ++a) {
    level.first[a] = 0;
    level.first[a] = level.cell_of(static_cast<double>(next_below(census.lo[a])), a);
    level.last[a] = level.cell_of(static_cast<double>(next_above(census.hi[a])), a);
    columns[a] = a == 0 ? level.last[a] + 1.0 : std::floor(level.last[a] / double{brick_width}) + 1.0;
  }
  const double slots = columns[1] * columns[2];
  level.row = static_cast<std::uint32_t>(level.last[0] + 1);
  level.bricks_y = static_cast<std::uint32_t>(columns[1]);
  level.slots = static_cast<std::uint32_t>(std::min(slots, largest_table));
  return columns[0] * slots * brick_rows;
}

void lay_out(GridLevel& level, const Census& census, double objects) {
  const double most = std::min(largest_table, dense_cells_per_object * objects + dense_cells_floor);
  set_cell(level, level.largest);
  const double cells = lay_out_dense(level, census);
  level.hashed = cells > most;
  if (level.hashed && cells <= most * widest_sparse * widest_sparse * widest_sparse) {
    // Widths are tried, because the bricks at the border are not full, and their share depends on the width.
    for (double wider = std::cbrt(cells / most); level.hashed && wider <= widest_sparse; wider *= 1.02) {
      set_cell(level, wider * level.largest);
      level.hashed = lay_out_dense(level, census) > most;
    }
    if (level.hashed) {
      set_cell(level, level.largest);
      lay_out_dense(level, census);
    }
  }
  if (!level.hashed) return;
  const double bricks = hashed_cells_per_object * objects / (brick_row * brick_rows);
  level.row = brick_row;
  level.bricks_y = 0;
  level.slots = std::bit_ceil(
      static_cast<std::uint32_t>(std::min(std::ceil(bricks), largest_table / (brick_row * brick_rows))));
}

void choose_directions(GridPlan& plan, const CostModel& model, const std::vector<Group>& groups) {
  const std::vector<double> occupancy = occupancies(model, groups);
  for (std::size_t j = 0; j < groups.size(); ++j) {
    for (std::size_t i = 0; i < j; ++i) {
      if (model.up(groups[i], groups[j], occupancy[j]) <= model.down(groups[j], groups[i], occupancy[i])) {
        plan.ascents.push_back({static_cast<int>(i), static_cast<int>(j), plan.searches(plan.ascents)});
      } else {
        plan.descents.push_back({static_cast<int>(j), static_cast<int>(i), plan.searches(plan.descents)});
      }
    }
  }
}

}  // namespace

GridPlan plan_grid(const Census& census, const SizeHistogram& sizes, const GridCosts& costs, int forced) {
  GridPlan plan;
  if (census.present == 0) return plan;
  const CostModel model(census, costs);
  const std::vector<Group> groups = choose(model, octaves(census, sizes), forced);
  std::int32_t begin = 0;
  for (const Group& group : groups) {
    GridLevel level{};
    level.largest = group.cell;
    level.base = plan.cells;
    level.begin = begin;
    level.end = begin += static_cast<std::int32_t>(group.count);
    lay_out(level, census, group.count);
    plan.cells += level.cells();
    plan.levels.push_back(level);
  }
  choose_directions(plan, model, groups);
  return plan;
}

}  // namespace scree
