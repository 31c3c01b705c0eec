// Contact margins for bodies that move along with their neighbours.
#pragma once

#include "broadphase/broad_phase.hpp"
#include "core/array.hpp"
#include "core/bodies.hpp"
#include "sim/laws/response_parameters.hpp"

#include <cstdint>

namespace scree {

/// The contact margins of contact_margins() have room for a body's whole motion. In a heap that falls or
/// flows, a body comes nearer to others only by the difference of their velocities, which is much smaller.
/// This class lowers the margins to that.
template <class Space>
class ApproachMargins {
 public:
  /// Returns a margin for each body (m) that is at most `margin`, and that has room for motion at twice the
  /// body's approach speed within dt (s). The approach speed is the largest speed of the body relative to one
  /// with which it is paired, whether the two come nearer or not: a contact with that body can change its
  /// velocity by up to twice as much. So two bodies with equal velocities have room to meet if something else
  /// may stop one of them. The view is valid until the next call.
  ConstView<double> find(const Bodies<Space>& bodies, ConstView<Pair> pairs, double dt,
                         const ResponseParameters& parameters, const Array<double, Space>& margin);

 private:
  Array<std::uint32_t, Space> approach_;  // approach speeds (m/s): the bits of floats, which have their order
  Array<double, Space> margin_;
};

}  // namespace scree
