#include "sim/response/islands.hpp"

#include <algorithm>
#include <numeric>

namespace scree {

std::int32_t Islands::root(std::int32_t body) {
  auto at = static_cast<std::size_t>(body);
  while (parent_[at] != static_cast<std::int32_t>(at)) {
    parent_[at] = parent_[static_cast<std::size_t>(parent_[at])];
    at = static_cast<std::size_t>(parent_[at]);
  }
  return static_cast<std::int32_t>(at);
}

void Islands::start(std::int64_t bodies) {
  parent_.resize(static_cast<std::size_t>(bodies));
  std::iota(parent_.begin(), parent_.end(), 0);
}

void Islands::unite(std::int32_t i, std::int32_t j) {
  const std::int32_t a = root(i);
  const std::int32_t b = root(j);
  parent_[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
}

void Islands::find(ConstView<Contact> contacts, ConstView<SolverBody> bodies) {
  const auto n = static_cast<std::size_t>(bodies.size());
  start(bodies.size());
  place_.assign(n, -1);
  for (const Contact& c : contacts) {
    // Only bodies with contacts are in islands.
    if (bodies[c.i].is_free()) place_[static_cast<std::size_t>(c.i)] = 0;
    if (bodies[c.j].is_free()) place_[static_cast<std::size_t>(c.j)] = 0;
    if (!bodies[c.i].is_free() || !bodies[c.j].is_free()) continue;
    unite(c.i, c.j);
  }

  // The lists are made by a count, a prefix sum and a pass that fills them.
  island_.resize(n);
  body_begin_.assign(1, 0);
  for (std::size_t k = 0; k < n; ++k) {
    if (place_[k] < 0) continue;
    const auto r = static_cast<std::size_t>(root(static_cast<std::int32_t>(k)));
    if (r == k) {
      island_[k] = static_cast<std::int32_t>(body_begin_.size()) - 1;
      body_begin_.push_back(0);
    }
    island_[k] = island_[r];
    place_[k] = body_begin_[static_cast<std::size_t>(island_[k]) + 1]++;
  }
  std::partial_sum(body_begin_.begin(), body_begin_.end(), body_begin_.begin());
  bodies_.resize(static_cast<std::size_t>(body_begin_.back()));
  for (std::size_t k = 0; k < n; ++k) {
    if (place_[k] < 0) continue;
    bodies_[static_cast<std::size_t>(body_begin_[static_cast<std::size_t>(island_[k])] + place_[k])] =
        static_cast<std::int32_t>(k);
  }

  const auto island_of = [&](const Contact& c) {
    return static_cast<std::size_t>(island_[static_cast<std::size_t>(bodies[c.i].is_free() ? c.i : c.j)]);
  };
  contact_begin_.assign(body_begin_.size(), 0);
  for (const Contact& c : contacts) ++contact_begin_[island_of(c) + 1];
  std::partial_sum(contact_begin_.begin(), contact_begin_.end(), contact_begin_.begin());
  contacts_.resize(static_cast<std::size_t>(contacts.size()));
  List next(contact_begin_.begin(), contact_begin_.end());
  for (std::int64_t c = 0; c < contacts.size(); ++c) {
    contacts_[static_cast<std::size_t>(next[island_of(contacts[c])]++)] = static_cast<std::int32_t>(c);
  }
}

}  // namespace scree
