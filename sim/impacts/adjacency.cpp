#include "sim/impacts/adjacency.hpp"

#include "core/parallel.hpp"
#include "core/space_atomic.hpp"

namespace scree {

namespace {

struct CountPairs {
  ConstView<Pair> pairs;
  ConstView<Mobility> mobility;
  View<std::uint32_t> count;
  SCREE_HD void operator()(std::int64_t k) const {
    const auto [i, j] = pairs[k];
    for (const std::int32_t body : {i, j})
      if (mobility[body] == Mobility::free) add(&count[body], 1u);
  }
};

/// Writes each pair into the rows of its free bodies, and counts their counters down to 0 again.
struct FillRows {
  ConstView<Pair> pairs;
  ConstView<Mobility> mobility;
  ConstView<std::int64_t> begin;
  View<std::uint32_t> count;
  View<std::int32_t> row;
  SCREE_HD void operator()(std::int64_t k) const {
    const auto [i, j] = pairs[k];
    for (const std::int32_t body : {i, j}) {
      if (mobility[body] != Mobility::free) continue;
      row[begin[body] + add(&count[body], ~0u) - 1] = static_cast<std::int32_t>(k);
    }
  }
};

constexpr std::int32_t no_pair = -1;

struct PairOfManyPairs {
  ConstView<Pair> pairs;
  AdjacencyView adjacency;
  SCREE_HD std::int32_t operator()(std::int64_t k) const {
    const auto [i, j] = pairs[k];
    return adjacency.has_many_pairs(i) && adjacency.has_many_pairs(j) ? static_cast<std::int32_t>(k)
                                                                      : no_pair;
  }
};

}  // namespace

template <class Space>
void Adjacency<Space>::build(ConstView<Pair> pairs, ConstView<Mobility> mobility) {
  count_.resize(mobility.size());
  parallel::fill("adjacency", count_, 0u);
  parallel::for_each<Space>("adjacency", pairs.size(), CountPairs{pairs, mobility, count_.view()});
  row_.resize(parallel::exclusive_scan("adjacency", count_, begin_));
  parallel::for_each<Space>(
      "adjacency", pairs.size(),
      FillRows{pairs, mobility, std::as_const(begin_).view(), count_.view(), row_.view()});
  parallel::select("adjacency", pairs.size(), PairOfManyPairs{pairs, view()}, no_pair, between_many_);
}

#define SCREE_INSTANTIATE(Space) template class Adjacency<Space>;
SCREE_FOR_EACH_SPACE(SCREE_INSTANTIATE)
#undef SCREE_INSTANTIATE

}  // namespace scree
