// The broad phase in the space of choice, for bodies on the host: bounds out, pairs back.
#pragma once

#include "broadphase/broad_phase.hpp"
#include "core/bodies.hpp"
#include "sim/inspection.hpp"

#include <memory>

namespace scree {

class PairFinder {
 public:
  virtual ~PairFinder() = default;
  /// The PCS of the bodies, each box fat by its margin (m). Valid until the next call.
  virtual ConstView<Pair> find(const Bodies<Host>& bodies, const Array<double, Host>& margin) = 0;
  virtual const char* space_name() const = 0;
  /// Of the last call of find().
  virtual GridOccupancy grid_occupancy() const = 0;
};

/// `on_device`: the PCS is made on the GPU; throws InputError if there is none. `origin`: the local origin to
/// which the float bounds are relative (m).
std::unique_ptr<PairFinder> make_pair_finder(const BroadPhaseSettings& settings, bool on_device,
                                             const Vec3& origin);

}  // namespace scree
