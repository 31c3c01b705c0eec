#include "broadphase/brick_plan.hpp"

#include <algorithm>
#include <cmath>

namespace scree {

namespace {

// Cost of what is done once for an object in a brick, for an entry of it and for a run of candidates, in box
// tests.
constexpr double object_cost = 10;
constexpr double entry_cost = 12;
constexpr double run_cost = 3;
// Standard deviations that a brick in the densest place of the sample may be fuller than others there. Where
// one is fuller all the same, the grid has to do.
constexpr double spare_deviations = 6;
// A block searches 256 entries at a time: most bricks should need no more such rounds than the usual one.
constexpr double round_entries = 256;
constexpr double usual_deviations = 1;
constexpr double most_copies = 3;
constexpr double fewest_objects = 32;  // of a brick, on average
constexpr int most_rows = 8;
constexpr double finest_stencil = 12;  // cells along a brick
constexpr double finest_row = 64;

/// What the plan uses of a sample.
struct Summary {
  double present = 0;  ///< objects, of all
  double mean = 0;     ///< of the sizes (m)
  double square = 0;   ///< of their squares (m^2)
  double largest = 0;  ///< (m)
  double lo[3];        ///< (m)
  double length[3];
  double density;  ///< objects around the usual one (1/m^3)
  double densest;  ///< at worst

  Summary(const BrickSample& sample, std::int64_t objects) {
    double seen = 0;
    for (int bin = 0; bin < BrickSample::size_bins; ++bin) {
      const double n = sample.sizes[bin];
      const double size = class_end(bin) / (1 + 0.5 / classes_per_octave);
      seen += n;
      if (n == 0) continue;
      mean += n * size;
      square += n * size * size;
    }
    mean /= seen;
    square /= seen;
    largest = std::bit_cast<float>(sample.largest);
    present = static_cast<double>(objects) * seen /
              static_cast<double>(std::min<std::int64_t>(objects, BrickSample::most));
    double volume = 1;
    for (int a = 0; a < 3; ++a) {
      lo[a] = from_ordered_bits(sample.lo[a]);
      length[a] = std::max(from_ordered_bits(sample.hi[a]) - lo[a], 1e-30);
      volume *= length[a];
    }
    double squares = 0;
    double most = 0;
    for (const std::uint32_t n : sample.places) {
      squares += static_cast<double>(n) * n;
      most = std::max(most, static_cast<double>(n));
    }
    constexpr double places = BrickSample::width * BrickSample::width * BrickSample::width;
    // What chance adds is taken off.
    density = present / volume * std::max(1.0, (squares - seen) * places / (seen * seen));
    densest = std::max(density, present / volume * (most - 3 * std::sqrt(most)) * places / seen);
  }

