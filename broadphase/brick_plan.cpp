#include "broadphase/brick_plan.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <vector>

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
constexpr double finest_stencil = 9;  // cells along a brick
constexpr double finest_row = 64;
constexpr double stencil_runs = 5;
constexpr double stencil_cells_tested = 11;  // of the volume of a cell's cube, half as wide along x

/// Objects of one octave of sizes.
struct Octave {
  double share;  ///< of all objects
  double size;   ///< mean (m)
};

/// What the plan uses of a sample.
struct Summary {
  std::vector<Octave> octaves;
  double present = 0;  ///< objects, of all
  double largest = 0;  ///< (m)
  double lo[3];        ///< (m)
  double length[3];
  double density;  ///< objects around the usual one (1/m^3)
  double densest;  ///< at worst

  Summary(const BrickSample& sample, std::int64_t objects) {
    double seen = 0;
    for (const std::uint32_t n : sample.sizes) seen += n;
    for (int bin = 0; bin < BrickSample::size_bins; ++bin) {
      const double share = sample.sizes[bin] / seen;
      if (bin % classes_per_octave == 0 && (octaves.empty() || octaves.back().share > 0))
        octaves.push_back({0, 0});
      octaves.back().share += share;
      octaves.back().size += share * class_end(bin) / (1 + 0.5 / classes_per_octave);
    }
    if (octaves.back().share == 0) octaves.pop_back();
    for (Octave& octave : octaves) octave.size /= octave.share;
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

  double volume(double width) const {
    double product = 1;
    for (const double l : length) product *= std::min(l, width);
    return product;
  }
  /// Bricks in which an object of this size stands.
  double copies(double size, double width) const {
    double product = 1;
    for (const double l : length) product *= l > width ? 1 + std::min(size, l) / width : 1;
    return product;
  }
};

struct Choice {
  BrickMethod method;
  int rows;          ///< along y and z, of method rows
  double width = 0;  ///< of a brick (m)
  double cost = 0;   ///< of an object
};

/// What a brick around the usual object has to do; expected values.
struct Load {
  double objects = 0;
  double entries = 0;
  double entry_squares = 0;  ///< sum over the objects: their variance, since objects are there by chance
  double reach = 0;          ///< along x, of an entry (m)

  Load(const Summary& all, const Choice& choice, double density) {
    const double row = choice.width / choice.rows;
    for (const Octave& octave : all.octaves) {
      const double n =
          density * all.volume(choice.width) * octave.share * all.copies(octave.size, choice.width);
      const double within = std::min(octave.size, choice.width);
      const double rows = std::min(1 + within / row, static_cast<double>(choice.rows));
      const double of_object = choice.method == BrickMethod::stencil ? 1 : rows * rows;
      objects += n;
      entries += n * of_object;
      entry_squares += n * of_object * of_object;
      reach += n * of_object * within;
    }
    reach /= entries;
  }
};

double usual_entries(BrickMethod method) { return round_entries * (method == BrickMethod::stencil ? 4 : 6); }

bool fits(const Summary& all, const Choice& choice) {
  if (choice.method == BrickMethod::stencil && all.largest >= choice.width)
    return true;  // no narrower one does
  const Load worst(all, choice, all.densest);
  const Load usual(all, choice, all.density);
  return worst.objects + spare_deviations * std::sqrt(worst.objects) <= brick_objects &&
         worst.entries + spare_deviations * std::sqrt(worst.entry_squares) <= most_entries(choice.method) &&
         usual.entries + usual_deviations * std::sqrt(usual.entry_squares) <= usual_entries(choice.method);
}

double cost_of(const Summary& all, const Choice& choice) {
  const Load load(all, choice, all.density);
  double tests;  // of an entry
  double runs = 1;
  if (choice.method == BrickMethod::stencil) {
    const double cell = std::max(all.largest, choice.width / finest_stencil);
    tests = load.entries / all.volume(choice.width) * std::pow(cell, 3) * stencil_cells_tested;
    runs = stencil_runs;
  } else {
    tests = load.entries / (choice.rows * choice.rows * choice.width) * 1.25 * load.reach;
  }
  const double cost = load.objects * object_cost + load.entries * (entry_cost + runs * run_cost + tests);
  return cost / (all.density * all.volume(choice.width));
}

/// The widest bricks that fit, and what that costs; nothing if most objects would stand in too many of them.
std::optional<Choice> widest(const Summary& all, BrickMethod method, int rows) {
  constexpr int halvings = 11;
  Choice choice{method, rows};
  const double longest = *std::max_element(all.length, all.length + 3);
  double narrow = -14;  // octaves under the longest
  double wide = 0;
  for (int k = 0; k < halvings; ++k) {
    const double octave = k == 0 ? 0 : (narrow + wide) / 2;
    choice.width = longest * std::exp2(octave);
    (fits(all, choice) ? narrow : wide) = octave;
  }
  choice.width = longest * std::exp2(narrow);
  const Load load(all, choice, all.density);
  if (!fits(all, choice) || load.objects > most_copies * all.density * all.volume(choice.width)) return {};
  if (method == BrickMethod::stencil && all.largest >= choice.width) return {};
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
  const double reach = Load(all, choice, all.density).reach;
  BrickCells cells{};
  for (int a = 0; a < 3; ++a) {
    const double most =
        std::min(finest_row, std::floor(most_cells(choice.method) / double(choice.rows * choice.rows)));
    cells.first[a] = brick_points;
    cells.count[a] =
        a == 0 ? static_cast<std::int32_t>(std::clamp(4 * choice.width / reach, 1.0, most)) : choice.rows;
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
  std::optional<Choice> best = widest(all, BrickMethod::stencil, 1);
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
