// What ContactFinder does with contacts that bodies may fly past, in both its parts. Each part is a source of
// its own, because nvcc takes minutes for the pair tests.
#pragma once

#include "core/parallel.hpp"
#include "core/space_tiles.hpp"
#include "sim/resident/contact_finder.hpp"

namespace scree::resident {

template <class Space, class Real>
PassingList ContactFinder<Space, Real>::clear_passing(std::int64_t contacts) {
  passing_.resize(contacts);
  passing_count_.resize(1);
  parallel::fill("contacts.passing", passing_count_, std::uint64_t{0});
  return {passing_.view(), passing_count_.data()};
}

template <class Space, class Real>
template <class Judge>
void ContactFinder<Space, Real>::judge(const PassingList& passing, const Judge& judge) {
  constexpr std::int64_t threads = JudgePassing<Judge>::template threads<Space>;
  parallel::for_each<Space>("contacts.passing", threads, JudgePassing<Judge>{threads, passing, judge});
}

}  // namespace scree::resident
