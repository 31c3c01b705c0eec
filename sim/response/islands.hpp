// Islands: sets of free bodies that contacts connect. Each is a contact problem of its own.
#pragma once

#include "sim/response/direct_contact.hpp"

#include <cstdint>
#include <vector>

namespace scree {

/// Ordered by their first free body, and so are the bodies and the contacts of each.
class Islands {
 public:
  /// `bodies`: how many there are. Bodies that are not free connect nothing.
  void find(ConstView<Contact> contacts, ConstView<SolverBody> bodies);

  /// The same by hand: each body alone, then united with others. The roots are the islands' first bodies.
  void start(std::int64_t bodies);
  void unite(std::int32_t i, std::int32_t j);
  std::int32_t root(std::int32_t body);

  std::int64_t count() const { return static_cast<std::int64_t>(contact_begin_.size()) - 1; }
  ConstView<std::int32_t> contacts(std::int64_t island) const {
    return range(contacts_, contact_begin_, island);
  }
  /// The free ones that have contacts.
  ConstView<std::int32_t> bodies(std::int64_t island) const { return range(bodies_, body_begin_, island); }
  /// Of a free body with contacts: its place among those of its island.
  std::int32_t place(std::int32_t body) const { return place_[static_cast<std::size_t>(body)]; }

 private:
  using List = std::vector<std::int32_t>;
  static ConstView<std::int32_t> range(const List& list, const List& begin, std::int64_t island) {
    const std::int32_t* from = &begin[static_cast<std::size_t>(island)];
    return {list.data() + from[0], from[1] - from[0]};
  }

  List parent_;  // of each body; its own at a root, which is the first body of its island
  List island_;  // of each body
  List place_;
  List contact_begin_, contacts_;
  List body_begin_, bodies_;
};

}  // namespace scree
