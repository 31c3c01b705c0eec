#include "broadphase/brick_plan.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <vector>

namespace scree {

namespace {

// Costs, in units of one box test that is distributed over the lanes: the work done once for an object in a
// brick, for an entry of it, and for a run of candidates; and a test against an object that is too wide for
// the stencil.
constexpr double object_cost = 10;
constexpr double entry_cost = 12;
constexpr double run_cost = 3;
constexpr double wide_test_cost = 0.5;
// Number of standard deviations by which a brick in the densest place of the sample may be fuller than others
// there. If a brick is fuller still, the grid is used instead.
constexpr double spare_deviations = 6;
// A block searches 256 entries in one round. Most bricks should need no more rounds than the usual brick.
constexpr double round_entries = 256;
constexpr double usual_deviations = 1;
constexpr double most_copies = 3;
constexpr double fewest_objects = 32;  // objects of a brick, on average, unless the bricks are few
constexpr double few_bricks = 8;
constexpr std::int32_t narrowest_bucket = 2;
constexpr int most_rows = 8;
constexpr double finest_stencil = 9;  // cells along a brick
constexpr double finest_row = 64;
constexpr double stencil_runs = 5;
constexpr std::uint32_t stencil_fineness = 3;            // number of cells along x per cell along y
constexpr double stencil_cells_tested[3] = {2.2, 3, 3};  // along each axis, in widths of a cell along y
constexpr double most_wide = 0.05;    // share of the objects that may be too wide for the stencil
constexpr double cells_to_reach = 4;  // cells of a row per usual length of an object in it
// By rounding, an object's length in lattice numbers may be larger than its length in metres implies.
constexpr double reach_slack = 0x1p-10;
constexpr double edge_slack = 1e-9;        // tolerance of a product of edges, for rounding
constexpr double shortest_length = 1e-30;  // m
constexpr double most_points_per_m = 1e30;

/// The objects of one octave of sizes.
struct Octave {
  double share;    ///< share of all objects
  double size;     ///< mean extent (m)
  double largest;  ///< end of the highest size class in use (m)
};

/// The properties of a sample that the plan uses.
struct Summary {
  std::vector<Octave> octaves;
  double present = 0;  ///< estimated number of objects that are not absent
  double largest = 0;  ///< largest extent (m)
  double lo[3];        ///< lowest centre (m)
  double length[3];
  double density;  ///< number density around the usual object (1/m^3)
  double densest;  ///< number density in the densest place (1/m^3)

  Summary(const BrickSample& sample, std::int64_t objects) {
    double seen = 0;
    for (const std::uint32_t n : sample.sizes) seen += n;
    largest = std::bit_cast<float>(sample.largest);
    present = static_cast<double>(objects) * seen / static_cast<double>(BrickSample::looked_at(objects));
    for (int bin = 0; bin < BrickSample::size_bins; bin += classes_per_octave) {
      double count = 0;
      Octave octave{};
      for (int c = bin; c < bin + classes_per_octave; ++c) {
        if (sample.sizes[c] == 0) continue;
        octave.largest = std::min<double>(class_end(c), largest);
        octave.size += sample.sizes[c] * octave.largest / (1 + 0.5 / classes_per_octave);
        count += sample.sizes[c];
      }
      if (count == 0) continue;
      octave.size /= count;
      // A size that was seen only once in the sample may exist only once: floors and oversize objects do.
      octave.share = count == 1 ? 1 / present : count / seen;
      octaves.push_back(octave);
    }
    double volume = 1;
    double places = 1;  // on an axis without extent all centres are in the first place
    for (int a = 0; a < 3; ++a) {
      if (sample.hi[a] != sample.lo[a]) places *= BrickSample::width;
      lo[a] = from_ordered_bits(sample.lo[a]);
      length[a] = std::max(from_ordered_bits(sample.hi[a]) - lo[a], shortest_length);
      volume *= length[a];
    }
    double squares = 0;
    double most = 0;
    for (const std::uint32_t n : sample.places) {
      squares += static_cast<double>(n) * n;
      most = std::max(most, static_cast<double>(n));
    }
    // The part that chance contributes is subtracted.
    density = present / volume * std::max(1.0, (squares - seen) * places / (seen * seen));
    densest = std::max(density, present / volume * (most - 3 * std::sqrt(most)) * places / seen);
  }

  /// Returns the edge of a brick of this width along an axis (m).
  double edge(int axis, double width) const { return std::min(length[axis], width); }
  double volume(double width) const { return edge(0, width) * edge(1, width) * edge(2, width); }
  /// Returns the width of bricks with this volume (m).
  double width_of(double wanted) const {
    double sides[3] = {length[0], length[1], length[2]};
    std::ranges::sort(sides);
    if (std::cbrt(wanted) <= sides[0]) return std::cbrt(wanted);
    if (std::sqrt(wanted / sides[0]) <= sides[1]) return std::sqrt(wanted / sides[0]);
    return std::min(wanted / (sides[0] * sides[1]), sides[2]);
  }
  /// Returns the number of bricks that contain an object of this size.
  double copies(double size, double width) const {
    double product = 1;
    for (const double l : length) product *= l > width ? 1 + std::min(size, l) / width : 1;
    return product;
  }
};

struct Choice {
  BrickMethod method;
  int rows;          ///< rows along y and z, for method rows; fewer where the brick is flat
  double reach;      ///< longest object in the cells of a stencil (m)
  double width = 0;  ///< width of a brick (m)
  double cost = 0;   ///< cost per object

