// Graph colouring of contacts: those of a colour share no free body, so that they are solved at once.
#pragma once

#include "core/archive.hpp"
#include "core/array.hpp"
#include "core/bodies.hpp"
#include "sim/contacts/contact_store.hpp"
#include "sim/contacts/layout.hpp"

#include <cstdint>

namespace scree::solver {

// A slot remembers the colour of its contact in the lower bits, and whether it was on a part of a hub.
inline constexpr std::uint8_t on_part = 64;
inline constexpr std::uint8_t no_color = 255;  ///< there was no contact
static_assert(most_colors <= on_part);

/// What is left of that when candidates are made anew: the parts of hubs are dealt anew as well.
SCREE_HD inline std::uint8_t color_with_new_parts(std::uint8_t remembered, bool is_on_part) {
  return is_on_part || (remembered & on_part) != 0 ? no_color : remembered;
}

/// Where the contacts of a colour begin: among all that are sorted, and among the places.
struct ColorStart {
  std::int64_t first, place;
};

/// For contacts of one kind.
template <class Space>
class ContactColors {
 public:
  /// Colours the contacts of the slots that are `found`, by their places among `slots`. `remembered`: what
  /// the slots remember; a slot that had a contact mostly keeps its colour, and all remember that of now.
  /// `ends`: how many bodies of the solver are free or parts of hubs. The result does not depend on the order
  /// of threads.
  void find(ConstView<std::int32_t> found, ConstView<Slot> slots, const ConstBodyView& bodies,
            std::int64_t ends, View<std::uint8_t> remembered);
  /// Of the contacts: those that have any.
  const ColorRanges& ranges() const { return ranges_; }
  /// Whether the last find() has found the contacts of the one before, which are where they were.
  bool are_same() const { return are_same_; }
  /// Writes the slot of each contact: colour by colour, and in the order of the slots.
  void place(View<std::int32_t> slot) const;
  /// The slots are others, or remember something else.
  void forget() { knows_slots_ = false; }

  void archive(Archive& archive) {
    archive("colors", colors_);
    archive("colors_at_first", colors_at_first_);
  }

 private:
  Array<std::uint32_t, Space> color_, slot_;  // of each contact; in the end colour by colour
  ColorRanges ranges_;
  Array<ColorStart, Space> start_;  // of each colour
  // Room for find(): contacts without a colour, what bodies of the solver know, contacts of each colour.
  Array<std::uint32_t, Space> uncolored_, counts_;
  Array<std::uint64_t, Space> standing_, taken_;
  bool knows_slots_ = false, are_same_ = false;
  int colors_ = 0;           // of the last call
  int colors_at_first_ = 0;  // that were needed when all were coloured at once
};

}  // namespace scree::solver
