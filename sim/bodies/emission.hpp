// Bodies that appear one after another, where there is room.
#pragma once

#include "core/archive.hpp"
#include "core/bodies.hpp"
#include "sim/scene/scene.hpp"
#include "sim/scene/time_grid.hpp"

#include <cstdint>
#include <functional>
#include <vector>

namespace scree {

/// A function that returns the bodies that may reach into the box from `low` to `high` (m).
using BodiesNear = std::function<BodyTable(const Vec3& low, const Vec3& high)>;

/// The emission of bodies by one emitter. A body that finds no room waits. The largest waiting body is placed
/// first, and if it finds no room, the others wait with it: else small bodies would fill every gap before it.
class Emission {
 public:
  Emission(const Emitter& emitter, const TimeGrid& grid);

  const BodyRange& bodies() const { return emitter_.bodies; }
  std::int64_t requested() const { return requested_; }  ///< number of bodies requested so far
  std::int64_t emitted() const { return requested_ - static_cast<std::int64_t>(waiting_.size()); }
  /// Returns whether the body has appeared in the state of a step or before.
  bool holds(std::int32_t body, std::int64_t step) const;
  /// Returns where the body appeared (m); it must have appeared.
  const Vec3& place(std::int32_t body) const { return place_[index_of(body)]; }

  /// Must be called when the state of a step has been reached, for steps in ascending order. Returns the
  /// bodies that appear in it, at the places where they appear; `scene` has their data.
  BodyTable emit(std::int64_t step, const Scene& scene, const BodiesNear& near);
  void archive(Archive& archive);

 private:
  std::size_t index_of(std::int32_t body) const {
    return static_cast<std::size_t>(body - emitter_.bodies.first);
  }

  Emitter emitter_;
  Cadence due_;
  std::int64_t requested_ = 0;
  std::vector<std::int32_t> waiting_;
  std::vector<std::int64_t> first_step_;  // step in which each body appeared, by index; `never` before that
  std::vector<Vec3> place_;
};

}  // namespace scree
