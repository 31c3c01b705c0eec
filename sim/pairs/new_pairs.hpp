// The search for bodies that have left their boxes and may touch others that they were not near when the
// boxes were made.
#pragma once

#include "core/array.hpp"
#include "core/space_atomic.hpp"
#include "narrowphase/near_pairs.hpp"

#include <cstdint>
#include <type_traits>

namespace scree {

/// A body that has left its box.
struct BodyOutside {
  Vec3 position;
  double around;  ///< NearPairs::sphere_around()
  std::int32_t body;
};

/// A list of bodies that have left their boxes, in any order, as far as there is room, and their number.
struct BodiesOutside {
  View<BodyOutside> list;
  std::uint64_t* count;

  SCREE_HD void add(const NearPairs& now, std::int64_t k) const {
    const auto body = static_cast<std::int32_t>(k);
    const auto place = static_cast<std::int64_t>(count_up_together(count));
    if (place < list.size()) list[place] = {now.bodies.position[k], now.sphere_around(body), body};
  }
};

template <class Space>
class NewPairs {
 public:
  /// Largest number of bodies for which the search costs no more than making all pairs anew.
  static constexpr std::int64_t most_outside = std::is_same_v<Space, Host> ? 64 : 512;

  /// Returns an empty list, to which all bodies that are outside now must be added.
  BodiesOutside start();
  /// Returns whether two bodies, of which one is outside, are near each other `now`, but were not `then`,
  /// when all near pairs were found. Returns true if more than most_outside are outside.
  bool exist(const NearPairs& now, const NearPairs& then);
  /// Returns how many bodies were outside when exist() was last called.
  std::int64_t outside() const { return outside_; }

 private:
  Array<BodyOutside, Space> list_;
  Array<std::uint64_t, Space> found_;  // number of bodies outside, and whether one has a new pair
  std::int64_t outside_ = 0;
};

}  // namespace scree
