// The two searches of the hierarchical grid, over objects sorted by cell. Together they test each pair that
// can overlap from one side only.
#pragma once

#include "broadphase/aabb.hpp"
#include "broadphase/grid_level.hpp"
#include "core/array.hpp"

#include <cstdint>

namespace scree {

/// All that a test needs of an object, in cell order so that neighbours share cache lines.
struct alignas(16) GridObject {
  float lo[3];
  std::int32_t body;
  float hi[3];
  std::int32_t fixed;  ///< 0 or 1

  SCREE_HD Aabb box() const { return {{lo[0], lo[1], lo[2]}, {hi[0], hi[1], hi[2]}}; }
};

/// The grid, built.
struct GridView {
  const GridLevel* levels;
  int level_count;
  const GridObject* objects;    ///< sorted by cell
  const std::uint32_t* starts;  ///< of each cell in `objects`, one past the last cell included
};

/// Tests one object against runs of others.
template <class Hit>
struct Tester {
  const GridView& grid;
  const GridObject object;
  Hit& hit;
  std::uint32_t tests = 0;

  SCREE_HD bool meets(const GridObject& other) {
    ++tests;
    return overlap(object.box(), other.box()) && !(object.fixed && other.fixed);
  }
  /// Against the objects from `begin` to before `end` in cell order.
  SCREE_HD void test_run(std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t k = begin; k < end; ++k) {
      const GridObject other = grid.objects[k];
      if (meets(other)) hit(pair_of(object.body, other.body));
    }
  }
  /// Against the cells x to end of one row.
  SCREE_HD void test_row(const GridLevel& level, std::int32_t x, std::int32_t end, std::int32_t y,
                         std::int32_t z) {
    while (x <= end) {
      const std::int32_t last = level.run_end(x, end);
      const std::uint32_t cell = level.address(x, y, z);
      test_run(grid.starts[cell], grid.starts[cell + static_cast<std::uint32_t>(last - x) + 1]);
      x = last + 1;
    }
  }
};

/// Each object against its own level and against those levels that are searched upward. One item per object.
struct NearSearch {
  static constexpr const char* count_label = "broadphase.traverse.near.count";
  static constexpr const char* fill_label = "broadphase.traverse.near.fill";

  GridView grid;
  std::int64_t items;

  template <class Hit>
  SCREE_HD std::uint32_t operator()(std::int64_t k, Hit& hit) const {
    const int own = level_of_rank(grid.levels, k);
    Tester<Hit> tester{grid, grid.objects[k], hit};
    search_own(tester, grid.levels[own], static_cast<std::uint32_t>(k));
    const std::uint32_t upward = grid.levels[own].upward;
    for (int l = own + 1; l < grid.level_count; ++l) {
      if (upward >> l & 1) search_up(tester, grid.levels[l]);
    }
    return tester.tests;
  }

 private:
  /// Half of the 27 cells around: what follows in the own cell, the next cell of its row, and the four rows
  /// after it in the order of (z, y). The other half finds this object from there.
  template <class Hit>
  SCREE_HD void search_own(Tester<Hit>& tester, const GridLevel& level, std::uint32_t k) const {
    const Aabb box = tester.object.box();
    const std::int32_t x = level.cell_of(centre_of(box, 0), 0);
    const std::int32_t y = level.cell_of(centre_of(box, 1), 1);
    const std::int32_t z = level.cell_of(centre_of(box, 2), 2);
    const std::int32_t before = x > 0 ? x - 1 : 0;
    const std::int32_t after = x < level.last[0] ? x + 1 : x;

    const std::int32_t run_end = level.run_end(x, after);
    const std::uint32_t end_of_run = level.address(x, y, z) + static_cast<std::uint32_t>(run_end - x) + 1;
    tester.test_run(k + 1, grid.starts[end_of_run]);
    tester.test_row(level, run_end + 1, after, y, z);
    if (y < level.last[1]) tester.test_row(level, before, after, y + 1, z);
    if (z < level.last[2]) {
      const std::int32_t last_y = y < level.last[1] ? y + 1 : y;
      for (std::int32_t row = y > 0 ? y - 1 : 0; row <= last_y; ++row) {
        tester.test_row(level, before, after, row, z + 1);
      }
    }
  }

  /// At most 3x3x3 cells, because those cells are at least as wide as the object.
  template <class Hit>
  SCREE_HD void search_up(Tester<Hit>& tester, const GridLevel& level) const {
    const CellRange range = level.reach_of(tester.object.box());
    for (std::int32_t z = range.lo[2]; z <= range.hi[2]; ++z) {
      for (std::int32_t y = range.lo[1]; y <= range.hi[1]; ++y) {
        tester.test_row(level, range.lo[0], range.hi[0], y, z);
      }
    }
  }
};

/// All objects of level `from` against level `to`, whose cells are narrower: one query per object.
struct DescentView {
  int from;
  int to;
  std::int64_t first_query;
};

/// A query, and how it is cut into work items: into runs of up to brick_row cells or, where these are too
/// many for the objects there are, into all objects of the level. A giant is thus spread over as many threads
/// as it needs.
struct Query {
  static constexpr std::int64_t runs_per_item = 16;
  static constexpr std::int64_t objects_per_item = 64;
  // A run costs about as much as this many tests.
  static constexpr double tests_per_run = 3;

