// The searches of the hierarchical grid, over objects sorted by cell. Together they test each pair that can
// overlap from one side only.
#pragma once

#include "broadphase/aabb.hpp"
#include "broadphase/grid_objects.hpp"
#include "broadphase/grid_plan.hpp"

#include <bit>
#include <cstdint>

namespace scree {

/// The complete grid, as the searches use it.
template <class Space>
struct GridView {
  GridLevel levels[max_grid_levels];
  bool any_hashed;
  GridObjects<Space> objects;
  const std::uint32_t* starts;  ///< start of each cell among the objects, and the end of the last cell

  /// Returns the objects in the cells from x to `end` of a row: those that lie in one run with x (part 0), or
  /// the rest of them (part 1), which are in the next brick of a hashed table. In a hashed table these are at
  /// most brick_row cells. Part 1 of a dense table is empty.
  SCREE_HD Run row(const GridLevel& level, std::int32_t x, std::int32_t end, std::int32_t y, std::int32_t z,
                   int part) const {
    if (level.hashed) {
      const std::int32_t last = level.run_end(x, end);
      if (part == 0) {
        end = last;
      } else {
        x = last + 1;
      }
    } else if (part != 0) {
      return {};
    }
    if (x > end) return {};
    const std::uint32_t cell = level.address(x, y, z);
    return {starts[cell], starts[cell + static_cast<std::uint32_t>(end - x) + 1]};
  }
};

/// Returns the level pair, from a list, to which a search belongs.
template <class Space>
SCREE_HD const LevelPair& pair_of_search(const GridView<Space>& grid, const LevelPair* pairs,
                                         std::int64_t search) {
  while (search >= pairs->first + (grid.levels[pairs->from].end - grid.levels[pairs->from].begin)) ++pairs;
  return *pairs;
}

/// The common part of all searches of the grid.
template <class Space>
struct GridSearch {
  using Candidate = Boxed;
  using Objects = GridObjects<Space>;
  static constexpr int lanes = Objects::lanes;

  GridView<Space> grid;
  std::int64_t items;
  int parts;

  SCREE_HD Boxed candidate(std::uint32_t k) const { return grid.objects.object(k); }
  void prefetch(std::uint32_t block) const { grid.objects.prefetch(block); }
};

/// A search whose objects are tested against all candidates in the same way.
template <class Space>
struct PlainSearch : GridSearch<Space> {
  using Object = typename GridObjects<Space>::Probe;

  SCREE_HD bool meets(const Object& a, int, const Boxed& b) const { return may_collide(a, b); }
  std::uint32_t meets_block(const Object& a, int, std::uint32_t block) const {
    return this->grid.objects.may_collide(a, block);
  }
  SCREE_HD Pair match(const Object& a, const Boxed& b) const { return pair_of(a.body(), b.body()); }
};

/// The search of each object in half of the 27 cells around it on its own level: the objects after it in its
/// cell, the next cell of its row, and the four rows after that row in the order of (z, y). Pairs with
/// objects in the other half are found by the searches of those objects.
template <class Space>
struct OwnSearch : PlainSearch<Space> {
  static constexpr const char* label = "broadphase.traverse.own";
  using Objects = GridObjects<Space>;
  using GridSearch<Space>::grid;
  struct Item {
    typename Objects::Probe object;
    int level;
    std::uint32_t next;
    std::int32_t x, y, z;
  };

  OwnSearch(const GridView<Space>& of, std::int64_t objects)
      : PlainSearch<Space>{{of, objects, of.any_hashed ? 2 : 1}} {}

  SCREE_HD Item item(std::int64_t k) const {
    const int own = level_of_rank(grid.levels, k);
    const GridLevel& level = grid.levels[own];
    const Boxed object = grid.objects.object(k);
    const Aabb box = object.box();
    return {Objects::probe(object),
            own,
            static_cast<std::uint32_t>(k) + 1,
            level.cell_of(centre_of(box, 0), 0),
            level.cell_of(centre_of(box, 1), 1),
            level.cell_of(centre_of(box, 2), 2)};
  }
  SCREE_HD Run run(const Item& at, int part, int row) const {
    const GridLevel& level = grid.levels[at.level];
    const std::int32_t y = row < 2 ? at.y + row : at.y + row - 3;
    const std::int32_t z = row < 2 ? at.z : at.z + 1;
    if (y < 0 || y > level.last[1] || z > level.last[2]) return {};
    const std::int32_t before = row == 0 || at.x == 0 ? at.x : at.x - 1;
    const std::int32_t after = at.x < level.last[0] ? at.x + 1 : at.x;
    Run run = grid.row(level, before, after, y, z, part);
    if (row == 0 && part == 0) run.begin = at.next;
    return run;
  }
};

/// The search of each object of a level in a level with wider cells: in at most 3x3x3 of them.
template <class Space>
struct UpSearch : PlainSearch<Space> {
  static constexpr const char* label = "broadphase.traverse.up";
  static constexpr int parts_of_row = 2;  // 9 rows, runs_at_once in each part
  using Objects = GridObjects<Space>;
  using GridSearch<Space>::grid;
  struct Item {
    typename Objects::Probe object;
    int level;
    CellRange range;
  };

