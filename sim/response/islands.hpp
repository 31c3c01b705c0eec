// Islands: sets of free bodies that contacts connect. Each island is a separate contact problem.
#pragma once

#include "sim/response/direct_contact.hpp"

#include <cstdint>
#include <vector>

namespace scree {

/// The islands of a contact problem, ordered by their first free bodies. The bodies and contacts of each
/// island are in ascending order.
class Islands {
 public:
  /// Finds the islands of these contacts. Bodies that are not free connect nothing.
  void find(ConstView<Contact> contacts, ConstView<SolverBody> bodies);

  /// Functions to build islands step by step: start() puts each of `bodies` bodies into an island of its own,
  /// unite() joins two islands, and root() returns the first body of an island.
  void start(std::int64_t bodies);
  void unite(std::int32_t i, std::int32_t j);
  std::int32_t root(std::int32_t body);

  std::int64_t count() const { return static_cast<std::int64_t>(contact_begin_.size()) - 1; }
  ConstView<std::int32_t> contacts(std::int64_t island) const {
    return range(contacts_, contact_begin_, island);
  }
  /// Returns the free bodies of an island. Bodies without contacts are in none.
  ConstView<std::int32_t> bodies(std::int64_t island) const { return range(bodies_, body_begin_, island); }
  /// Returns the index of a free body with contacts among the bodies of its island.
  std::int32_t place(std::int32_t body) const { return place_[static_cast<std::size_t>(body)]; }

 private:
  using List = std::vector<std::int32_t>;
  static ConstView<std::int32_t> range(const List& list, const List& begin, std::int64_t island) {
    const std::int32_t* from = &begin[static_cast<std::size_t>(island)];
    return {list.data() + from[0], from[1] - from[0]};
  }

  List parent_;  // parent of each body; a root, the first body of an island, is its own
  List island_;  // island of each body
  List place_;
  List contact_begin_, contacts_;
  List body_begin_, bodies_;
};

}  // namespace scree
