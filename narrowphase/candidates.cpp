// A counting sort by the first body, then a sort of each one's few partners.
#include "narrowphase/candidates.hpp"

#include "core/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <utility>

namespace scree {

namespace {

std::atomic_ref<std::int32_t> shared(std::int32_t& count) { return std::atomic_ref<std::int32_t>(count); }

/// What may become a candidate: the pairs of the PCS, then each plane with each body.
struct Source {
  ConstBodyView bodies;
  ConstView<Pair> pcs;
  ConstView<double> margin;
  ConstView<std::int32_t> planes;

  std::int64_t size() const { return pcs.size() + planes.size() * bodies.count(); }

  /// False if the k-th does not.
  bool take(std::int64_t k, Pair& pair) const {
    if (k < pcs.size()) {
      pair = pcs[k];
      return (is_free(pair.i) || is_free(pair.j)) && !is_plane(pair.i) && !is_plane(pair.j);
    }
    const std::int32_t plane = planes[(k - pcs.size()) / bodies.count()];
    const auto body = static_cast<std::int32_t>((k - pcs.size()) % bodies.count());
    if (!is_free(body) || bodies.mobility[plane] == Mobility::absent) return false;
    const Vec3 up = bodies.orientation[plane] * Vec3::UnitZ();
    const double reach =
        bounding_radius(bodies.shape[body], bodies.size[body]) + margin[plane] + margin[body];
    pair = {std::min(plane, body), std::max(plane, body)};
    return up.dot(bodies.position[body] - bodies.position[plane]) <= reach;
  }

 private:
  bool is_plane(std::int32_t k) const { return bodies.shape[k] == Shape::plane; }
  bool is_free(std::int32_t k) const { return bodies.mobility[k] == Mobility::free; }
};

struct CountByFirst {
  Source source;
  View<std::int32_t> counts;
  void operator()(std::int64_t k) const {
    Pair pair;
    if (source.take(k, pair)) ++shared(counts[pair.i]);
  }
};

/// Puts each pair into the range of its first body, in any order.
struct PlaceByFirst {
  Source source;
  ConstView<std::int64_t> offsets;
  View<std::int32_t> counts;
  View<Pair> placed;
  void operator()(std::int64_t k) const {
    Pair pair;
    if (source.take(k, pair)) placed[offsets[pair.i] + --shared(counts[pair.i])] = pair;
  }
};

struct SortBySecond {
  ConstView<std::int64_t> offsets;
  View<Pair> pairs;
  void operator()(std::int64_t i) const {
    std::sort(pairs.data() + offsets[i], pairs.data() + offsets[i + 1],
              [](const Pair& a, const Pair& b) { return a.j < b.j; });
  }
};

}  // namespace

ConstView<Pair> Candidates::list(const ConstBodyView& bodies, ConstView<Pair> pcs, ConstView<double> margin) {
  const std::int64_t n = bodies.count();
  planes_.clear();
  for (std::int32_t k = 0; k < n; ++k) {
    if (bodies.shape[k] == Shape::plane) planes_.push_back(k);
  }
  const Source source{bodies, pcs, margin, {planes_.data(), static_cast<std::int64_t>(planes_.size())}};
  counts_.resize(n);
  parallel::fill("candidates", counts_, 0);
  parallel::for_each<Host>("candidates", source.size(), CountByFirst{source, counts_.view()});
  pairs_.resize(parallel::exclusive_scan<Host>("candidates", counts_, offsets_));
  parallel::for_each<Host>("candidates", source.size(),
                           PlaceByFirst{source, offsets_.view(), counts_.view(), pairs_.view()});
  parallel::for_each<Host>("candidates", n, SortBySecond{offsets_.view(), pairs_.view()});
  return std::as_const(pairs_).view();
}

}  // namespace scree
