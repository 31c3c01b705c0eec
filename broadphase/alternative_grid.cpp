#include "broadphase/alternative_grid.hpp"

#include "broadphase/census.hpp"
#include "broadphase/grid_plan.hpp"
#include "broadphase/pair_list.hpp"
#include "broadphase/sorted_keys.hpp"

#include <algorithm>
#include <bit>
#include <limits>
#include <string>

namespace scree {

namespace {

/// The cells of all levels. Each cell has a key of at most 61 bits: level, z, y and x, and a bit that puts
/// the objects of that level before those of finer levels. An object no larger than a level's cells overlaps
/// at most two of them on each axis, so no object has more than eight entries on a level.
struct LevelCells {
  /// Largest number of bits of a cell's number on an axis. Cells whose numbers differ only in higher bits
  /// share a key, which costs tests.
  static constexpr int most_bits = 20;

  GridLevel levels[max_grid_levels];
  int count;
  int bits;  ///< bits of a cell's number on an axis; at least two, so that three cells in a row have
             ///< different numbers

  explicit LevelCells(const GridPlan& plan) : count(static_cast<int>(plan.levels.size())), bits(0) {
    std::ranges::copy(plan.levels, levels);
    for (const GridLevel& level : plan.levels) {
      // Centres are in the cells from 0 to last, corners in those from -1 to last + 1.
      for (const std::int32_t last : level.last)
        bits = std::max(bits, static_cast<int>(std::bit_width(static_cast<std::uint32_t>(last) + 2)));
    }
    bits = std::min(bits, most_bits);
  }

  int key_bits() const {
    return 1 + 3 * bits + static_cast<int>(std::bit_width(static_cast<unsigned>(count - 1)));
  }

  SCREE_HD int level_of(const Aabb& box) const { return level_of_extent(levels, extent_of(box)); }

  /// Returns the cells of a level that a box overlaps.
  SCREE_HD CellRange cells_of(int level, const Aabb& box) const {
    CellRange cells;
    for (int a = 0; a < 3; ++a) {
      cells.lo[a] = levels[level].cell_of(static_cast<double>(box.lo[a]), a);
      cells.hi[a] = levels[level].cell_of(static_cast<double>(box.hi[a]), a);
    }
    return cells;
  }

  SCREE_HD std::uint64_t key_of(int level, std::int32_t x, std::int32_t y, std::int32_t z, bool finer) const {
    std::uint64_t key = static_cast<std::uint64_t>(level) << bits | number(z);
    key = (key << bits | number(y)) << bits | number(x);
    return key << 1 | (finer ? 1 : 0);
  }
  SCREE_HD static bool is_finer(std::uint64_t key) { return (key & 1) != 0; }
  SCREE_HD int level_of_key(std::uint64_t key) const { return static_cast<int>(key >> (1 + 3 * bits)); }

  /// Returns the axes, one bit for each, on which a box in the cell of a key begins in an earlier cell.
  SCREE_HD std::int32_t begun_before(std::uint64_t key, const Aabb& box) const {
    const GridLevel& level = levels[level_of_key(key)];
    std::int32_t axes = 0;
    for (int a = 0; a < 3; ++a) {
      const std::uint64_t here = key >> (1 + a * bits);
      const std::uint64_t begin = number(level.cell_of(static_cast<double>(box.lo[a]), a));
      if (((here ^ begin) & mask()) != 0) axes |= 1 << a;
    }
    return axes;
  }

 private:
  SCREE_HD std::uint64_t mask() const { return (std::uint64_t{1} << bits) - 1; }
  SCREE_HD std::uint64_t number(std::int32_t cell) const { return static_cast<std::uint64_t>(cell) & mask(); }
};

struct CountEntries {
  LevelCells cells;
  ConstView<Aabb> bounds;
  View<std::uint32_t> entries;
  SCREE_HD void operator()(std::int64_t i) const {
    const Aabb box = bounds[i];
    entries[i] = 0;
    if (is_absent(box)) return;
    for (int level = cells.level_of(box); level < cells.count; ++level) {
      const CellRange range = cells.cells_of(level, box);
      std::int32_t product = 1;
      for (int a = 0; a < 3; ++a) product *= range.hi[a] - range.lo[a] + 1;
      entries[i] += static_cast<std::uint32_t>(product);
    }
  }
};

struct WriteEntries {
  LevelCells cells;
  ConstView<Aabb> bounds;
  ConstView<std::int64_t> first;
  View<std::uint64_t> key;
  View<std::int32_t> body;
  SCREE_HD void operator()(std::int64_t i) const {
    const Aabb box = bounds[i];
    if (is_absent(box)) return;
    const int own = cells.level_of(box);
    std::int64_t entry = first[i];
    for (int level = own; level < cells.count; ++level) {
      const CellRange range = cells.cells_of(level, box);
      for (std::int32_t z = range.lo[2]; z <= range.hi[2]; ++z)
        for (std::int32_t y = range.lo[1]; y <= range.hi[1]; ++y)
          for (std::int32_t x = range.lo[0]; x <= range.hi[0]; ++x) {
            key[entry] = cells.key_of(level, x, y, z, level > own);
            body[entry++] = static_cast<std::int32_t>(i);
          }
    }
  }
};

/// Gathers the boxes of the entries. Overlapping boxes share up to eight cells of a level. One of these cells
/// holds the larger of both lower corners: on each axis, one of the two boxes begins there. So the tag of an
/// entry has a bit for each axis on which its box begins in an earlier cell. Two entries that share such a
/// bit make no pair in this cell, just as two fixed bodies make none.
struct GatherEntries {
  LevelCells cells;
  ConstView<Aabb> bounds;
  ConstView<Mobility> mobility;
  ConstView<std::uint64_t> key;
  ConstView<std::int32_t> body;
  View<Boxed> entry;
  SCREE_HD void operator()(std::int64_t k) const {
    const Aabb box = bounds[body[k]];
    entry[k] = boxed(box, body[k], mobility[body[k]]);
    entry[k].hi.tag |= cells.begun_before(key[k], box) << 1;
  }
};

/// Tests each object of a level against the objects that follow it in its cell: others of the level, then
/// those of finer levels.
struct CellSearch : RunSearch {
  static constexpr const char* label = "broadphase.traverse.cells";

