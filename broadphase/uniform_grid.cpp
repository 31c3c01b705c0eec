#include "broadphase/uniform_grid.hpp"

#include "broadphase/census.hpp"
#include "broadphase/pair_list.hpp"
#include "broadphase/sorted_keys.hpp"

#include <algorithm>
#include <cmath>

namespace scree {

namespace {

/// The cells of the grid. They are numbered from the lowest centre, at most 2^21 on each axis, so that a cell
/// has a 63-bit key, and the cells of a row have consecutive keys. There is no table: rows are found among
/// the sorted keys.
struct UniformCells {
  static constexpr int bits = 21;
  static constexpr std::int64_t last = (std::int64_t{1} << bits) - 1;

  static constexpr std::uint64_t absent = std::uint64_t{1} << (3 * bits);  ///< key of an absent object

  double origin[3];
  double width;

  SCREE_HD std::int64_t cell_of(const Aabb& box, int axis) const {
    const double number = floor((centre_of(box, axis) - origin[axis]) / width);
    return static_cast<std::int64_t>(fmin(fmax(number, 0.0), static_cast<double>(last)));
  }
  SCREE_HD static std::uint64_t key_of(std::int64_t x, std::int64_t y, std::int64_t z) {
    return static_cast<std::uint64_t>(((z << bits | y) << bits) | x);
  }
};

struct KeyOfBox {
  UniformCells cells;
  ConstView<Aabb> bounds;
  View<std::uint64_t> key;
  View<std::int32_t> body;
  SCREE_HD void operator()(std::int64_t i) const {
    const Aabb box = bounds[i];
    body[i] = static_cast<std::int32_t>(i);
    key[i] = is_absent(box)
                 ? UniformCells::absent
                 : UniformCells::key_of(cells.cell_of(box, 0), cells.cell_of(box, 1), cells.cell_of(box, 2));
  }
};

/// Tests each object against all 27 cells around it; a pair is reported by the body with the lower number.
struct FullStencil {
  static constexpr const char* label = "broadphase.uniform_grid.search";
  using Object = Boxed;
  using Candidate = Boxed;
  struct Item {
    Boxed object;
    std::int64_t cell[3];
    bool absent;
  };

  std::int64_t items;
  UniformCells cells;
  ConstView<Aabb> bounds;
  ConstView<Mobility> mobility;
  ConstView<std::uint64_t> key;
  ConstView<std::int32_t> body;
  int parts = 2;

  SCREE_HD Item item(std::int64_t k) const {
    Item item{candidate(static_cast<std::uint32_t>(k)), {0, 0, 0}, key[k] == UniformCells::absent};
    for (int a = 0; a < 3 && !item.absent; ++a) item.cell[a] = cells.cell_of(item.object.box(), a);
    return item;
  }
  SCREE_HD Run run(const Item& item, int part, int r) const {
    constexpr std::int64_t last = UniformCells::last;
    const int row = part * runs_at_once + r;
    const std::int64_t y = item.cell[1] + row % 3 - 1;
    const std::int64_t z = item.cell[2] + row / 3 - 1;
    if (item.absent || row >= 9 || y < 0 || y > last || z < 0 || z > last) return {};
    const std::int64_t x = item.cell[0];
    return {lower_bound(UniformCells::key_of(x > 0 ? x - 1 : 0, y, z)),
            lower_bound(UniformCells::key_of(x < last ? x + 1 : x, y, z) + 1)};
  }
  SCREE_HD Boxed candidate(std::uint32_t k) const {
    return boxed(bounds[body[k]], body[k], mobility[body[k]]);
  }
  SCREE_HD bool meets(const Boxed& a, int, const Boxed& b) const {
    return a.body() < b.body() && may_collide(a, b);
  }
  SCREE_HD Pair match(const Boxed& a, const Boxed& b) const { return {a.body(), b.body()}; }

 private:
  SCREE_HD std::uint32_t lower_bound(std::uint64_t value) const {
    return static_cast<std::uint32_t>(first_not_under(key.data(), 0, key.size(), value));
  }
};

template <class Space>
class UniformGrid final : public BroadPhase<Space> {
 public:
  ConstView<Pair> find(ConstView<Aabb> bounds, ConstView<Mobility> mobility) override {
    stats_ = {};
    const Census census = take_census<Space>(bounds);
    stats_.levels = census.present > 0 ? 1 : 0;
    UniformCells cells{};
    double longest = 0;
    for (int a = 0; a < 3; ++a) {
      cells.origin[a] = census.lo[a];
      longest = std::max(longest, static_cast<double>(census.hi[a]) - cells.origin[a]);
    }
    // The cells are wider than the largest box by far more than the rounding of a cell's number, and never so
    // narrow that the cells of the domain run out of numbers.
    cells.width =
        std::max({1.001 * census.largest, longest / static_cast<double>(UniformCells::last), 1e-300});
    key_.resize(bounds.size());
    body_.resize(bounds.size());
    parallel::for_each<Space>("broadphase.uniform_grid.keys", bounds.size(),
                              KeyOfBox{cells, bounds, key_.view(), body_.view()});
    parallel::sort_by_key("broadphase.uniform_grid.sort", key_, body_, 3 * UniformCells::bits + 1);
    return pairs_.collect(stats_,
                          FullStencil{bounds.size(), cells, bounds, mobility, key_.view(), body_.view()});
  }
  const BroadPhaseStats& stats() const override { return stats_; }

 private:
  BroadPhaseStats stats_;
  Array<std::uint64_t, Space> key_;
  Array<std::int32_t, Space> body_;
  PairList<Space> pairs_;
};

}  // namespace

template <class Space>
std::unique_ptr<BroadPhase<Space>> make_uniform_grid() {
  return std::make_unique<UniformGrid<Space>>();
}

#define SCREE_INSTANTIATE(Space) template std::unique_ptr<BroadPhase<Space>> make_uniform_grid<Space>();
SCREE_FOR_EACH_SPACE(SCREE_INSTANTIATE)
#undef SCREE_INSTANTIATE

}  // namespace scree
