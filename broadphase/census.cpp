#include "broadphase/census.hpp"

#include "core/error.hpp"
#include "core/parallel.hpp"

#include <sstream>
#include <string>

namespace scree {

namespace {

struct Enumerate {
  ConstView<Aabb> bounds;
  SCREE_HD Census operator()(std::int64_t i) const {
    Census one;
    const Aabb box = bounds[i];
    if (is_absent(box)) return one;
    if (!is_proper(box)) {
      one.first_bad = static_cast<std::int32_t>(i);
      return one;
    }
    float distance = 0;
    for (int a = 0; a < 3; ++a) {
      one.lo[a] = one.hi[a] = static_cast<float>(centre_of(box, a));
      distance = fabsf(one.lo[a]) > distance ? fabsf(one.lo[a]) : distance;
    }
    one.largest = extent_of(box);
    one.present = 1;
    one.extended = one.largest > 0 ? 1 : 0;
    one.size_classes = size_class(one.largest);
    one.distance_classes = size_class(distance);
    return one;
  }
};

struct Merge {
  SCREE_HD Census operator()(Census a, const Census& b) const {
    for (int k = 0; k < 3; ++k) {
      a.lo[k] = b.lo[k] < a.lo[k] ? b.lo[k] : a.lo[k];
      a.hi[k] = b.hi[k] > a.hi[k] ? b.hi[k] : a.hi[k];
    }
    a.largest = b.largest > a.largest ? b.largest : a.largest;
    a.present += b.present;
    a.extended += b.extended;
    a.first_bad = a.first_bad < b.first_bad ? a.first_bad : b.first_bad;
    a.size_classes += b.size_classes;
    a.distance_classes += b.distance_classes;
    return a;
  }
};

struct BinOfBody {
  ConstView<Aabb> bounds;
  std::int32_t first_class;
  SCREE_HD int operator()(std::int64_t i) const {
    const Aabb box = bounds[i];
    return is_absent(box) ? -1 : SizeHistogram::bin_of(extent_of(box), first_class);
  }
};

std::string complaint(std::int32_t body, const Aabb& box) {
  std::ostringstream text;
  text << "the bounds of body " << body << " are not a finite box: from (" << box.lo[0] << ", " << box.lo[1]
       << ", " << box.lo[2] << ") to (" << box.hi[0] << ", " << box.hi[1] << ", " << box.hi[2]
       << ") m; its position, speed or size is too large";
  return text.str();
}

}  // namespace

template <class Space>
Census take_census(ConstView<Aabb> bounds) {
  const Census census = parallel::reduce<Census, Space>("broadphase.initialize.census", bounds.size(),
                                                        Enumerate{bounds}, Census{}, Merge{});
  if (census.first_bad != Census::no_body) {
    Aabb box;
    copy_bytes<Host, Space>(&box, bounds.data() + census.first_bad, sizeof(box));
    throw RunError(complaint(census.first_bad, box));
  }
  return census;
}

template <class Space>
SizeHistogram count_sizes(ConstView<Aabb> bounds, const Census& census) {
  SizeHistogram sizes;
  const std::int64_t mean = census.extended > 0 ? census.size_classes / census.extended : 0;
  sizes.first_class = std::max<std::int32_t>(0, static_cast<std::int32_t>(mean) - SizeHistogram::bins / 2);
  Array<std::uint32_t, Space> counts;
  parallel::histogram<Space>("broadphase.initialize.sizes", bounds.size(),
                             BinOfBody{bounds, sizes.first_class}, SizeHistogram::bins, counts);
  copy_bytes<Host, Space>(sizes.count.data(), counts.data(), sizeof(sizes.count));
  return sizes;
}

#define SCREE_INSTANTIATE(Space)                              \
  template Census take_census<Space>(ConstView<Aabb> bounds); \
  template SizeHistogram count_sizes<Space>(ConstView<Aabb> bounds, const Census& census);
SCREE_FOR_EACH_SPACE(SCREE_INSTANTIATE)
#undef SCREE_INSTANTIATE

}  // namespace scree
