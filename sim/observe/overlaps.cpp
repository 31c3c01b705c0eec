#include "sim/observe/overlaps.hpp"

#include "core/parallel.hpp"
#include "core/space_tiles.hpp"
#include "narrowphase/any_contacts.hpp"

#include <cmath>
#include <cstdint>
#include <cstring>

namespace scree {

namespace {

struct Depths {
  double sum = 0, relative_sum = 0;
  double max = 0, relative_max = 0;
  std::int64_t count = 0;
  std::int64_t deepest = -1;  ///< index of the first pair with relative_max
  SCREE_HD friend Depths operator+(const Depths& a, const Depths& b) {
    const Depths& deeper = b.relative_max > a.relative_max ? b : a;
    return {a.sum + b.sum,      a.relative_sum + b.relative_sum,
            fmax(a.max, b.max), deeper.relative_max,
            a.count + b.count,  deeper.deepest};
  }
};

/// Measures one pair. Its depth is kept, if there is room, as bits: the bits of numbers that are not negative
/// have the same order as the numbers.
struct MeasurePair {
  ConstBodyView bodies;
  ConstView<ShapeData> shapes;
  ConstView<Pair> pairs;
  View<std::uint64_t> bits;

  SCREE_HD Depths operator()(std::int64_t k) const {
    const Pair& pair = pairs[k];
    const double depth = depth_of(pair);
    if (bits.size() > 0) std::memcpy(&bits[k], &depth, sizeof(depth));
    if (!(depth > 0)) return {};
    const double size = fmin(smallest_size(bodies.shape[pair.i], bodies.size[pair.i]),
                             smallest_size(bodies.shape[pair.j], bodies.size[pair.j]));
    return {depth, depth / size, depth, depth / size, 1, k};
  }
  SCREE_HD double depth_of(const Pair& pair) const {
    const Shape a = bodies.shape[pair.i], b = bodies.shape[pair.j];
    const Vec3 offset = bodies.period.nearest(bodies.position[pair.j] - bodies.position[pair.i]);
    if (a == Shape::sphere && b == Shape::sphere) {
      return fmax(0.0, bodies.size[pair.i].x() + bodies.size[pair.j].x() - offset.norm());
    }
    if (!is_boundary(a) && !is_boundary(b)) {
      const double reach = bounding_radius(a, bodies.size[pair.i]) + bounding_radius(b, bodies.size[pair.j]);
      if (offset.squaredNorm() > reach * reach) return 0;
    }
    Manifold found[max_pair_manifolds];
    Solid of_j = solid(pair.j);
    bodies.period.bring_near(bodies.position[pair.i], of_j.position);
    const int count =
        find_any_contacts({a, solid(pair.i)}, {b, of_j}, {data(pair.i), data(pair.j)}, {.margin = 0}, found);
    double depth = 0;
    for (int m = 0; m < count; ++m)
      for (int p = 0; p < found[m].count; ++p) depth = fmax(depth, -found[m].points[p].gap);
    return depth;
  }
  SCREE_HD const ShapeData* data(std::int32_t k) const { return shapes.size() > 0 ? &shapes[k] : nullptr; }
  SCREE_HD Solid solid(std::int32_t k) const {
    return {bodies.position[k], bodies.orientation[k], bodies.size[k]};
  }
};

}  // namespace

template <class Space>
Penetration measure_overlaps(const ConstBodyView& bodies, ConstView<ShapeData> shapes,
                             ConstView<Pair> candidates, Quantiles quantiles) {
  Array<std::uint64_t, Space> bits(quantiles == Quantiles::p99 ? candidates.size() : 0);
  Array<Depths, Space> scratch, total(1);
  parallel::sum_into<Depths, Space>("overlaps", candidates.size(),
                                    MeasurePair{bodies, shapes, candidates, bits.view()}, scratch,
                                    total.data());
  Depths depths;
  copy_bytes<Host, Space>(&depths, total.data(), sizeof(depths));
  Penetration out;
  if (depths.count == 0) return out;
  const auto n = static_cast<double>(depths.count);
  out.max = depths.max;
  out.relative_max = depths.relative_max;
  out.mean = depths.sum / n;
  out.relative_mean = depths.relative_sum / n;
  Pair pair;
  copy_bytes<Host, Space>(&pair, candidates.data() + depths.deepest, sizeof(pair));
  copy_bytes<Host, Space>(&out.deepest[0], bodies.id.data() + pair.i, sizeof(std::int32_t));
  copy_bytes<Host, Space>(&out.deepest[1], bodies.id.data() + pair.j, sizeof(std::int32_t));
  if (quantiles == Quantiles::none) {
    out.p99 = Penetration::unknown().p99;
    return out;
  }
  // p99 is the smallest depth that at least 99 % of the overlapping pairs do not exceed. Pairs without
  // overlap come first.
  Array<std::uint8_t, Space> nothing(candidates.size());
  parallel::sort_by_key("overlaps.sort", bits, nothing);
  const std::int64_t rank =
      candidates.size() - depths.count + static_cast<std::int64_t>(std::ceil(0.99 * n)) - 1;
  copy_bytes<Host, Space>(&out.p99, bits.data() + rank, sizeof(out.p99));
  return out;
}

#define SCREE_INSTANTIATE(Space)                                                                            \
  template Penetration measure_overlaps<Space>(const ConstBodyView&, ConstView<ShapeData>, ConstView<Pair>, \
                                               Quantiles);
SCREE_FOR_EACH_SPACE(SCREE_INSTANTIATE)

}  // namespace scree
