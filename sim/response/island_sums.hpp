// Sums over the contacts of each island, computed without building its contact problem.
#pragma once

#include "core/array.hpp"
#include "core/parallel_loops.hpp"
#include "sim/contacts/contact_store.hpp"
#include "sim/contacts/layout.hpp"
#include "sim/contacts/sweeps.hpp"
#include "sim/response/islands.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace scree::solver {

/// The term that a contact adds to the sum of its island, and the two bodies, which define the island. A body
/// that is not free is given as -1.
template <class Sum>
struct IslandTerm {
  std::int32_t i = -1, j = -1;
  Sum sum{};
};

/// Makes the term of contact c, whose value is of(c). Each contact has at least one free body.
template <class Real, class Contacts, class Of>
struct TermOfIsland {
  ConstView<Slot> places;
  std::int64_t first_place;  ///< place of the first slot of this kind of contacts
  Contacts contacts;
  ConstView<BodyRecord<Real>> solver;
  Of of;

  SCREE_HD auto operator()(std::int64_t c) const {
    const Slot& slot = places[first_place + contacts.slot[c]];
    const Ends ends = contacts.ends[c];
    const auto free = [&](std::int32_t body, std::int32_t end) {
      return solver[end].inverse_mass > 0 ? body : -1;
    };
    return IslandTerm<decltype(of(c))>{free(slot.i, ends.i), free(slot.j, ends.j), of(c)};
  }
};

template <class Term, class Of>
struct StoreTerm {
  OnContacts<Of> of;
  Term* terms;
  SCREE_HD void operator()(std::int64_t k) const { terms[k] = of(k); }
};

/// The sums of all islands. The terms are copied to Host, where the islands are found, so the contacts should
/// be few.
template <class Space, class Sum>
class IslandSums {
 public:
  explicit IslandSums(std::int64_t bodies) : bodies_(bodies) { islands_.start(bodies); }
  /// Adds the terms of all contacts of one kind. `term` is a TermOfIsland.
  template <class Of>
  void add(const Of& term) {
    using Term = IslandTerm<Sum>;
    const OnContacts<Of> of = on_contacts(term.contacts, term);
    Array<Term, Space> terms(of.slot.size());
    parallel::for_each<Space>("islands.terms", terms.size(), StoreTerm<Term, Of>{of, terms.data()});
    for (const Term& at : to_vector(terms)) {
      if (at.i >= 0 && at.j >= 0) islands_.unite(at.i, at.j);
      if (at.i >= 0 || at.j >= 0) terms_.push_back(at);
    }
  }
  /// Returns whether `of(sum)` holds for each island.
  template <class Of>
  bool all(const Of& of) {
    std::vector<Sum> sums(static_cast<std::size_t>(bodies_));  // the sum of an island is at its root
    for (const IslandTerm<Sum>& at : terms_) {
      Sum& sum = sums[static_cast<std::size_t>(islands_.root(at.i >= 0 ? at.i : at.j))];
      sum = sum + at.sum;
    }
    return std::ranges::all_of(sums, of);
  }

 private:
  std::int64_t bodies_;
  Islands islands_;
  std::vector<IslandTerm<Sum>> terms_;
};

}  // namespace scree::solver
