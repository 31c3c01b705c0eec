#include "bench/broadphase/order.hpp"

#include "broadphase/aabb.hpp"
#include "core/parallel.hpp"

#include <algorithm>

namespace scree::bench {

namespace {

template <class Order>
struct Move {
  Order order;
  ConstView<Aabb> bounds;
  ConstView<Mobility> mobility;
  View<Aabb> to_bounds;
  View<Mobility> to_mobility;
  SCREE_HD void operator()(std::int64_t i) const {
    const std::int64_t k = order(i);
    to_bounds[i] = bounds[k];
    to_mobility[i] = mobility[k];
  }
};

template <class Space, class Order>
void move(const Objects<Space>& from, const Order& order, Objects<Space>& to) {
  to.bounds.resize(from.bounds.size());
  to.mobility.resize(from.mobility.size());
  parallel::for_each<Space>(
      "bench.move", from.bounds.size(),
      Move<Order>{order, from.bounds.view(), from.mobility.view(), to.bounds.view(), to.mobility.view()});
}

struct Listed {
  ConstView<std::int32_t> place;
  SCREE_HD std::int64_t operator()(std::int64_t i) const { return place[i]; }
};

struct PresentExtent {
  ConstView<Aabb> bounds;
  SCREE_HD double operator()(std::int64_t i) const {
    return is_absent(bounds[i]) ? 0.0 : static_cast<double>(extent_of(bounds[i]));
  }
};

struct IsPresent {
  ConstView<Aabb> bounds;
  SCREE_HD std::int64_t operator()(std::int64_t i) const { return is_absent(bounds[i]) ? 0 : 1; }
};

/// Returns the distance of a centre below the origin along an axis (m).
struct Depth {
  ConstView<Aabb> bounds;
  int axis;
  SCREE_HD double operator()(std::int64_t i) const {
    return is_absent(bounds[i]) ? -HUGE_VAL : -centre_of(bounds[i], axis);
  }
};

struct RowKey {
  static constexpr int bits = 21;

  ConstView<Aabb> bounds;
  double lowest[3];
  double width;
  View<std::uint64_t> key;
  View<std::int32_t> place;
  SCREE_HD void operator()(std::int64_t i) const {
    place[i] = static_cast<std::int32_t>(i);
    key[i] = std::uint64_t{1} << (3 * bits);
    if (is_absent(bounds[i])) return;
    key[i] = (number(i, 2) << bits | number(i, 1)) << bits | number(i, 0);
  }
  SCREE_HD std::uint64_t number(std::int64_t i, int axis) const {
    constexpr double last = (1 << bits) - 1;
    return static_cast<std::uint64_t>(fmin((centre_of(bounds[i], axis) - lowest[axis]) / width, last));
  }
};

}  // namespace

template <class Space>
void permute(const Objects<Space>& from, const Permutation& permutation, Objects<Space>& to) {
  move(from, permutation, to);
}

template <class Space>
void sort_into_rows(const Objects<Space>& from, Objects<Space>& to) {
  const std::int64_t n = from.bounds.size();
  const ConstView<Aabb> bounds = from.bounds.view();
  Array<std::uint64_t, Space> key(n);
  Array<std::int32_t, Space> place(n);
  RowKey make_key{bounds, {}, 0, key.view(), place.view()};
  const std::int64_t present = parallel::sum<std::int64_t, Space>("bench.present", n, IsPresent{bounds});
  const double extents = parallel::sum<double, Space>("bench.extents", n, PresentExtent{bounds});
  // If all objects are points, any width will do.
  make_key.width = extents > 0 ? extents / static_cast<double>(present) : 1.0;
  for (int a = 0; a < 3; ++a)
    make_key.lowest[a] = -parallel::max<double, Space>("bench.lowest", n, Depth{bounds, a}, -HUGE_VAL);
  parallel::for_each<Space>("bench.keys", n, make_key);
  parallel::sort_by_key("bench.sort", key, place, 3 * RowKey::bits + 1);
  move(from, Listed{place.view()}, to);
}

#define SCREE_INSTANTIATE(Space)                                                            \
  template void permute<Space>(const Objects<Space>&, const Permutation&, Objects<Space>&); \
  template void sort_into_rows<Space>(const Objects<Space>&, Objects<Space>&);
SCREE_FOR_EACH_SPACE(SCREE_INSTANTIATE)
#undef SCREE_INSTANTIATE

}  // namespace scree::bench
