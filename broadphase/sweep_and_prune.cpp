#include "broadphase/sweep_and_prune.hpp"

#include "broadphase/census.hpp"
#include "broadphase/centre_scale.hpp"
#include "broadphase/pair_list.hpp"
#include "broadphase/sorted_keys.hpp"

#include <algorithm>

namespace scree {

namespace {

/// Sums over the centres of their numbers, counted from the middle, and of the squares of these numbers.
struct Moments {
  double first[3] = {0, 0, 0};
  double second[3] = {0, 0, 0};

  SCREE_HD Moments operator+(const Moments& other) const {
    Moments sum = *this;
    for (int a = 0; a < 3; ++a) {
      sum.first[a] += other.first[a];
      sum.second[a] += other.second[a];
    }
    return sum;
  }
};

struct MomentsOfBox {
  CentreScale scale;
  ConstView<Aabb> bounds;
  SCREE_HD Moments operator()(std::int64_t i) const {
    Moments moments;
    const Aabb box = bounds[i];
    for (int a = 0; a < 3 && !is_absent(box); ++a) {
      const double x = scale.number(centre_of(box, a)) - 0x1p20;
      moments.first[a] = x;
      moments.second[a] = x * x;
    }
    return moments;
  }
};

/// Returns the axis along which the centres vary most (Ericson 2005, Real-Time Collision Detection, section
/// 7.5.2), on a scale on which outliers count for little.
template <class Space>
int sweep_axis(ConstView<Aabb> bounds, const Census& census) {
  const auto sums = parallel::sum<Moments, Space>("broadphase.sweep_and_prune.axis", bounds.size(),
                                                  MomentsOfBox{CentreScale(census), bounds});
  double variance[3];
  for (int a = 0; a < 3; ++a) {
    const double mean = sums.first[a] / census.present;
    variance[a] = sums.second[a] / census.present - mean * mean;
  }
  return static_cast<int>(std::max_element(variance, variance + 3) - variance);
}

/// Sets the key by which an object is sorted. An absent object begins at infinity, so that it comes after all
/// others.
struct KeyOfBegin {
  ConstView<Aabb> bounds;
  int axis;
  View<std::uint32_t> key;
  View<std::int32_t> body;
  SCREE_HD void operator()(std::int64_t i) const {
    key[i] = ordered_bits(bounds[i].lo[axis]);
    body[i] = static_cast<std::int32_t>(i);
  }
};

struct GatherBoxed {
  ConstView<Aabb> bounds;
  ConstView<Mobility> mobility;
  ConstView<std::int32_t> body;
  View<Boxed> sorted;
  SCREE_HD void operator()(std::int64_t k) const {
    sorted[k] = boxed(bounds[body[k]], body[k], mobility[body[k]]);
  }
};

/// Tests each object against the objects that begin with it or after it, and not after its end.
struct SweepSearch : RunSearch {
  static constexpr const char* label = "broadphase.sweep_and_prune.search";

  int axis;
  const std::uint32_t* key;

  SCREE_HD Item item(std::int64_t k) const {
    const std::int64_t end = first_not_under(key, k, items, ordered_bits(sorted[k].hi.at[axis]) + 1);
    return {sorted[k], {static_cast<std::uint32_t>(k) + 1, static_cast<std::uint32_t>(end)}};
  }
};

template <class Space>
class SweepAndPrune final : public BroadPhase<Space> {
 public:
  ConstView<Pair> find(ConstView<Aabb> bounds, ConstView<Mobility> mobility) override {
    stats_ = {};
    const Census census = take_census<Space>(bounds);
    if (census.present == 0) return {};
    const int axis = sweep_axis<Space>(bounds, census);
    key_.resize(bounds.size());
    body_.resize(bounds.size());
    sorted_.resize(census.present);
    parallel::for_each<Space>("broadphase.sweep_and_prune.keys", bounds.size(),
                              KeyOfBegin{bounds, axis, key_.view(), body_.view()});
    parallel::sort_by_key("broadphase.sweep_and_prune.sort", key_, body_);
    parallel::for_each<Space>("broadphase.sweep_and_prune.gather", sorted_.size(),
                              GatherBoxed{bounds, mobility, body_.view(), sorted_.view()});
    return pairs_.collect(stats_, SweepSearch{{sorted_.size(), sorted_.data()}, axis, key_.data()});
  }
  const BroadPhaseStats& stats() const override { return stats_; }

 private:
  BroadPhaseStats stats_;
  Array<std::uint32_t, Space> key_;  ///< begin of each object, as a key
  Array<std::int32_t, Space> body_;
  Array<Boxed, Space> sorted_;
  PairList<Space> pairs_;
};

}  // namespace

template <class Space>
std::unique_ptr<BroadPhase<Space>> make_sweep_and_prune() {
  return std::make_unique<SweepAndPrune<Space>>();
}

#define SCREE_INSTANTIATE(Space) template std::unique_ptr<BroadPhase<Space>> make_sweep_and_prune<Space>();
SCREE_FOR_EACH_SPACE(SCREE_INSTANTIATE)
#undef SCREE_INSTANTIATE

}  // namespace scree
