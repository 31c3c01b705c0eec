#include "broadphase/periodic_images.hpp"

#include "broadphase/aabb.hpp"
#include "broadphase/bounds.hpp"
#include "core/parallel.hpp"

#include <limits>
#include <utility>

namespace scree {

namespace {

constexpr std::uint64_t no_pair = std::numeric_limits<std::uint64_t>::max();

/// Returns a box moved up by a period along some of the axes, rounded outward.
SCREE_HD Aabb moved_up(const Aabb& box, unsigned axes, const Period& period) {
  Aabb moved = box;
  for (int a = 0; a < 3; ++a) {
    if ((axes >> a & 1) == 0) continue;
    moved.lo[a] = round_down(static_cast<double>(box.lo[a]) + period.length[a]);
    moved.hi[a] = round_up(static_cast<double>(box.hi[a]) + period.length[a]);
  }
  return moved;
}

/// Returns the upper end of a box along an axis. That of an absent box is -infinity, so that it counts for no
/// maximum.
struct UpperEnd {
  ConstView<Aabb> bounds;
  int axis;
  SCREE_HD float operator()(std::int64_t k) const { return bounds[k].hi[axis]; }
};

struct CountImages {
  ConstView<Aabb> bounds;
  Period period;
  float highest[3];
  View<std::uint8_t> reach;
  View<std::int32_t> count;
  SCREE_HD void operator()(std::int64_t k) const {
    unsigned axes = 0;
    if (!is_absent(bounds[k])) {
      for (int a = 0; a < 3; ++a) {
        const bool meets = period.is_along(a) && moved_up(bounds[k], 1u << a, period).lo[a] <= highest[a];
        axes |= meets ? 1u << a : 0u;
      }
    }
    reach[k] = static_cast<std::uint8_t>(axes);
    const unsigned many = (axes & 1u) + (axes >> 1 & 1u) + (axes >> 2 & 1u);
    count[k] = (1 << many) - 1;
  }
};

struct PutBoxes {
  ConstView<Aabb> of_bodies;
  ConstView<Mobility> mobility_of_bodies;
  Period period;
  ConstView<std::uint8_t> reach;
  ConstView<std::int64_t> first;
  View<Aabb> bounds;
  View<Mobility> mobility;
  View<std::int32_t> owner;
  View<std::uint8_t> shift;

  SCREE_HD void operator()(std::int64_t k) const {
    put(k, k, 0);
    std::int64_t next = of_bodies.size() + first[k];
    // This loop visits each nonempty subset of the axes.
    const unsigned all = reach[k];
    for (unsigned axes = all; axes != 0; axes = (axes - 1) & all) put(next++, k, axes);
  }
  SCREE_HD void put(std::int64_t to, std::int64_t body, unsigned axes) const {
    bounds[to] = axes == 0 ? of_bodies[body] : moved_up(of_bodies[body], axes, period);
    mobility[to] = mobility_of_bodies[body];
    owner[to] = static_cast<std::int32_t>(body);
    shift[to] = static_cast<std::uint8_t>(axes);
  }
};

/// Returns the two bodies of a pair of boxes as a number, or no_pair if the pair does not count.
struct KeyOfPair {
  ConstView<Pair> found;
  ConstView<std::int32_t> owner;
  ConstView<std::uint8_t> shift;
  SCREE_HD std::uint64_t operator()(std::int64_t k) const {
    const auto [a, b] = found[k];
    if ((shift[a] & shift[b]) != 0 || owner[a] == owner[b]) return no_pair;
    const Pair pair = pair_of(owner[a], owner[b]);
    return static_cast<std::uint64_t>(pair.i) << 32 | static_cast<std::uint64_t>(pair.j);
  }
};

struct PairOfKey {
  ConstView<std::uint64_t> keys;
  View<Pair> pairs;
  SCREE_HD void operator()(std::int64_t k) const {
    pairs[k] = {static_cast<std::int32_t>(keys[k] >> 32), static_cast<std::int32_t>(keys[k] & 0xffffffffu)};
  }
};

}  // namespace

template <class Space>
void PeriodicImages<Space>::take(ConstView<Aabb> bounds, ConstView<Mobility> mobility, const Period& period) {
  const std::int64_t n = bounds.size();
  reach_.resize(n);
  count_.resize(n);
  CountImages count{bounds, period, {}, reach_.view(), count_.view()};
  for (int a = 0; a < 3; ++a) {
    constexpr float lowest = -std::numeric_limits<float>::infinity();
    count.highest[a] = period.is_along(a)
                           ? parallel::max<float, Space>("broadphase.images", n, UpperEnd{bounds, a}, lowest)
                           : lowest;
  }
  parallel::for_each<Space>("broadphase.images", n, count);
  const std::int64_t images = parallel::exclusive_scan("broadphase.images", count_, first_);
  bounds_.resize(n + images);
  mobility_.resize(n + images);
  owner_.resize(n + images);
  shift_.resize(n + images);
  parallel::for_each<Space>(
      "broadphase.images", n,
      PutBoxes{bounds, mobility, period, std::as_const(reach_).view(), std::as_const(first_).view(),
               bounds_.view(), mobility_.view(), owner_.view(), shift_.view()});
}

template <class Space>
ConstView<Pair> PeriodicImages<Space>::pairs_of(ConstView<Pair> found) {
  parallel::select("broadphase.images", found.size(),
                   KeyOfPair{found, std::as_const(owner_).view(), std::as_const(shift_).view()}, no_pair,
                   keys_);
  pairs_.resize(keys_.size());
  parallel::for_each<Space>("broadphase.images", keys_.size(),
                            PairOfKey{std::as_const(keys_).view(), pairs_.view()});
  return std::as_const(pairs_).view();
}

#define SCREE_INSTANTIATE(Space) template class PeriodicImages<Space>;
SCREE_FOR_EACH_SPACE(SCREE_INSTANTIATE)
#undef SCREE_INSTANTIATE

}  // namespace scree