  const LevelPair* ascents;

  SCREE_HD Item item(std::int64_t i) const {
    const LevelPair& ascent = pair_of_search(grid, ascents, i);
    const Boxed object = grid.objects.object(grid.levels[ascent.from].begin + (i - ascent.first));
    return {Objects::probe(object), ascent.to, grid.levels[ascent.to].reach_of(object.box())};
  }
  SCREE_HD Run run(const Item& item, int part, int r) const {
    const CellRange& range = item.range;
    const int row = part % parts_of_row * runs_at_once + r;
    const std::int32_t y = range.lo[1] + row % 3;
    const std::int32_t z = range.lo[2] + row / 3;
    if (row >= 9 || y > range.hi[1] || z > range.hi[2]) return {};
    return grid.row(grid.levels[item.level], range.lo[0], range.hi[0], y, z, part / parts_of_row);
  }
};

/// A search of an object among smaller ones, and its division into work items: into runs of cells of one row,
/// or, if these are too many for the number of objects, into all objects of the level. So an oversize object
/// is distributed over as many threads as it needs.
struct Query {
  static constexpr int parts = 3;  // parts of an item
  static constexpr int runs_per_item = parts * runs_at_once;
  static constexpr std::int64_t objects_per_item = 64;
  static constexpr std::int32_t longest_run = 4 * brick_row;  // cells of a dense level
  // Cost of a run, in tests.
  static constexpr double tests_per_run = 3;

  std::int64_t object;  ///< index of the object, in cell order
  int to;               ///< level that is searched
  CellRange range;
  std::int32_t run_cells;  ///< largest number of cells in a run
  std::int32_t first_x;    ///< x from which the runs of a row are counted; the range begins there or after it
  std::int32_t runs_per_row;
  std::int32_t rows_y;    ///< number of rows per layer of cells
  double layers_per_row;  ///< inverse of rows_y, because division is slower
  std::int64_t runs;
  bool all;  ///< whether all objects of the level are tested instead

  /// Returns the cells of a run.
  SCREE_HD CellRange cells(std::int64_t run) const {
    // There are fewer runs than objects of the level, so 32 bits hold their number. The product differs from
    // any whole number by at least half of a row's share of a layer, so that its rounding does not matter.
    const auto number = static_cast<std::int32_t>(run);
    const std::int32_t row = runs_per_row == 1 ? number : number / runs_per_row;
    const auto layer = static_cast<std::int32_t>((row + 0.5) * layers_per_row);
    const std::int32_t y = range.lo[1] + row - layer * rows_y;
    const std::int32_t z = range.lo[2] + layer;
    const std::int32_t begin = first_x + (number - row * runs_per_row) * run_cells;
    const std::int32_t end = begin + run_cells - 1;
    return {{begin > range.lo[0] ? begin : range.lo[0], y, z}, {end < range.hi[0] ? end : range.hi[0], y, z}};
  }

