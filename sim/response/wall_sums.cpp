#include "sim/response/wall_sums.hpp"

#include "core/parallel.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace scree::solver {

namespace {

constexpr std::int64_t together = 32;  // largest number of entries in a group

SCREE_HD bool is_wall(ConstView<Mobility> mobility, std::int32_t body) {
  return mobility[body] != Mobility::free;
}

/// Returns the index of the first number in a sorted list that is not below `wanted`.
SCREE_HD std::int64_t first_not_below(ConstView<std::int32_t> sorted, std::int32_t wanted) {
  std::int64_t low = 0, high = sorted.size();
  while (low < high) {
    const std::int64_t middle = (low + high) / 2;
    if (sorted[middle] < wanted) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low;
}

struct IsOnWall {
  static constexpr std::uint32_t none = 0xffffffffu;
  ConstView<Slot> places;
  ConstView<Mobility> mobility;
  SCREE_HD std::uint32_t operator()(std::int64_t place) const {
    const Slot& slot = places[place];
    const bool found = slot.i != Slot::empty && (is_wall(mobility, slot.i) || is_wall(mobility, slot.j));
    return found ? static_cast<std::uint32_t>(place) : none;
  }
};

struct NameWall {
  ConstView<Slot> places;
  ConstView<Mobility> mobility;
  ConstView<std::uint32_t> place;
  View<std::uint32_t> body;
  SCREE_HD void operator()(std::int64_t e) const {
    const Slot& slot = places[place[e]];
    body[e] = static_cast<std::uint32_t>(is_wall(mobility, slot.i) ? slot.i : slot.j);
  }
};

struct NumberPlaces {
  ConstView<std::uint32_t> place, key;
  View<std::int32_t> entry_of, body;
  SCREE_HD void operator()(std::int64_t e) const {
    entry_of[place[e]] = static_cast<std::int32_t>(e);
    body[e] = static_cast<std::int32_t>(key[e]);
  }
};

/// Marks the entries with which groups begin: the first entry of each body, and then every `together`-th
/// entry of that body.
struct MarkGroups {
  ConstView<std::int32_t> body;
  View<std::uint8_t> marks;
  SCREE_HD void operator()(std::int64_t e) const {
    marks[e] = (e - first_not_below(body, body[e])) % together == 0 ? 1 : 0;
  }
};

struct ListGroups {
  ConstView<std::int32_t> body;
  ConstView<std::int64_t> number;
  View<std::int64_t> begin;
  View<std::int32_t> group_body;
  SCREE_HD void operator()(std::int64_t e) const {
    if (e + 1 == number.size()) {
      begin[number[e]] = e;
    } else if (number[e] < number[e + 1]) {
      begin[number[e]] = e;
      group_body[number[e]] = body[e];
    }
  }
};

/// Returns impulses as a list of their numbers. Threads that work on neighbouring numbers use memory better
/// than threads that work on neighbouring impulses.
View<double> numbers_of(View<WallImpulse> impulses) {
  static_assert(sizeof(WallImpulse) == WallImpulse::numbers * sizeof(double));
  return {reinterpret_cast<double*>(impulses.data()), WallImpulse::numbers * impulses.size()};
}

/// Adds up one number of a group.
struct AddGroup {
  ConstView<std::int64_t> begin;
  ConstView<double> below;
  View<double> sums;
  SCREE_HD void operator()(std::int64_t item) const {
    constexpr std::int64_t numbers = WallImpulse::numbers;
    const std::int64_t g = item / numbers;
    double sum = 0;
    for (std::int64_t e = begin[g]; e < begin[g + 1]; ++e) sum += below[numbers * e + item % numbers];
    sums[item] = sum;
  }
};

struct AddToTotal {
  ConstView<std::int32_t> walls;
  ConstView<std::int32_t> body;
  ConstView<WallImpulse> sums;
  View<WallImpulse> totals;
  SCREE_HD void operator()(std::int64_t g) const {
    WallImpulse& total = totals[first_not_below(walls, body[g])];
    total = total + sums[g];
  }
};

/// Returns the place of a body that is not free; `none` for a free one.
struct PlaceOfWall {
  static constexpr std::int32_t none = -1;
  ConstView<Mobility> mobility;
  SCREE_HD std::int32_t operator()(std::int64_t body) const {
    return is_wall(mobility, static_cast<std::int32_t>(body)) ? static_cast<std::int32_t>(body) : none;
  }
};

}  // namespace

template <class Space>
void WallSums<Space>::take(ConstView<Slot> places, const ConstBodyView& bodies) {
  impulses_.resize(0);
  used_levels_ = 0;
  if (walls_.empty()) return;
  Array<std::uint32_t, Space> place, key;
  parallel::select("walls.list", places.size(), IsOnWall{places, bodies.mobility}, IsOnWall::none, place);
  const std::int64_t n = place.size();
  if (n == 0) return;
  impulses_.resize(n);
  body_.resize(n);
  key.resize(n);
  parallel::for_each<Space>("walls.list", n,
                            NameWall{places, bodies.mobility, std::as_const(place).view(), key.view()});
  parallel::sort_by_key("walls.list", key, place, std::bit_width(static_cast<std::uint64_t>(bodies.count())));
  entry_of_.resize(places.size());
  parallel::fill("walls.list", entry_of_, -1);
  parallel::for_each<Space>(
      "walls.list", n,
      NumberPlaces{std::as_const(place).view(), std::as_const(key).view(), entry_of_.view(), body_.view()});
  Array<std::uint8_t, Space> marks;
  Array<std::int64_t, Space> number;
  const Array<std::int32_t, Space>* below = &body_;
  for (;;) {
    if (used_levels_ == levels_.size()) levels_.emplace_back();
    marks.resize(below->size());
    parallel::for_each<Space>("walls.groups", marks.size(), MarkGroups{below->view(), marks.view()});
    const std::int64_t groups = parallel::exclusive_scan("walls.groups", marks, number);
    if (groups == below->size() && used_levels_ > 0) return;
    Level& level = levels_[used_levels_++];
    level.begin.resize(groups + 1);
    level.body.resize(groups);
    level.sums.resize(groups);
    parallel::for_each<Space>(
        "walls.groups", below->size() + 1,
        ListGroups{below->view(), std::as_const(number).view(), level.begin.view(), level.body.view()});
    below = &level.body;
  }
}

template <class Space>
void WallSums<Space>::list_walls(ConstView<Mobility> mobility) {
  parallel::select("walls.list", mobility.size(), PlaceOfWall{mobility}, PlaceOfWall::none, walls_);
  walls_on_host_ = to_vector(walls_);
  totals_.resize(walls_.size());
  start_step();
}

template <class Space>
void WallSums<Space>::start_step() {
  parallel::fill("walls.clear", totals_, WallImpulse{});
}

template <class Space>
WallImpulse WallSums<Space>::total_of(std::int32_t place) const {
  WallImpulse total;
  const auto at = std::ranges::lower_bound(walls_on_host_, place);
  if (at == walls_on_host_.end() || *at != place) return total;
  copy_bytes<Host, Space>(&total, totals_.data() + (at - walls_on_host_.begin()), sizeof(total));
  return total;
}

template <class Space>
std::vector<WallImpulse> WallSums<Space>::totals_by_place(std::int64_t bodies) const {
  std::vector<WallImpulse> all(static_cast<std::size_t>(bodies));
  const std::vector<WallImpulse> totals = to_vector(totals_);
  for (std::size_t w = 0; w < totals.size(); ++w)
    all[static_cast<std::size_t>(walls_on_host_[w])] = totals[w];
  return all;
}

template <class Space>
View<WallImpulse> WallSums<Space>::clear_impulses() {
  parallel::fill<Space>("walls.clear", numbers_of(impulses_.view()), 0.0);
  return impulses_.view();
}

template <class Space>
void WallSums<Space>::add_up() {
  if (used_levels_ == 0) return;
  View<WallImpulse> below = impulses_.view();
  for (std::size_t l = 0; l < used_levels_; ++l) {
    Level& level = levels_[l];
    const View<double> sums = numbers_of(level.sums.view());
    parallel::for_each<Space>("walls.sums", sums.size(),
                              AddGroup{std::as_const(level.begin).view(), numbers_of(below), sums});
    below = level.sums.view();
  }
  const Level& last = levels_[used_levels_ - 1];
  parallel::for_each<Space>(
      "walls.sums", last.body.size(),
      AddToTotal{std::as_const(walls_).view(), last.body.view(), below, totals_.view()});
}

#define SCREE_INSTANTIATE(Space) template class WallSums<Space>;
SCREE_FOR_EACH_SPACE(SCREE_INSTANTIATE)

}  // namespace scree::solver
