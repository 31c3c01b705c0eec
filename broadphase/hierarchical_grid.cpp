#include "broadphase/hierarchical_grid.hpp"

#include "broadphase/bricks.hpp"
#include "broadphase/census.hpp"
#include "broadphase/grid_objects.hpp"
#include "broadphase/grid_plan.hpp"
#include "broadphase/grid_search.hpp"
#include "broadphase/pair_list.hpp"
#include "core/parallel.hpp"
#include "core/space_prefetch.hpp"

#include <algorithm>
#include <bit>
#include <vector>

namespace scree {

namespace {

struct AssignCell {
  ConstView<Aabb> bounds;
  ConstView<GridLevel> levels;
  std::uint32_t absent;  ///< key of an absent object, which is in no cell; it comes after all cells
  View<std::uint32_t> key;
  View<std::int32_t> body;
  SCREE_HD void operator()(std::int64_t i) const {
    body[i] = static_cast<std::int32_t>(i);
    const Aabb box = bounds[i];
    if (is_absent(box)) {
      key[i] = absent;
      return;
    }
    const GridLevel& level = levels[level_of_extent(levels.data(), extent_of(box))];
    key[i] = level.address(level.cell_of(centre_of(box, 0), 0), level.cell_of(centre_of(box, 1), 1),
                           level.cell_of(centre_of(box, 2), 2));
  }
};

template <class Space>
struct GatherObject {
  ConstView<Aabb> bounds;
  ConstView<Mobility> mobility;
  ConstView<std::int32_t> body;
  GridObjects<Space> objects;
  SCREE_HD void operator()(std::int64_t k) const {
    SCREE_ON_HOST(constexpr std::int64_t ahead = 16; if (k + ahead < body.size()) {
      const std::int32_t next = body[k + ahead];
      prefetch_whole(bounds[next]);
      prefetch_whole(mobility[next]);
    })
    const std::int32_t i = body[k];
    objects.set(k, boxed(bounds[i], i, mobility[i]));
  }
};

/// Writes where the next cell starts, from the last object of each cell's run.
struct EndRun {
  ConstView<std::uint32_t> key;
  std::int64_t count;
  View<std::uint32_t> starts;
  SCREE_HD void operator()(std::int64_t k) const {
    if (k + 1 == count || key[k + 1] != key[k]) starts[key[k] + 1] = static_cast<std::uint32_t>(k) + 1;
  }
};

template <class Space>
struct CountQueryItems {
  GridView<Space> grid;
  const LevelPair* descents;
  View<std::uint32_t> items;
  SCREE_HD void operator()(std::int64_t q) const {
    const Query query = make_query(grid, descents, q);
    items[q] = static_cast<std::uint32_t>(query.items(grid.levels[query.to]));
  }
};

template <class Space>
class HierarchicalGrid final : public BroadPhase<Space> {
 public:
  explicit HierarchicalGrid(int levels) : forced_levels_(levels) {}

  ConstView<Pair> find(ConstView<Aabb> bounds, ConstView<Mobility> mobility) override {
    stats_ = {};
    if (forced_levels_ == 0)
      if (const auto pairs = bricks_.find(bounds, mobility, stats_)) return *pairs;
    initialize(bounds);
    if (plan_.levels.empty()) return {};
    sort();
    construct(bounds, mobility);
    return traverse();
  }

  const BroadPhaseStats& stats() const override { return stats_; }

 private:
  /// Finds the level and the cell of each object.
  void initialize(ConstView<Aabb> bounds) {
    const Census census = take_census<Space>(bounds);
    plan_ = plan_grid(census, count_sizes<Space>(bounds, census), grid_costs_for<Space>(forced_levels_),
                      forced_levels_);
    stats_.levels = static_cast<int>(plan_.levels.size());
    if (plan_.levels.empty()) return;
    objects_.resize(census.present);
    copy(levels_, plan_.levels);
    key_.resize(bounds.size());
    body_.resize(bounds.size());
    parallel::for_each<Space>("broadphase.initialize.cells", bounds.size(),
                              AssignCell{bounds, levels_.view(), plan_.cells, key_.view(), body_.view()});
  }

