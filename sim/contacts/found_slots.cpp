#include "sim/contacts/found_slots.hpp"

#include "core/parallel.hpp"
#include "core/space_tiles.hpp"

#include <utility>

namespace scree::solver {

namespace {

struct CopyFound {
  const std::int32_t* from;
  ConstView<std::int64_t> number;
  View<std::int32_t> to;
  SCREE_HD void operator()(std::int64_t t, std::int32_t k) const {
    to[number[t] + k] = from[t * parallel::tile + k];
  }
};

}  // namespace

template <class Space>
void FoundSlots<Space>::start(std::int64_t tiles) {
  places_.resize(tiles * parallel::tile);
  counts_.resize(tiles);
  all_.resize(0);
}

template <class Space>
void FoundSlots<Space>::join() {
  all_.resize(parallel::exclusive_scan("contacts.list", counts_, number_));
  parallel::for_each_found<Space>("contacts.list", counts_.size(), counts_.data(),
                                  CopyFound{places_.data(), std::as_const(number_).view(), all_.view()});
}

#define SCREE_INSTANTIATE(Space) template class FoundSlots<Space>;
SCREE_FOR_EACH_SPACE(SCREE_INSTANTIATE)

}  // namespace scree::solver
