#include "sim/dynamics/prescribed.hpp"

#include "core/parallel.hpp"

namespace scree {

namespace {

struct Place {
  ConstView<PrescribedPath> paths;
  double time;
  BodyView bodies;
  SCREE_HD void operator()(std::int64_t k) const { paths[k].place(time, bodies); }
};

}  // namespace

std::vector<PrescribedPath> prescribed_paths(const Scene& scene) {
  std::vector<PrescribedPath> paths;
  for (const Motion& motion : scene.motions) {
    const auto k = static_cast<std::size_t>(motion.body);
    const Vec3& centre = scene.bodies.position[k];
    const Vec3 pivot = motion.about.value_or(centre);
    paths.push_back({.body = motion.body,
                     .pivot = pivot,
                     .arm = centre - pivot,
                     .orientation = scene.bodies.orientation[k],
                     .velocity = motion.velocity,
                     .spin = motion.spin,
                     .start = 0});
  }
  return paths;
}

template <class Space>
void place_prescribed(const Array<PrescribedPath, Space>& paths, double time, Bodies<Space>& bodies) {
  parallel::for_each<Space>("motion.prescribed", paths.size(), Place{paths.view(), time, view_of(bodies)});
}

#define SCREE_INSTANTIATE(Space) \
  template void place_prescribed(const Array<PrescribedPath, Space>&, double, Bodies<Space>&);
SCREE_FOR_EACH_SPACE(SCREE_INSTANTIATE)
#undef SCREE_INSTANTIATE

}  // namespace scree
