// Each pair is a number that orders it; those of the candidates are sorted.
#include "narrowphase/candidates.hpp"

#include "core/parallel.hpp"
#include "narrowphase/far_apart.hpp"

#include <bit>
#include <cmath>
#include <limits>
#include <utility>

namespace scree {

namespace {

constexpr std::int32_t no_plane = -1;
constexpr std::uint64_t no_key = std::numeric_limits<std::uint64_t>::max();

struct PlaneNumber {
  ConstView<Shape> shape;
  SCREE_HD std::int32_t operator()(std::int64_t k) const {
    return shape[k] == Shape::plane ? static_cast<std::int32_t>(k) : no_plane;
  }
};

/// A pair as a number, whose order is that of the places (i, j), i < j.
struct PairKey {
  int bits;  // of a body's place
  SCREE_HD std::uint64_t of(std::int32_t i, std::int32_t j) const {
    return (static_cast<std::uint64_t>(i) << bits) | static_cast<std::uint64_t>(j);
  }
  SCREE_HD Pair pair_of(std::uint64_t key) const {
    return {static_cast<std::int32_t>(key >> bits),
            static_cast<std::int32_t>(key & ((std::uint64_t{1} << bits) - 1))};
  }
};

/// Keys of what may become a candidate: the pairs of the PCS, then each plane with each body. `no_key` for
/// what does not.
struct CandidateKey {
  ConstBodyView bodies;
  ConstView<Pair> pcs;
  ConstView<double> margin;
  ConstView<std::int32_t> planes;
  PairKey key;

  SCREE_HD std::int64_t size() const { return pcs.size() + planes.size() * bodies.mobility.size(); }

  SCREE_HD std::uint64_t operator()(std::int64_t k) const {
    if (k < pcs.size()) return of_pair(pcs[k]);
    const std::int64_t n = bodies.mobility.size();
    return of_plane(planes[(k - pcs.size()) / n], static_cast<std::int32_t>((k - pcs.size()) % n));
  }

 private:
  SCREE_HD std::uint64_t of_pair(const Pair& pair) const {
    const bool taken = (is_free(pair.i) || is_free(pair.j)) && !is_plane(pair.i) && !is_plane(pair.j);
    return taken && !are_far(pair.i, pair.j) ? key.of(pair.i, pair.j) : no_key;
  }
  SCREE_HD std::uint64_t of_plane(std::int32_t plane, std::int32_t body) const {
    if (!is_free(body) || bodies.mobility[plane] == Mobility::absent) return no_key;
    const Vec3 up = bodies.orientation[plane] * Vec3::UnitZ();
    const double reach =
        bounding_radius(bodies.shape[body], bodies.size[body]) + margin[plane] + margin[body];
    if (!(up.dot(bodies.position[body] - bodies.position[plane]) <= reach)) return no_key;
    return plane < body ? key.of(plane, body) : key.of(body, plane);
  }
  /// Spheres are in half of their boxes' volume: of a packing's pairs it takes two of five.
  SCREE_HD bool are_far(std::int32_t i, std::int32_t j) const {
    if (is_boundary(bodies.shape[i])) return is_within(i, j, reach(j) + margin[i]);
    if (is_boundary(bodies.shape[j])) return is_within(j, i, reach(i) + margin[j]);
    return are_far_apart(bodies.period.nearest(bodies.position[j] - bodies.position[i]), reach(i) + reach(j));
  }
  SCREE_HD double reach(std::int32_t k) const {
    return bounding_radius(bodies.shape[k], bodies.size[k]) + margin[k];
  }
  /// Whether a body is within a tube, and farther than `reach` (m) from its wall and its caps.
  SCREE_HD bool is_within(std::int32_t tube, std::int32_t body, double reach) const {
    const Vec3 up = bodies.orientation[tube] * Vec3::UnitZ();
    const Vec3 from = bodies.position[body] - bodies.position[tube];
    const double along = up.dot(from);
    const double across = (from - along * up).norm();
    const Vec3& size = bodies.size[tube];
    const double rounding = tolerance::far_rounding * (size.x() + size.z());
    return across + reach + rounding < size.x() && fabs(along) + reach + rounding < size.z();
  }
  SCREE_HD bool is_plane(std::int32_t k) const { return bodies.shape[k] == Shape::plane; }
  SCREE_HD bool is_free(std::int32_t k) const { return bodies.mobility[k] == Mobility::free; }
};

struct TakePair {
  PairKey key;
  ConstView<std::uint64_t> keys;
  ConstView<BodyNumber> number;
  View<Pair> pairs;
  SCREE_HD void operator()(std::int64_t k) const {
    const Pair pair = key.pair_of(keys[k]);
    pairs[k] = number[pair.i] < number[pair.j] ? pair : Pair{pair.j, pair.i};
  }
};

}  // namespace

template <class Space>
ConstView<Pair> Candidates<Space>::list(const ConstBodyView& bodies, ConstView<Pair> pcs,
                                        ConstView<double> margin) {
  const PairKey key{static_cast<int>(std::bit_width(static_cast<std::uint64_t>(bodies.count())))};
  parallel::select("candidates", bodies.count(), PlaneNumber{bodies.shape}, no_plane, planes_);
  const CandidateKey candidate{bodies, pcs, margin, std::as_const(planes_).view(), key};
  parallel::select("candidates", candidate.size(), candidate, no_key, keys_);
  parallel::sort("candidates", keys_, 2 * key.bits);
  pairs_.resize(keys_.size());
  parallel::for_each<Space>("candidates", keys_.size(),
                            TakePair{key, std::as_const(keys_).view(), bodies.id, pairs_.view()});
  return std::as_const(pairs_).view();
}

#define SCREE_INSTANTIATE(Space) template class Candidates<Space>;
SCREE_FOR_EACH_SPACE(SCREE_INSTANTIATE)
#undef SCREE_INSTANTIATE

}  // namespace scree
