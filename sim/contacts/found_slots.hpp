// The list of the slots that have a contact.
#pragma once

#include "core/array.hpp"

#include <cstdint>

namespace scree::solver {

/// Collects the places of the slots of one kind that have a contact, tile by tile (parallel::tile slots
/// each).
template <class Space>
class FoundSlots {
 public:
  /// Makes room for a number of tiles, of which none has a slot yet. Each tile then writes the places of the
  /// slots that it has found to the front of its part of places(), in their order, and their number to
  /// counts().
  void start(std::int64_t tiles);
  std::int32_t* places() { return places_.data(); }
  std::int32_t* counts() { return counts_.data(); }

  /// Joins the places of all tiles in one list. The host waits for their number.
  void join();
  ConstView<std::int32_t> all() const { return all_.view(); }

 private:
  Array<std::int32_t, Space> places_, counts_, all_;
  Array<std::int64_t, Space> number_;  // index in the list of the first slot of each tile
};

}  // namespace scree::solver