  bool has_wide(const Octave& octave) const {
    return method == BrickMethod::stencil && octave.largest > reach;
  }
};

/// Returns the number of rows of a brick along y or z.
int rows_along(const Summary& all, const Choice& choice, int axis) {
  const double share = all.edge(axis, choice.width) / choice.width;
  return std::max(1, static_cast<int>(std::lround(choice.rows * share)));
}

/// The expected work in a brick around the usual object.
struct Load {
  double objects = 0;
  double wide = 0;  ///< objects among them that are too wide for the stencil
  double entries = 0;
  double entry_squares =
      0;             ///< sum over the objects: variance of the entries, since objects are there by chance
  double reach = 0;  ///< mean length of an entry along x (m)

  Load(const Summary& all, const Choice& choice, double density) {
    const double rows[3] = {1, static_cast<double>(rows_along(all, choice, 1)),
                            static_cast<double>(rows_along(all, choice, 2))};
    const double in_volume = density * all.volume(choice.width);
    for (const Octave& octave : all.octaves) {
      const double n = in_volume * octave.share * all.copies(octave.size, choice.width);
      const double within = std::min(octave.size, choice.width);
      double of_object = 1;
      for (int a = 1; a < 3 && choice.method == BrickMethod::rows; ++a)
        of_object *= std::min(1 + within * rows[a] / all.edge(a, choice.width), rows[a]);
      objects += n;
      if (choice.has_wide(octave)) wide += n;
      entries += n * of_object;
      entry_squares += n * of_object * of_object;
      reach += n * of_object * within;
    }
    reach /= entries;
  }
};

double usual_entries(BrickMethod method) { return round_entries * (method == BrickMethod::stencil ? 4 : 6); }

bool fits(const Summary& all, const Choice& choice) {
  if (choice.reach >= choice.width) return true;  // no narrower brick suits this reach
  const Load worst(all, choice, all.densest);
  const Load usual(all, choice, all.density);
  return worst.objects + spare_deviations * std::sqrt(worst.objects) <= brick_objects &&
         worst.entries + spare_deviations * std::sqrt(worst.entry_squares) <= most_entries(choice.method) &&
         usual.entries + usual_deviations * std::sqrt(usual.entry_squares) <= usual_entries(choice.method);
}

double cost_of(const Summary& all, const Choice& choice) {
  const Load load(all, choice, all.density);
  double tests;  // tests of an entry
  double runs = 1;
  if (choice.method == BrickMethod::stencil) {
    const double cell = std::max(choice.reach, choice.width / finest_stencil);
    double share = 0.5;  // share of the brick that holds the objects to be tested
    for (int a = 0; a < 3; ++a)
      share *= std::min(1.0, stencil_cells_tested[a] * cell / all.edge(a, choice.width));
    tests = (load.entries - load.wide) * share + load.wide * wide_test_cost;
    runs = stencil_runs;
  } else {
    tests = load.entries / (rows_along(all, choice, 1) * rows_along(all, choice, 2)) *
            std::min(1.0, (1 + 1 / cells_to_reach) * load.reach / all.edge(0, choice.width));
  }
  const double cost = load.objects * object_cost + load.entries * (entry_cost + runs * run_cost + tests);
  return cost / (all.density * all.volume(choice.width));
}

/// Returns the widest bricks that fit, with their cost; nothing if none suit, or if objects would on average
/// be copied into too many bricks.
std::optional<Choice> widest(const Summary& all, Choice choice) {
  constexpr int halvings = 7;
  double narrow = std::log2(all.width_of(fewest_objects / all.density));
  double wide = std::log2(all.width_of(brick_objects / all.densest));
  for (int k = 0; k < halvings; ++k) {
    const double tried = k == 0 ? wide : (narrow + wide) / 2;
    choice.width = std::exp2(tried);
    (fits(all, choice) ? narrow : wide) = tried;
  }
  choice.width = std::exp2(narrow);
  const Load load(all, choice, all.density);
  if (choice.reach >= choice.width || !fits(all, choice) ||
      load.objects > most_copies * all.density * all.volume(choice.width))
    return {};
  choice.cost = cost_of(all, choice);
  return choice;
}

/// Returns the cheapest of all choices; nothing if none suits.
std::optional<Choice> cheapest(const Summary& all) {
  std::optional<Choice> best;
  const auto consider = [&](const Choice& choice) {
    const std::optional<Choice> other = widest(all, choice);
    if (other && (!best || other->cost < best->cost)) best = other;
  };
  double wide = 0;
  for (std::size_t k = all.octaves.size(); k-- > 0 && wide <= most_wide; wide += all.octaves[k].share)
    consider({BrickMethod::stencil, 1, all.octaves[k].largest});
  for (int rows = 1; rows <= most_rows; ++rows) consider({BrickMethod::rows, rows, 0});
  return best;
}

BrickCells stencil_cells(const BrickPlan& plan) {
  BrickCells cells{};
  for (int a = 0; a < 3; ++a) {
    const auto cell =
        static_cast<std::uint32_t>(std::max<double>(plan.reach[a], brick_points / finest_stencil));
    cells.first[a] = brick_points - plan.reach[a];
    cells.factor[a] = (a == 0 ? stencil_fineness : 1) * 65536u / cell;
    cells.count[a] = 1;
    cells.count[a] = cells.cell_of(last_local, a) + 1;
  }
  return cells;
}

BrickCells row_cells(const Summary& all, const Choice& choice) {
  const double reach = Load(all, choice, all.density).reach;
  BrickCells cells{};
  std::int32_t room = most_cells(choice.method);
  for (const int a : {2, 1, 0}) {
    const double fine = std::clamp(cells_to_reach * all.edge(0, choice.width) / reach, 1.0, finest_row);
    cells.first[a] = brick_points;
    cells.count[a] = a > 0 ? rows_along(all, choice, a) : std::min(static_cast<std::int32_t>(fine), room);
    cells.factor[a] = static_cast<std::uint32_t>(cells.count[a]) << (16 - brick_bits);
    room /= cells.count[a];
  }
  return cells;
}

/// Chooses the width of the buckets so that the records which go from a tile to a bucket, and from a bucket's
/// chunk to a brick, are as contiguous as possible. Returns false if there are too many buckets.
bool choose_buckets(BrickPlan& plan) {
  std::int32_t fewest = 0;
  for (std::int32_t width = narrowest_bucket; width <= widest_bucket; ++width) {
    std::int32_t buckets[3];
    for (int a = 0; a < 3; ++a) buckets[a] = (plan.lattice.bricks[a] + width - 1) / width;
    const std::int32_t total = buckets[0] * buckets[1] * buckets[2];
    const std::int32_t runs = total + (width + 1) * (width + 1) * (width + 1);
    if (total > most_buckets || (fewest > 0 && runs >= fewest)) continue;
    fewest = runs;
    plan.bucket_width = width;
    std::ranges::copy(buckets, plan.buckets);
  }
  return fewest > 0;
}

/// Returns the number of bricks along each axis: as few as make a brick no larger, in volume, than one of
/// this width (m).
std::array<double, 3> count_bricks(const Summary& all, double width) {
  std::array<double, 3> count;
  std::array<double, 3> edge;
  for (std::size_t a = 0; a < 3; ++a) {
    count[a] = std::max(1.0, std::floor(all.length[a] / width));
    edge[a] = all.length[a] / count[a];
  }
  while (edge[0] * edge[1] * edge[2] > all.volume(width) * (1 + edge_slack)) {
    const auto a = static_cast<std::size_t>(std::ranges::max_element(edge) - edge.begin());
    edge[a] = all.length[a] / ++count[a];
  }
  return count;
}

}  // namespace

std::optional<BrickPlan> plan_bricks(const BrickSample& sample, std::int64_t objects) {
  if (sample.largest == 0 || objects > std::int64_t{body_mask}) return {};
  const Summary all(sample, objects);
  const std::optional<Choice> best = cheapest(all);
  if (!best) return {};

  BrickPlan plan{};
  plan.method = best->method;
  const std::array<double, 3> count = count_bricks(all, best->width);
  const double bricks = count[0] * count[1] * count[2];
  if (std::ranges::max(count) > static_cast<double>(most_bricks_along) ||
      bricks > static_cast<double>(most_bricks) ||
      bricks > std::max(few_bricks, all.present / fewest_objects))
    return {};
  for (int a = 0; a < 3; ++a) {
    const double n = count[static_cast<std::size_t>(a)];
    plan.lattice.bricks[a] = static_cast<std::int32_t>(n);
    plan.lattice.origin[a] = static_cast<float>(all.lo[a]);
    const double points_per_m = brick_points * n / all.length[a];
    plan.lattice.points_per_m[a] = static_cast<float>(std::min(points_per_m, most_points_per_m));
    plan.reach[a] = static_cast<std::int32_t>(
        std::min(std::ceil(best->reach * points_per_m * (1 + reach_slack)) + 1, double{brick_points}));
  }
  plan.cells = plan.method == BrickMethod::stencil ? stencil_cells(plan) : row_cells(all, *best);
  if (plan.cells.total() > most_cells(plan.method) || !choose_buckets(plan)) return {};
  return plan;
}

}  // namespace scree
