// Sums over the contacts of each island, without putting its contact problem together.
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

/// What a contact adds, and the bodies by which it belongs to an island: -1 where one is not free.
template <class Sum>
struct IslandTerm {
  std::int32_t i = -1, j = -1;
  Sum sum{};
};

/// The term of contact c, whose sum is of(c). Each contact has at least one free body.
template <class Real, class Contacts, class Of>
struct TermOfIsland {
  ConstView<Slot> places;
  std::int64_t first_place;  ///< of contacts of this kind
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

/// For few contacts: their terms are brought to Host, where the islands are found.
template <class Space, class Sum>
class IslandSums {
 public:
  explicit IslandSums(std::int64_t bodies) : bodies_(bodies) { islands_.start(bodies); }
  /// `term`: TermOfIsland.
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
  /// Whether `of(sum)` holds for each island.
  template <class Of>
  bool all(const Of& of) {
    std::vector<Sum> sums(static_cast<std::size_t>(bodies_));  // those of an island at its root
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
