// Whether bodies that have left their boxes may touch others that they were not near when these were made.
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

/// Those bodies, in any order, as far as there is room, and their number.
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
  /// To look at so many bodies costs as much as to make all pairs anew, or less.
  static constexpr std::int64_t most_outside = std::is_same_v<Space, Host> ? 64 : 512;

  /// An empty list, for all bodies to be added to that are outside now.
  BodiesOutside start();
  /// Whether two bodies, of which one is outside, may be in contact as they are now, but were not near each
  /// other `then`, when all pairs that were are known. True if more than most_outside are outside.
  bool exist(const NearPairs& now, const NearPairs& then);
  /// How many bodies were outside when that was last asked.
  std::int64_t outside() const { return outside_; }

 private:
  Array<BodyOutside, Space> list_;
  Array<std::uint64_t, Space> found_;  // how many are outside, and whether one has a new pair
  std::int64_t outside_ = 0;
};

}  // namespace scree