  const std::uint64_t* key;

  SCREE_HD Item item(std::int64_t k) const {
    if (LevelCells::is_finer(key[k])) return {sorted[k], {}};
    return {sorted[k], {static_cast<std::uint32_t>(k) + 1, static_cast<std::uint32_t>(end_of_cell(k))}};
  }

 private:
  /// Returns the end of the cell of entry k. It searches in steps that double, because the end is near except
  /// for the cells of oversize objects.
  SCREE_HD std::int64_t end_of_cell(std::int64_t k) const {
    const std::uint64_t last = key[k] | 1;
    std::int64_t begin = k + 1;
    std::int64_t step = 1;
    while (begin + step < items && key[begin + step] <= last) {
      begin += step;
      step *= 2;
    }
    return first_not_under(key, begin, begin + step < items ? begin + step : items, last + 1);
  }
};

/// Throws RunError if there are more entries than the runs can number.
void require_numbers(std::int64_t entries) {
  constexpr std::int64_t most = std::numeric_limits<std::uint32_t>::max();
  if (entries <= most) return;
  throw RunError("the alternative grid has " + std::to_string(entries) +
                 " entries of objects in cells, over " + std::to_string(most) +
                 "; broadphase.method: hierarchical_grid needs one for each object");
}

template <class Space>
class AlternativeGrid final : public BroadPhase<Space> {
 public:
  explicit AlternativeGrid(int levels) : forced_levels_(levels) {}

  ConstView<Pair> find(ConstView<Aabb> bounds, ConstView<Mobility> mobility) override {
    stats_ = {};
    const Census census = take_census<Space>(bounds);
    // The levels are the same in both spaces, so that the order of the pairs is the same too.
    const GridPlan plan =
        plan_grid(census, count_sizes<Space>(bounds, census), grid_costs<Host>, forced_levels_);
    stats_.levels = static_cast<int>(plan.levels.size());
    if (plan.levels.empty()) return {};
    const LevelCells cells(plan);
    write_entries(cells, bounds);
    parallel::sort_by_key("broadphase.sort", key_, body_, cells.key_bits());
    entry_.resize(key_.size());
    parallel::for_each<Space>(
        "broadphase.construct.gather", key_.size(),
        GatherEntries{cells, bounds, mobility, key_.view(), body_.view(), entry_.view()});
    return pairs_.collect(stats_, CellSearch{{key_.size(), entry_.data()}, key_.data()});
  }
  const BroadPhaseStats& stats() const override { return stats_; }

 private:
  /// Writes level and cell of each entry, in the order of the bodies, which a stable sort keeps within a
  /// cell.
  void write_entries(const LevelCells& cells, ConstView<Aabb> bounds) {
    entries_.resize(bounds.size());
    parallel::for_each<Space>("broadphase.initialize.count", bounds.size(),
                              CountEntries{cells, bounds, entries_.view()});
    const std::int64_t total =
        parallel::exclusive_scan<Space>("broadphase.initialize.places", entries_, first_);
    require_numbers(total);
    key_.resize(total);
    body_.resize(total);
    parallel::for_each<Space>("broadphase.initialize.cells", bounds.size(),
                              WriteEntries{cells, bounds, first_.view(), key_.view(), body_.view()});
  }

  int forced_levels_;
  BroadPhaseStats stats_;
  Array<std::uint32_t, Space> entries_;  ///< number of entries of each object
  Array<std::int64_t, Space> first_;     ///< index of the first entry of each object
  Array<std::uint64_t, Space> key_;      ///< cell of each entry
  Array<std::int32_t, Space> body_;      ///< object of each entry
  Array<Boxed, Space> entry_;            ///< boxes of the entries, sorted by cell
  PairList<Space> pairs_;
};

}  // namespace

template <class Space>
std::unique_ptr<BroadPhase<Space>> make_alternative_grid(int levels) {
  return std::make_unique<AlternativeGrid<Space>>(levels);
}

#define SCREE_INSTANTIATE(Space) \
  template std::unique_ptr<BroadPhase<Space>> make_alternative_grid<Space>(int);
SCREE_FOR_EACH_SPACE(SCREE_INSTANTIATE)
#undef SCREE_INSTANTIATE

}  // namespace scree
