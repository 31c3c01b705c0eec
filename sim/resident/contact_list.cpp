#include "sim/resident/contact_list.hpp"

#include "core/parallel.hpp"
#include "core/space_tiles.hpp"

#include <algorithm>
#include <utility>

namespace scree::resident {

namespace {

constexpr std::int64_t tile = parallel::tile;

struct CountVisits {
  const std::int32_t* found;
  std::int32_t width;
  View<std::int32_t> counts;
  SCREE_HD void operator()(std::int64_t t) const { counts[t] = (found[t] + width - 1) / width; }
};

struct ListVisits {
  ConstView<std::int64_t> number;
  std::int32_t width;
  View<std::int32_t> places;
  SCREE_HD void operator()(std::int64_t t, std::int32_t visit) const {
    places[number[t] + visit] = static_cast<std::int32_t>(t * tile) + visit * width;
  }
};

struct FirstOfColor {
  ConstView<std::int64_t> number;
  ConstView<std::int64_t> tile;
  View<std::int64_t> first;
  SCREE_HD void operator()(std::int64_t c) const { first[c] = number[tile[c]]; }
};

}  // namespace

template <class Space>
void ContactList<Space>::take(const ColorTiles& colors) {
  std::vector<std::int64_t> tiles;
  for (const std::int64_t t : colors.begin) tiles.push_back(t - colors.begin.front());
  copy(tile_, tiles);
  for (List* list : {&contacts_, &visits_}) {
    list->places.resize(0);
    list->begin.assign(1, 0);
  }
}

template <class Space>
void ContactList<Space>::make(const Array<std::int32_t, Space>& found, int width) {
  own_visits_ = width > 1;
  if (found.empty()) return;
  make(found, 1, contacts_);
  if (own_visits_) make(found, width, visits_);
}

template <class Space>
void ContactList<Space>::make(const Array<std::int32_t, Space>& found, int width, List& list) {
  counts_.resize(found.size());
  parallel::for_each<Space>("contacts.list", found.size(), CountVisits{found.data(), width, counts_.view()});
  parallel::exclusive_scan_into("contacts.list", counts_, number_);
  list.places.resize(tile * found.size());
  parallel::for_each_found<Space>("contacts.list", counts_.size(), counts_.data(),
                                  ListVisits{std::as_const(number_).view(), width, list.places.view()});
  first_.resize(tile_.size());
  parallel::for_each<Space>(
      "contacts.list", tile_.size(),
      FirstOfColor{std::as_const(number_).view(), std::as_const(tile_).view(), first_.view()});
  copy(list.begin, first_);
  list.places.resize(list.begin.back());
  // A colour without contacts is no phase.
  list.begin.erase(std::unique(list.begin.begin(), list.begin.end()), list.begin.end());
}

template <class Space>
void ContactList<Space>::set_visits(Array<std::int32_t, Space> places,
                                    const std::vector<std::uint32_t>& counts) {
  own_visits_ = true;
  visits_.places.swap(places);
  visits_.begin.assign(1, 0);
  for (const std::uint32_t count : counts)
    if (count > 0) visits_.begin.push_back(visits_.begin.back() + count);
}

#define SCREE_INSTANTIATE(Space) template class ContactList<Space>;
SCREE_FOR_EACH_SPACE(SCREE_INSTANTIATE)

}  // namespace scree::resident