  SCREE_HD std::int64_t items(const GridLevel& level) const {
    return all ? (level.end - level.begin + objects_per_item - 1) / objects_per_item
               : (runs + runs_per_item - 1) / runs_per_item;
  }
};

template <class Space>
SCREE_HD Query make_query(const GridView<Space>& grid, const LevelPair* descents, std::int64_t q) {
  const LevelPair& descent = pair_of_search(grid, descents, q);
  Query query;
  query.object = grid.levels[descent.from].begin + (q - descent.first);
  query.to = descent.to;
  const GridLevel& level = grid.levels[query.to];
  query.range = level.reach_of(grid.objects.object(query.object).box());
  const CellRange& range = query.range;
  const bool empty = range.lo[0] > range.hi[0] || range.lo[1] > range.hi[1] || range.lo[2] > range.hi[2];
  query.run_cells = level.hashed ? static_cast<std::int32_t>(brick_row) : Query::longest_run;
  query.first_x = level.hashed ? range.lo[0] / query.run_cells * query.run_cells : range.lo[0];
  query.runs_per_row = empty ? 0 : (range.hi[0] - query.first_x) / query.run_cells + 1;
  query.rows_y = range.hi[1] - range.lo[1] + 1;
  query.layers_per_row = 1.0 / query.rows_y;
  const std::int32_t rows_z = range.hi[2] - range.lo[2] + 1;
  // The product is formed in floating point, since the product of three such numbers can exceed 64 bits.
  const double runs = static_cast<double>(query.runs_per_row) * static_cast<double>(query.rows_y) *
                      static_cast<double>(rows_z);
  query.all = runs * Query::tests_per_run > static_cast<double>(level.end - level.begin);
  query.runs = query.all ? 0 : std::int64_t{query.runs_per_row} * query.rows_y * rows_z;
  return query;
}

/// The search of the queries of all descents, divided into items.
template <class Space>
struct WideSearch : GridSearch<Space> {
  static constexpr const char* label = "broadphase.traverse.wide";
  using Objects = GridObjects<Space>;
  using GridSearch<Space>::grid;
  struct Object {
    typename Objects::Probe probe;
    Query query;
    std::int64_t part;
    bool by_cell;  ///< whether candidates count only in their own cell
  };
  struct Item {
    Object object;
    std::int64_t query;
  };

  const LevelPair* descents;
  const std::int64_t* first_item;  ///< index of the first item of each query, and the end of the last one
  std::int64_t queries;

  SCREE_HD Item item(std::int64_t i) const {
    const std::int64_t q = query_of(i);
    return item_of(q, i - first_item[q]);
  }
  /// Returns the item after another one, faster than item() does. There is none after the last item.
  Item item_after(const Item& before) const {
    std::int64_t q = before.query;
    const std::int64_t next = first_item[q] + before.object.part + 1;
    if (next < first_item[q + 1]) {
      Item item = before;
      ++item.object.part;
      return item;
    }
    do ++q;
    while (next >= first_item[q + 1]);
    return item_of(q, 0);
  }
  SCREE_HD Run run(const Item& item, int part, int r) const {
    const Query& query = item.object.query;
    const GridLevel& level = grid.levels[query.to];
    if (query.all) return part == 0 && r == 0 ? objects_of(level, item.object.part) : Run{};
    const std::int64_t number = item.object.part * Query::runs_per_item + part * runs_at_once + r;
    if (number >= query.runs) return {};
    const CellRange cells = query.cells(number);
    return grid.row(level, cells.lo[0], cells.hi[0], cells.lo[1], cells.lo[2], 0);
  }
  /// Returns whether an object meets a candidate. A wide search can visit a slot of a hashed table as several
  /// cells: an object in the slot counts only in its own cell.
  SCREE_HD bool meets(const Object& a, int r, const Boxed& b) const {
    return may_collide(a.probe, b) & counts(a, r, b);
  }
  std::uint32_t meets_block(const Object& a, int r, std::uint32_t block) const {
    std::uint32_t found = grid.objects.may_collide(a.probe, block);
    if (a.by_cell)
      for (std::uint32_t rest = found; rest != 0; rest &= rest - 1) {
        const auto l = static_cast<std::uint32_t>(std::countr_zero(rest));
        if (!counts(a, r, this->candidate(block * Objects::lanes + l))) found &= ~(1u << l);
      }
    return found;
  }
  SCREE_HD Pair match(const Object& a, const Boxed& b) const { return pair_of(a.probe.body(), b.body()); }

 private:
  SCREE_HD Item item_of(std::int64_t q, std::int64_t part) const {
    const Query query = make_query(grid, descents, q);
    const bool by_cell = !query.all && grid.levels[query.to].hashed;
    return {{Objects::probe(grid.objects.object(query.object)), query, part, by_cell}, q};
  }
  SCREE_HD std::int64_t query_of(std::int64_t item) const {
    std::int64_t lo = 0;
    std::int64_t hi = queries;
    while (hi - lo > 1) {
      const std::int64_t middle = lo + (hi - lo) / 2;
      (first_item[middle] <= item ? lo : hi) = middle;
    }
    return lo;
  }
  SCREE_HD bool counts(const Object& a, int r, const Boxed& b) const {
    return !a.by_cell ||
           grid.levels[a.query.to].stands_in(b.box(), a.query.cells(a.part * Query::runs_per_item + r));
  }
  SCREE_HD static Run objects_of(const GridLevel& level, std::int64_t part) {
    const std::int64_t begin = level.begin + part * Query::objects_per_item;
    const std::int64_t end = begin + Query::objects_per_item;
    return {static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end < level.end ? end : level.end)};
  }
};

}  // namespace scree
