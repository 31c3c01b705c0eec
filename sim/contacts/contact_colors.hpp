// Graph colouring of contacts: contacts of one colour share no free body, so that they can be solved in
// parallel.
#pragma once

#include "core/archive.hpp"
#include "core/array.hpp"
#include "core/bodies.hpp"
#include "sim/contacts/contact_store.hpp"
#include "sim/contacts/layout.hpp"

#include <cstdint>

namespace scree::solver {

// A slot remembers the colour of its contact in the lower bits, and in this bit whether one of its ends was a
// part of a hub.
inline constexpr std::uint8_t on_part = 64;
inline constexpr std::uint8_t no_color = 255;  ///< the slot had no contact
static_assert(most_colors <= on_part && (no_color & on_part) != 0);

/// Returns what is left of a remembered colour when the contacts of hubs are dealt to new parts. A colour on
/// a part is forgotten.
SCREE_HD inline std::uint8_t color_with_new_parts(std::uint8_t remembered) {
  return (remembered & on_part) != 0 ? no_color : remembered;
}

/// Where the contacts of a colour begin: their index among all contacts sorted by colour, and their place in
/// the store.
struct ColorStart {
  std::int64_t first, place;
};

/// A contact that has no colour yet, and what the rounds of colouring ask of it again and again.
struct alignas(16) UncoloredContact {
  std::uint64_t rank;  ///< rank among its neighbours; `colored` once it has got its colour
  std::int32_t i,
      j;  ///< the free bodies of the solver on which it acts; -1 stands for a body that is not free

  static constexpr std::uint64_t colored = ~std::uint64_t{0};
};

/// What has changed since the last colouring: the number of contacts without a colour, and whether (0 or 1)
/// any contact has gone.
struct ColorChanges {
  std::uint64_t uncolored = 0;
  std::uint32_t any_gone = 0;
};

/// The colouring of the contacts of one kind (of balls, or of several points).
template <class Space>
class ContactColors {
 public:
  /// Colours the contacts of the slots `found`, which are indices into `slots`. `remembered`: the colours
  /// that the slots remember. A slot that had a contact before mostly keeps its colour; on return all slots
  /// remember their present colours. `ends`: number of bodies of the solver. The
  /// result does not depend on the order of threads.
  void find(ConstView<std::int32_t> found, ConstView<Slot> slots, const ConstBodyView& bodies,
            std::int64_t ends, View<std::uint8_t> remembered);
  /// Returns the ranges of the colours; each colour in it has at least one contact.
  const ColorRanges& ranges() const { return ranges_; }
  /// Whether the last find() has found the same contacts as the find() before it, with the same colours, so
  /// that they keep their places in the store.
  bool are_same() const { return are_same_; }
  /// Writes the slot of each contact to its place, colour by colour, and within a colour in the order of the
  /// slots.
  void place(View<std::int32_t> slot) const;
  /// Forgets the contacts of the last find(), so that are_same() is false after the next one. This is
  /// necessary when the slots, or what they remember, have changed.
  void forget() { knows_slots_ = false; }

  void archive(Archive& archive) {
    archive("colors", colors_);
    archive("colors_at_first", colors_at_first_);
  }

 private:
  void color_others(ConstView<Slot> slots, const ConstBodyView& bodies, View<std::uint8_t> remembered);
  void sort(ConstView<std::int32_t> found, ConstView<std::uint8_t> remembered);

  Array<std::uint8_t, Space> color_;  // each contact's colour and slot; find() sorts them by colour
  Array<std::int32_t, Space> slot_;
  ColorRanges ranges_;
  Array<ColorStart, Space> start_;     // one element for each colour
  Array<std::uint64_t, Space> taken_;  // the colours that are taken at each body of the solver
  // Temporary memory of find(): the slots of contacts without a colour, the number of contacts of each
  // colour, and the lowest rank that has claimed each body of the solver; between two calls no body is
  // claimed.
  Array<std::int32_t, Space> uncolored_;
  Array<std::uint32_t, Space> counts_;
  Array<ColorChanges, Space> changes_;
  Array<UncoloredContact, Space> waiting_;
  Array<std::uint64_t, Space> standing_;
  bool knows_slots_ = false, are_same_ = false;
  int colors_ = 0;           // number of colours after the last find()
  int colors_at_first_ = 0;  // number of colours after the last find() that coloured all contacts at once
};

}  // namespace scree::solver
