// The list of candidate pairs. Each pair is encoded as a number (key) that orders it; the keys of the
// candidates are sorted.
#include "narrowphase/candidates.hpp"

#include "core/parallel.hpp"

#include <bit>
#include <cstdint>
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

/// Encodes a pair as a number. Numbers have the order of the places (i, j), i < j.
struct PairKey {
  int bits;  // number of bits of a body's place
  SCREE_HD std::uint64_t of(std::int32_t i, std::int32_t j) const {
    return (static_cast<std::uint64_t>(i) << bits) | static_cast<std::uint64_t>(j);
  }
  SCREE_HD Pair pair_of(std::uint64_t key) const {
    return {static_cast<std::int32_t>(key >> bits),
            static_cast<std::int32_t>(key & ((std::uint64_t{1} << bits) - 1))};
  }
};

/// Returns the keys of all pairs that may become candidates: first the pairs of the PCS, then each plane with
/// each body. The key of a pair that is no candidate is `no_key`.
struct CandidateKey {
  NearPairs near;
  ConstView<Pair> pcs;
  ConstView<std::int32_t> planes;
  PairKey key;

  SCREE_HD std::int64_t size() const { return pcs.size() + planes.size() * near.bodies.mobility.size(); }

  SCREE_HD std::uint64_t operator()(std::int64_t k) const {
    if (k < pcs.size()) return of_pair(pcs[k]);
    const std::int64_t n = near.bodies.mobility.size();
    return of_plane(planes[(k - pcs.size()) / n], static_cast<std::int32_t>((k - pcs.size()) % n));
  }

 private:
  SCREE_HD std::uint64_t of_pair(const Pair& pair) const {
    const bool taken =
        (near.is_free(pair.i) || near.is_free(pair.j)) && !near.is_plane(pair.i) && !near.is_plane(pair.j);
    return taken && near.spheres_are_near(pair.i, pair.j) ? key.of(pair.i, pair.j) : no_key;
  }
  SCREE_HD std::uint64_t of_plane(std::int32_t plane, std::int32_t body) const {
    if (!near.is_free(body) || !near.may_be_pair(plane, body) || !near.spheres_are_near(plane, body))
      return no_key;
    return plane < body ? key.of(plane, body) : key.of(body, plane);
  }
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
ConstView<Pair> Candidates<Space>::list(const NearPairs& near, ConstView<Pair> pcs) {
  const ConstBodyView& bodies = near.bodies;
  const PairKey key{static_cast<int>(std::bit_width(static_cast<std::uint64_t>(bodies.count())))};
  parallel::select("candidates", bodies.count(), PlaneNumber{bodies.shape}, no_plane, planes_);
  const CandidateKey candidate{near, pcs, std::as_const(planes_).view(), key};
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
