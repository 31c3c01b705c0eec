// Graph colouring of the contacts: contacts of one colour share no free body, so they can be solved at once,
// and the result does not depend on the number of threads.
#pragma once

#include "core/array.hpp"
#include "core/bodies.hpp"
#include "narrowphase/contact.hpp"

#include <cstdint>
#include <vector>

namespace scree {

class BallPairs;

struct Coloring {
  std::vector<std::int32_t> order;        ///< contacts, colour by colour, ascending within a colour
  std::vector<std::int64_t> color_begin;  ///< colours + 1 offsets into order
  bool last_is_serial = false;  ///< the last colour holds what no colour was left for: solved one by one

  // Scratch of color_contacts.
  std::vector<std::uint64_t> used;     ///< colours taken, a bit each, per body
  std::vector<std::uint8_t> color_of;  ///< per contact

  std::int64_t colors() const { return static_cast<std::int64_t>(color_begin.size()) - 1; }
};

/// Greedy first-fit colouring of contacts with at most 64 colours and a serial rest: first the
/// manifolds, then the pairs of balls that touch, each in their order. `coloring` keeps its storage from call
/// to call.
void color_contacts(const BallPairs& balls, ConstView<ManifoldHeader> manifolds, ConstView<Mobility> mobility,
                    Coloring& coloring);

}  // namespace scree
