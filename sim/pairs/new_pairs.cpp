#include "sim/pairs/new_pairs.hpp"

#include "core/parallel.hpp"

namespace scree {

namespace {

/// Searches for a new pair of one body with the bodies outside. These are few, so no sorting is needed.
struct FindNewPair {
  NearPairs now, then;
  ConstView<BodyOutside> list;
  const std::uint64_t* count;
  std::uint64_t* exists;

  SCREE_HD void operator()(std::int64_t k) const {
    const auto outside = static_cast<std::int64_t>(*count);
    if (outside == 0 || outside > list.size()) return;
    const auto body = static_cast<std::int32_t>(k);
    const Vec3 position = now.bodies.position[k];
    const double around = now.sphere_around(body);
    for (std::int64_t l = 0; l < outside; ++l) {
      const BodyOutside& other = list[l];
      if (are_far_apart(now.bodies.period.nearest(other.position - position), around + other.around))
        continue;
      if (is_new(other.body, body)) raise(exists, std::uint64_t{1});
    }
  }
  SCREE_HD bool is_new(std::int32_t i, std::int32_t j) const {
    if (i == j || !now.may_be_pair(i, j) || !now.spheres_are_near(i, j) || !now.boxes_are_near(i, j))
      return false;
    return !then.spheres_are_near(i, j) || !then.boxes_are_near(i, j);
  }
};

}  // namespace

template <class Space>
BodiesOutside NewPairs<Space>::start() {
  list_.resize(most_outside);
  found_.resize(2);
  parallel::fill("pairs.out", found_, std::uint64_t{0});
  return {list_.view(), found_.data()};
}

template <class Space>
bool NewPairs<Space>::exist(const NearPairs& now, const NearPairs& then) {
  parallel::for_each<Space>(
      "pairs.new pairs", now.bodies.count(),
      FindNewPair{now, then, ConstView<BodyOutside>(list_.view()), found_.data(), found_.data() + 1});
  std::uint64_t found[2];
  copy_bytes<Host, Space>(found, found_.data(), sizeof(found));
  outside_ = static_cast<std::int64_t>(found[0]);
  return outside_ > most_outside || found[1] != 0;
}

#define SCREE_INSTANTIATE(Space) template class NewPairs<Space>;
SCREE_FOR_EACH_SPACE(SCREE_INSTANTIATE)
#undef SCREE_INSTANTIATE

}  // namespace scree
