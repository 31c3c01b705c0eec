#include "broadphase/brute_force.hpp"

#include "broadphase/census.hpp"
#include "broadphase/pair_list.hpp"

namespace scree {

namespace {

/// Body i against all that follow it. Absent boxes are empty and overlap nothing.
struct AllSearch {
  static constexpr const char* count_label = "broadphase.brute_force.count";
  static constexpr const char* fill_label = "broadphase.brute_force.fill";

  std::int64_t items;
  ConstView<Aabb> bounds;
  ConstView<Mobility> mobility;

  template <class Hit>
  SCREE_HD std::uint32_t operator()(std::int64_t i, Hit& hit) const {
    const Aabb box = bounds[i];
    const bool fixed = mobility[i] == Mobility::fixed;
    for (std::int64_t j = i + 1; j < items; ++j) {
      if (overlap(box, bounds[j]) && !(fixed && mobility[j] == Mobility::fixed)) {
        hit({static_cast<std::int32_t>(i), static_cast<std::int32_t>(j)});
      }
    }
    return static_cast<std::uint32_t>(items - i - 1);
  }
};

template <class Space>
class BruteForce final : public BroadPhase<Space> {
 public:
  ConstView<Pair> find(ConstView<Aabb> bounds, ConstView<Mobility> mobility) override {
    stats_ = {};
    take_census<Space>(bounds);
    return pairs_.collect(stats_, AllSearch{bounds.size(), bounds, mobility});
  }
  const BroadPhaseStats& stats() const override { return stats_; }

 private:
  BroadPhaseStats stats_;
  PairList<Space> pairs_;
};

}  // namespace

template <class Space>
std::unique_ptr<BroadPhase<Space>> make_brute_force() {
  return std::make_unique<BruteForce<Space>>();
}

#define SCREE_INSTANTIATE(Space) template std::unique_ptr<BroadPhase<Space>> make_brute_force<Space>();
SCREE_FOR_EACH_SPACE(SCREE_INSTANTIATE)
#undef SCREE_INSTANTIATE

}  // namespace scree