  /// Sorts the objects by cell. The sort is stable, so objects of one cell stay in the order of their
  /// numbers.
  void sort() { parallel::sort_by_key("broadphase.sort", key_, body_, std::bit_width(plan_.cells)); }

  /// Finds the start and end of each cell's run, and copies the objects themselves in cell order.
  void construct(ConstView<Aabb> bounds, ConstView<Mobility> mobility) {
    parallel::for_each<Space>("broadphase.construct.gather", objects_.size(),
                              GatherObject<Space>{bounds, mobility, body_.view(), objects_.objects()});
    starts_.resize(std::int64_t{plan_.cells} + 1);
    parallel::fill("broadphase.construct.clear", starts_, 0u);
    parallel::for_each<Space>("broadphase.construct.ends", objects_.size(),
                              EndRun{key_.view(), objects_.size(), starts_.view()});
    parallel::running_max("broadphase.construct.starts", starts_);
  }

  /// Searches each object's own level and the other levels.
  ConstView<Pair> traverse() {
    GridView<Space> grid{{}, false, objects_.objects(), starts_.data()};
    std::ranges::copy(plan_.levels, grid.levels);
    grid.any_hashed = std::ranges::any_of(plan_.levels, &GridLevel::hashed);
    return pairs_.collect(stats_, OwnSearch<Space>(grid, objects_.size()), up_search(grid),
                          wide_search(grid));
  }

  UpSearch<Space> up_search(const GridView<Space>& grid) {
    const std::int64_t searches = plan_.searches(plan_.ascents);
    if (searches > 0) copy(ascents_, plan_.ascents);
    const int parts = (grid.any_hashed ? 2 : 1) * UpSearch<Space>::parts_of_row;
    return {{{grid, searches, parts}}, ascents_.data()};
  }

  /// Divides the searches of large objects among small ones into items of similar cost.
  WideSearch<Space> wide_search(const GridView<Space>& grid) {
    const std::int64_t queries = plan_.searches(plan_.descents);
    WideSearch<Space> search{{grid, 0, Query::parts}, nullptr, nullptr, queries};
    if (queries == 0) return search;
    copy(descents_, plan_.descents);
    query_items_.resize(queries);
    parallel::for_each<Space>("broadphase.traverse.queries", queries,
                              CountQueryItems<Space>{grid, descents_.data(), query_items_.view()});
    search.items = parallel::exclusive_scan<Space>("broadphase.traverse.items", query_items_, first_item_);
    search.descents = descents_.data();
    search.first_item = first_item_.data();
    return search;
  }

  int forced_levels_;
  BroadPhaseStats stats_;
  Bricks<Space> bricks_;
  GridPlan plan_;
  Array<GridLevel, Space> levels_;
  Array<std::uint32_t, Space> key_;  ///< cell of each object
  Array<std::int32_t, Space> body_;  ///< number of each object
  GridObjectArray<Space> objects_;   ///< the objects in cell order
  Array<std::uint32_t, Space> starts_;
  Array<LevelPair, Space> ascents_, descents_;
  Array<std::uint32_t, Space> query_items_;
  Array<std::int64_t, Space> first_item_;
  PairList<Space> pairs_;
};

}  // namespace

template <class Space>
std::unique_ptr<BroadPhase<Space>> make_hierarchical_grid(int levels) {
  return std::make_unique<HierarchicalGrid<Space>>(levels);
}

#define SCREE_INSTANTIATE(Space) \
  template std::unique_ptr<BroadPhase<Space>> make_hierarchical_grid<Space>(int);
SCREE_FOR_EACH_SPACE(SCREE_INSTANTIATE)
#undef SCREE_INSTANTIATE

}  // namespace scree
