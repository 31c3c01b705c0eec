// Where contacts are, one after the other, so that work on them leaves no thread without one.
#pragma once

#include "core/array.hpp"
#include "sim/resident/layout.hpp"
#include "sim/resident/slots.hpp"

#include <cstdint>
#include <vector>

namespace scree::resident {

template <class Space>
class ContactList {
 public:
  /// Contacts will be in tiles of these colours.
  void take(const ColorTiles& colors);
  /// Of the tiles, each has `found` so many at its front. The host waits for the counts.
  void make(const Array<std::int32_t, Space>& found);

  std::int64_t size() const { return places_.size(); }
  /// Counted from the first tile, colour by colour.
  ConstView<std::int32_t> places() const { return places_.view(); }
  /// The first of each colour; one more than colours.
  const std::vector<std::int64_t>& begin() const { return begin_; }

 private:
  Array<std::int32_t, Space> places_;
  Array<std::int64_t, Space> number_;        // of the first contact of each tile
  Array<std::int64_t, Space> tile_, first_;  // of each colour
  std::vector<std::int64_t> begin_;
};

/// f(place) for the contacts of a list.
template <class F>
struct OnContacts {
  static constexpr int blocks_at_once = [] {
    if constexpr (requires { F::blocks_at_once; }) return F::blocks_at_once;
    return 1;
  }();

  ConstView<std::int32_t> places;
  F f;
  SCREE_HD auto operator()(std::int64_t k) const { return f(places[k]); }
};
template <class Space, class F>
OnContacts<F> on_contacts(const ContactList<Space>& list, const F& f) {
  return {list.places(), f};
}

}  // namespace scree::resident
