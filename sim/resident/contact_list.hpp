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
  /// Of the tiles, each has `found` so many at its front. The host waits for the counts. `width`: how many
  /// contacts side by side a visit is made to.
  void make(const Array<std::int32_t, Space>& found, int width);

  std::int64_t size() const { return contacts_.places.size(); }
  /// Counted from the first tile, colour by colour.
  ConstView<std::int32_t> places() const { return contacts_.places.view(); }

  /// The first place of each visit, and
  ConstView<std::int32_t> visits() const { return (width_ > 1 ? blocks_ : contacts_).places.view(); }
  /// the first visit of each colour that has any; one more than these.
  const std::vector<std::int64_t>& visits_begin() const { return (width_ > 1 ? blocks_ : contacts_).begin; }

 private:
  struct List {
    Array<std::int32_t, Space> places;
    std::vector<std::int64_t> begin;
  };
  void make(const Array<std::int32_t, Space>& found, int width, List& list);

  int width_ = 1;
  List contacts_, blocks_;
  Array<std::int32_t, Space> counts_;        // of each tile
  Array<std::int64_t, Space> number_;        // of the first of each tile
  Array<std::int64_t, Space> tile_, first_;  // of each colour
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