  /// Bricks that the usual object stands in.
  double copies(double width) const {
    double product = 1;
    for (const double l : length) product *= l > width ? 1 + mean / width : 1;
    return product;
  }
  double volume(double width) const {
    double product = 1;
    for (const double l : length) product *= std::min(l, width);
    return product;
  }
};

struct Choice {
  BrickMethod method;
  int rows;      ///< along y and z, of method rows
  double width;  ///< of a brick (m)
  double cost;   ///< of an object
};

/// Entries of an object in one brick.
double entries_of(const Summary& all, const Choice& choice) {
  if (choice.method == BrickMethod::stencil) return 1;
  const double row = choice.width / choice.rows;
  return 1 + 2 * all.mean / row + all.square / (row * row);
}

double usual_entries(BrickMethod method) { return round_entries * (method == BrickMethod::stencil ? 4 : 6); }

bool fits(const Summary& all, const Choice& choice) {
  const double entries = entries_of(all, choice);
  // `most` of what there are `of_object` of for each object.
  const auto within = [&](double density, double of_object, double deviations, double most) {
    const double mean = density * all.volume(choice.width) * all.copies(choice.width) * of_object;
    return mean + deviations * std::sqrt(mean * of_object) <= most;
  };
  if (choice.method == BrickMethod::stencil &&
      (all.largest >= choice.width ||
       std::pow(std::min(choice.width / all.largest, finest_stencil) + 1.2, 3) * 2 >
           most_cells(choice.method)))
    return false;
  return within(all.densest, 1, spare_deviations, brick_objects) &&
         within(all.densest, entries, spare_deviations, most_entries(choice.method)) &&
         within(all.density, entries, usual_deviations, usual_entries(choice.method));
}

double stencil_cell(const Summary& all, double width) {
  return std::max(all.largest, width / finest_stencil);
}

double cost_of(const Summary& all, const Choice& choice) {
  const double density = all.density * all.copies(choice.width);
  if (choice.method == BrickMethod::stencil) {
    const double tests = density * std::pow(stencil_cell(all, choice.width), 3) * 11;
    return all.copies(choice.width) * (object_cost + entry_cost + 5 * run_cost + tests);
  }
  const double entries = entries_of(all, choice);
  const double row = choice.width / choice.rows;
  const double tests = density * row * row * entries * all.mean * 1.25;
  return all.copies(choice.width) * (object_cost + entries * (entry_cost + run_cost + tests));
}

/// The widest bricks that fit, and what that costs; nothing if there are none.
std::optional<Choice> widest(const Summary& all, BrickMethod method, int rows) {
  Choice choice{method, rows, *std::max_element(all.length, all.length + 3), 0};
  while (!fits(all, choice)) {
    choice.width *= 0.98;
    if (all.copies(choice.width) > most_copies) return {};
  }
  choice.cost = cost_of(all, choice);
  return choice;
}

BrickCells stencil_cells(const BrickPlan& plan) {
  BrickCells cells{};
  for (int a = 0; a < 3; ++a) {
    const auto cell =
        static_cast<std::uint32_t>(std::max<double>(plan.reach[a], brick_points / finest_stencil));
    cells.first[a] = brick_points - plan.reach[a];
    cells.factor[a] = (a == 0 ? 2u : 1u) * 65536u / cell;
    cells.count[a] = 1;
    cells.count[a] = cells.cell_of(last_local, a) + 1;
  }
  return cells;
}

BrickCells row_cells(const Summary& all, const Choice& choice) {
  BrickCells cells{};
  for (int a = 0; a < 3; ++a) {
    const double most =
        std::min(finest_row, std::floor(most_cells(choice.method) / double(choice.rows * choice.rows)));
    cells.first[a] = brick_points;
    cells.count[a] =
        a == 0 ? static_cast<std::int32_t>(std::clamp(2 * choice.width / all.mean, 1.0, most)) : choice.rows;
    cells.factor[a] = static_cast<std::uint32_t>(cells.count[a]) << (16 - brick_bits);
  }
  return cells;
}

/// False if there are too many buckets.
bool choose_buckets(BrickPlan& plan) {
  constexpr double few = 216;
  for (plan.bucket_width = 4;; ++plan.bucket_width) {
    double total = 1;
    for (int a = 0; a < 3; ++a) {
      plan.buckets[a] = (plan.lattice.bricks[a] + plan.bucket_width - 1) / plan.bucket_width;
      total *= plan.buckets[a];
    }
    if (total <= few || plan.bucket_width == widest_bucket) return total <= most_buckets;
  }
}

}  // namespace

std::optional<BrickPlan> plan_bricks(const BrickSample& sample, std::int64_t objects) {
  if (sample.largest == 0 || objects > std::int64_t{body_mask}) return {};
  const Summary all(sample, objects);
  std::optional<Choice> best = widest(all, BrickMethod::stencil, 0);
  for (int rows = 1; rows <= most_rows; ++rows) {
    const std::optional<Choice> other = widest(all, BrickMethod::rows, rows);
    if (other && (!best || other->cost < best->cost)) best = other;
  }
  if (!best) return {};

  BrickPlan plan{};
  plan.method = best->method;
  double bricks = 1;
  for (int a = 0; a < 3; ++a) {
    const double n = std::max(1.0, std::ceil(all.length[a] / best->width));
    bricks *= n;
    if (bricks > static_cast<double>(most_bricks) || bricks > std::max(8.0, all.present / fewest_objects))
      return {};
    plan.lattice.bricks[a] = static_cast<std::int32_t>(n);
    plan.lattice.origin[a] = static_cast<float>(all.lo[a]);
    const double points_per_m = brick_points * n / all.length[a];
    plan.lattice.points_per_m[a] = static_cast<float>(std::min(points_per_m, 1e30));
    plan.reach[a] = static_cast<std::int32_t>(
        std::min(std::ceil(all.largest * points_per_m * (1 + 0x1p-10)) + 1, double{brick_points}));
  }
  plan.cells = plan.method == BrickMethod::stencil ? stencil_cells(plan) : row_cells(all, *best);
  if (plan.cells.total() > most_cells(plan.method) || !choose_buckets(plan)) return {};
  return plan;
}

}  // namespace scree
