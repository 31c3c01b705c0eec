#include "broadphase/brute_force.hpp"

#include "broadphase/census.hpp"
#include "broadphase/pair_list.hpp"

namespace scree {

namespace {

/// Tests body i against all bodies that follow it. Absent boxes are empty and overlap nothing.
struct AllSearch {
  static constexpr const char* label = "broadphase.brute_force";
  using Object = Boxed;
  using Candidate = Boxed;
  struct Item {
    Boxed object;
    std::uint32_t next;
  };

  std::int64_t items;
  ConstView<Aabb> bounds;
  ConstView<Mobility> mobility;
  int parts = 1;

  SCREE_HD Item item(std::int64_t i) const {
    return {candidate(static_cast<std::uint32_t>(i)), static_cast<std::uint32_t>(i) + 1};
  }
  SCREE_HD Run run(const Item& item, int, int r) const {
    return r == 0 ? Run{item.next, static_cast<std::uint32_t>(items)} : Run{};
  }
  SCREE_HD Boxed candidate(std::uint32_t k) const {
    return boxed(bounds[k], static_cast<std::int32_t>(k), mobility[k]);
  }
  SCREE_HD bool meets(const Boxed& a, int, const Boxed& b) const { return may_collide(a, b); }
  SCREE_HD Pair match(const Boxed& a, const Boxed& b) const { return {a.body(), b.body()}; }
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