  std::int64_t object;  ///< in cell order
  int to;               ///< level searched
  CellRange range;
  std::int64_t runs_per_row;
  std::int64_t rows_y;  ///< rows per layer of cells
  std::int64_t runs;
  bool all;  ///< test all objects of the level instead

  SCREE_HD std::int64_t items(const GridLevel& level) const {
    return all ? (level.end - level.begin + objects_per_item - 1) / objects_per_item
               : (runs + runs_per_item - 1) / runs_per_item;
  }
};

SCREE_HD inline Query make_query(const GridView& grid, const DescentView* descents, std::int64_t q) {
  while (q >= descents->first_query + (grid.levels[descents->from].end - grid.levels[descents->from].begin)) {
    ++descents;
  }
  Query query;
  query.object = grid.levels[descents->from].begin + (q - descents->first_query);
  query.to = descents->to;
  const GridLevel& level = grid.levels[query.to];
  query.range = level.reach_of(grid.objects[query.object].box());
  const CellRange& range = query.range;
  const bool empty = range.lo[0] > range.hi[0] || range.lo[1] > range.hi[1] || range.lo[2] > range.hi[2];
  constexpr std::int64_t row = brick_row;
  query.runs_per_row = empty ? 0 : range.hi[0] / row - range.lo[0] / row + 1;
  query.rows_y = range.hi[1] - range.lo[1] + 1;
  const std::int64_t rows_z = range.hi[2] - range.lo[2] + 1;
  // In floating point, since the product of three such numbers can pass 64 bits.
  const double runs = static_cast<double>(query.runs_per_row) * static_cast<double>(query.rows_y) *
                      static_cast<double>(rows_z);
  query.all = runs * Query::tests_per_run > static_cast<double>(level.end - level.begin);
  query.runs = query.all ? 0 : query.runs_per_row * query.rows_y * rows_z;
  return query;
}

/// The queries of all descents, cut into items.
struct WideSearch {
  static constexpr const char* count_label = "broadphase.traverse.wide.count";
  static constexpr const char* fill_label = "broadphase.traverse.wide.fill";

  GridView grid;
  std::int64_t items;
  const DescentView* descents;
  const std::int64_t* first_item;  ///< of each query, one past the last included
  std::int64_t queries;

  template <class Hit>
  SCREE_HD std::uint32_t operator()(std::int64_t item, Hit& hit) const {
    const std::int64_t q = query_of(item);
    const Query query = make_query(grid, descents, q);
    Tester<Hit> tester{grid, grid.objects[query.object], hit};
    const std::int64_t part = item - first_item[q];
    if (query.all) {
      search_all(tester, grid.levels[query.to], part, first_item[q + 1] - first_item[q]);
    } else {
      search_runs(tester, query, part);
    }
    return tester.tests;
  }

 private:
  SCREE_HD std::int64_t query_of(std::int64_t item) const {
    std::int64_t lo = 0;
    std::int64_t hi = queries;
    while (hi - lo > 1) {
      const std::int64_t middle = lo + (hi - lo) / 2;
      (first_item[middle] <= item ? lo : hi) = middle;
    }
    return lo;
  }

  /// Every parts-th object, so that neighbouring threads read neighbouring objects.
  template <class Hit>
  SCREE_HD void search_all(Tester<Hit>& tester, const GridLevel& level, std::int64_t part,
                           std::int64_t parts) const {
    for (std::int64_t k = level.begin + part; k < level.end; k += parts) {
      tester.test_run(static_cast<std::uint32_t>(k), static_cast<std::uint32_t>(k) + 1);
    }
  }

  template <class Hit>
  SCREE_HD void search_runs(Tester<Hit>& tester, const Query& query, std::int64_t part) const {
    const GridLevel& level = grid.levels[query.to];
    const std::int64_t first = part * Query::runs_per_item;
    const std::int64_t last =
        first + Query::runs_per_item < query.runs ? first + Query::runs_per_item : query.runs;
    constexpr auto row = static_cast<std::int32_t>(brick_row);
    for (std::int64_t r = first; r < last; ++r) {
      const std::int64_t line = r / query.runs_per_row;
      const auto y = static_cast<std::int32_t>(query.range.lo[1] + line % query.rows_y);
      const auto z = static_cast<std::int32_t>(query.range.lo[2] + line / query.rows_y);
      const std::int32_t begin =
          (query.range.lo[0] / row + static_cast<std::int32_t>(r % query.runs_per_row)) * row;
      const std::int32_t end = begin + row - 1;
      search_run(tester, level,
                 {{begin > query.range.lo[0] ? begin : query.range.lo[0], y, z},
                  {end < query.range.hi[0] ? end : query.range.hi[0], y, z}});
    }
  }

  /// One run of cells of a row. A wide search can visit a slot of a hashed table under several cells: what
  /// stands there counts only under its own.
  template <class Hit>
  SCREE_HD void search_run(Tester<Hit>& tester, const GridLevel& level, const CellRange& run) const {
    const std::uint32_t cell = level.address(run.lo[0], run.lo[1], run.lo[2]);
    const std::uint32_t end = grid.starts[cell + static_cast<std::uint32_t>(run.hi[0] - run.lo[0]) + 1];
    for (std::uint32_t k = grid.starts[cell]; k < end; ++k) {
      const GridObject other = grid.objects[k];
      if (tester.meets(other) && (!level.hashed || level.stands_in(other.box(), run))) {
        tester.hit(pair_of(tester.object.body, other.body));
      }
    }
  }
};

}  // namespace scree
