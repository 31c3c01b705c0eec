// Slots that have a contact, one after the other.
#pragma once

#include "core/array.hpp"

#include <cstdint>

namespace scree::solver {

/// Of slots in tiles of parallel::tile, by their places among those of one kind.
template <class Space>
class FoundSlots {
 public:
  /// Room for so many tiles. Each writes the places of the slots that it has found from its front on, in
  /// their order, and how many they are.
  void start(std::int64_t tiles);
  std::int32_t* places() { return places_.data(); }
  std::int32_t* counts() { return counts_.data(); }

  /// Brings them together. The host waits for their number.
  void join();
  ConstView<std::int32_t> all() const { return all_.view(); }

 private:
  Array<std::int32_t, Space> places_, counts_, all_;
  Array<std::int64_t, Space> number_;  // of the first of each tile
};

}  // namespace scree::solver
