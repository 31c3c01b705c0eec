#include "sim/pairs/approach.hpp"

#include "core/parallel.hpp"
#include "core/space_atomic.hpp"

#include <utility>

namespace scree {

namespace {

/// Finds the approach speeds of free bodies, pair by pair.
struct RaiseApproach {
  ConstBodyView bodies;
  ConstView<Pair> pairs;
  View<std::uint32_t> approach;

  SCREE_HD void operator()(std::int64_t p) const {
    const Pair& pair = pairs[p];
    const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(speed_between(pair.i, pair.j)));
    if (bodies.mobility[pair.i] == Mobility::free) raise(&approach[pair.i], bits);
    if (bodies.mobility[pair.j] == Mobility::free) raise(&approach[pair.j], bits);
  }

 private:
  SCREE_HD double speed_between(std::int32_t i, std::int32_t j) const {
    return (velocity_at(j, i) - velocity_at(i, j)).norm() + turning(i) + turning(j);
  }
  /// Returns the velocity of a body; if it is not free, that of its point where the other body is.
  SCREE_HD Vec3 velocity_at(std::int32_t k, std::int32_t other) const {
    if (bodies.mobility[k] == Mobility::free) return bodies.velocity[k];
    const Vec3 arm = bodies.period.nearest(bodies.position[other] - bodies.position[k]);
    return bodies.velocity[k] + bodies.spin[k].cross(arm);
  }
  /// Returns the turning_speed() of a free body; that of others is in their velocity_at().
  SCREE_HD double turning(std::int32_t k) const {
    return bodies.mobility[k] == Mobility::free ? turning_speed(bodies, k) : 0.0;
  }
};

}  // namespace

template <class Space>
ApproachSpeeds ApproachFinder<Space>::find(const Bodies<Space>& bodies, ConstView<Pair> pairs) {
  bits_.resize(bodies.count());
  parallel::fill("pairs.approach", bits_, 0u);
  parallel::for_each<Space>("pairs.approach", pairs.size(),
                            RaiseApproach{view_of(bodies), pairs, bits_.view()});
  return {std::as_const(bits_).view()};
}

#define SCREE_INSTANTIATE(Space) template class ApproachFinder<Space>;
SCREE_FOR_EACH_SPACE(SCREE_INSTANTIATE)
#undef SCREE_INSTANTIATE

}  // namespace scree
