#include "sim/bodies/region.hpp"

#include "core/parallel.hpp"
#include "core/space_tiles.hpp"

namespace scree {

namespace {

struct BodyContents {
  ConstBodyView bodies;
  Vec3 low;
  Vec3 high;
  SCREE_HD RegionContents operator()(std::int64_t k) const {
    if (bodies.mobility[k] != Mobility::free) return {};
    Vec3 x = bodies.position[k];
    bodies.period.bring_near(0.5 * (low + high), x);
    if ((x.array() < low.array()).any() || (x.array() > high.array()).any()) return {};
    return {1, volume_of(bodies.shape[k], bodies.size[k]), 1.0 / bodies.inverse_mass[k]};
  }
};

}  // namespace

template <class Space>
RegionContents contents_of(const Region& region, const Bodies<Space>& bodies) {
  return parallel::sum_by_tiles<RegionContents, Space>("region.contents", bodies.count(),
                                                       BodyContents{view_of(bodies), region.from, region.to});
}

#define SCREE_INSTANTIATE(Space) \
  template RegionContents contents_of<Space>(const Region&, const Bodies<Space>&);
SCREE_FOR_EACH_SPACE(SCREE_INSTANTIATE)
#undef SCREE_INSTANTIATE

}  // namespace scree
