#include "sim/bodies/turning_gravity.hpp"

#include "sim/bodies/motion.hpp"
#include "sim/scene/motion_bounds.hpp"

namespace scree {

template <class Space>
double TurningGravity::turn_to(double midpoint, const Bodies<Space>& bodies,
                               ResponseParameters& parameters) const {
  if (!turns()) return 0;
  const Vec3 next = gravity_at(*turn_, at_start_, midpoint);
  const Vec3 moment = totals_of<Space>(bodies, next, Vec3::Zero()).first_moment;
  const double work = -moment.dot(next - parameters.gravity);
  parameters.gravity = next;
  return work;
}

#define SCREE_INSTANTIATE(Space) \
  template double TurningGravity::turn_to<Space>(double, const Bodies<Space>&, ResponseParameters&) const;
SCREE_FOR_EACH_SPACE(SCREE_INSTANTIATE)
#undef SCREE_INSTANTIATE

}  // namespace scree
