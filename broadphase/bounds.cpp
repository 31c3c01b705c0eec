#include "broadphase/bounds.hpp"

#include "core/parallel.hpp"

namespace scree {

namespace {

struct ComputeBounds {
  ConstView<Shape> shape;
  ConstView<Mobility> mobility;
  ConstView<Vec3> position;
  ConstView<Quat> orientation;
  ConstView<Vec3> size;
  ConstView<double> margin;
  Period period;
  Vec3 origin;
  View<Aabb> bounds;
  SCREE_HD void operator()(std::int64_t i) const {
    if (mobility[i] == Mobility::absent) {
      bounds[i] = absent_bounds();
      return;
    }
    BodyGeometry body{shape[i], position[i], orientation[i], size[i]};
    period.wrap(body.position);
    bounds[i] = bounds_of(body, margin[i], origin);
  }
};

}  // namespace

template <class Space>
void compute_bounds(const ConstBodyView& bodies, ConstView<double> margin, const Vec3& origin,
                    View<Aabb> bounds) {
  parallel::for_each<Space>("broadphase.bounds", bodies.count(),
                            ComputeBounds{bodies.shape, bodies.mobility, bodies.position, bodies.orientation,
                                          bodies.size, margin, bodies.period, origin, bounds});
}

#define SCREE_INSTANTIATE(Space) \
  template void compute_bounds<Space>(const ConstBodyView&, ConstView<double>, const Vec3&, View<Aabb>);
SCREE_FOR_EACH_SPACE(SCREE_INSTANTIATE)
#undef SCREE_INSTANTIATE

}  // namespace scree
