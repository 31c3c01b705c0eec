// Colours of the contacts that there are. Slots are coloured with their candidates, of which in motion few
// have a contact: then these need a third of the colours, and each colour is a wait of all processors of a
// GPU.
#pragma once

#include "core/array.hpp"
#include "core/bodies.hpp"
#include "sim/resident/contact_list.hpp"
#include "sim/resident/layout.hpp"

#include <cstdint>

namespace scree::resident {

/// What colours hang on: the ends of each contact, and the numbers of its bodies.
template <class Real>
struct ContactEnds {
  ConstView<Slot> places;        ///< of the slots that contacts of the kind are in
  ConstView<std::uint8_t> slot;  ///< of each contact, in its tile
  const Ends* ends;
  ConstView<BodyRecord<Real>> solver;
  ConstView<BodyNumber> number;  ///< of each body, by place

  SCREE_HD const Slot& slot_of(std::int64_t c) const { return places[c - c % 256 + slot[c]]; }
  SCREE_HD bool is_free(std::int32_t end) const { return solver[end].inverse_mass > 0; }
};

template <class Space, class Real>
class ContactColors {
 public:
  /// Colours the contacts of a list anew, for its visits: no two of one colour share a free body of the
  /// solver, of which there are `bodies`. What is found hangs neither on the order of threads nor on where
  /// bodies lie. A visit is to one contact.
  void color(const ContactEnds<Real>& contacts, std::int64_t bodies, ContactList<Space>& list);

 private:
  Array<std::uint64_t, Space> rank_;              // of each contact of the list
  Array<std::uint8_t, Space> color_;              // of each contact
  Array<std::uint64_t, Space> standing_, taken_;  // of each body
  Array<std::uint32_t, Space> key_, counts_;
};

}  // namespace scree::resident
