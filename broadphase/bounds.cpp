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
  BodyPaths paths;
  Period period;
  Vec3 origin;
  View<Aabb> bounds;
  SCREE_HD void operator()(std::int64_t i) const {
    if (mobility[i] == Mobility::absent) {
      bounds[i] = absent_bounds();
      return;
    }
    const Vec3 velocity = paths.velocity_of(mobility[i], i);
    BodyGeometry body{shape[i], position[i] + paths.middle() * velocity, orientation[i], size[i]};
    period.wrap(body.position);
    const Vec3 along = (0.5 * paths.length() * velocity).cwiseAbs();
    bounds[i] = bounds_of(body, Vec3(along.array() + margin[i]), origin);
  }
};

}  // namespace

template <class Space>
void compute_bounds(const ConstBodyView& bodies, ConstView<double> margin, const BodyPaths& paths,
                    const Vec3& origin, View<Aabb> bounds) {
  parallel::for_each<Space>("broadphase.bounds", bodies.count(),
                            ComputeBounds{bodies.shape, bodies.mobility, bodies.position, bodies.orientation,
                                          bodies.size, margin, paths, bodies.period, origin, bounds});
}

#define SCREE_INSTANTIATE(Space)                                                                 \
  template void compute_bounds<Space>(const ConstBodyView&, ConstView<double>, const BodyPaths&, \
                                      const Vec3&, View<Aabb>);
SCREE_FOR_EACH_SPACE(SCREE_INSTANTIATE)
#undef SCREE_INSTANTIATE

}  // namespace scree
