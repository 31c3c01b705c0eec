// The treatment of contacts whose bodies may fly past each other, for both parts of ContactFinder (balls and
// points). Each part is a source file of its own, because nvcc takes minutes for the pair tests.
#pragma once

#include "core/parallel.hpp"
#include "core/space_tiles.hpp"
#include "sim/contacts/contact_finder.hpp"

namespace scree::solver {

template <class Space, class Real>
ApproachList ContactFinder<Space, Real>::clear_approaching(std::int64_t contacts) {
  approaching_.resize(contacts);
  approaching_count_.resize(1);
  parallel::fill("contacts.approaching", approaching_count_, std::uint64_t{0});
  return {approaching_.view(), approaching_count_.data()};
}

template <class Space, class Real>
template <class Judge>
void ContactFinder<Space, Real>::judge(const ApproachList& approaching, const Judge& judge) {
  parallel::for_each_counted<Space>("contacts.approaching", approaching.count,
                                    JudgeApproach<Judge>{approaching, judge});
}

}  // namespace scree::solver
