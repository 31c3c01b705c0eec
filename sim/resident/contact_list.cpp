#include "sim/resident/contact_list.hpp"

#include "core/parallel.hpp"
#include "core/space_tiles.hpp"

#include <algorithm>
#include <utility>

namespace scree::resident {

namespace {

constexpr std::int64_t tile = parallel::tile;
static_assert(tile == tile_size);

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
  for (List* list : {&contacts_, &blocks_}) {
    list->places.resize(0);
    list->begin.assign(1, 0);
  }
}

template <class Space>
void ContactList<Space>::make(const Array<std::int32_t, Space>& found, int width) {
  width_ = width;
  if (found.empty()) return;
  make(found, 1, contacts_);
  if (width > 1) make(found, width, blocks_);
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
  // A colour without contacts would be a wait for nothing.
  list.begin.erase(std::unique(list.begin.begin(), list.begin.end()), list.begin.end());
}

#define SCREE_INSTANTIATE(Space) template class ContactList<Space>;
SCREE_FOR_EACH_SPACE(SCREE_INSTANTIATE)

}  // namespace scree::resident
