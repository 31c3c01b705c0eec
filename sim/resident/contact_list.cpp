#include "sim/resident/contact_list.hpp"

#include "core/parallel.hpp"
#include "core/space_tiles.hpp"

#include <utility>

namespace scree::resident {

namespace {

constexpr std::int64_t tile = parallel::tile;

struct ListContacts {
  const std::int32_t* found;
  ConstView<std::int64_t> number;
  View<std::int32_t> places;
  SCREE_HD void operator()(std::int64_t place) const {
    if (has_contact(found, place))
      places[number[place / tile] + place % tile] = static_cast<std::int32_t>(place);
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
  places_.resize(0);
  begin_.assign(tiles.size(), 0);
}

template <class Space>
void ContactList<Space>::make(const Array<std::int32_t, Space>& found) {
  if (found.empty()) return;
  parallel::exclusive_scan_into("contacts.list", found, number_);
  places_.resize(tile * found.size());
  parallel::for_each<Space>("contacts.list", places_.size(),
                            ListContacts{found.data(), std::as_const(number_).view(), places_.view()});
  first_.resize(tile_.size());
  parallel::for_each<Space>(
      "contacts.list", tile_.size(),
      FirstOfColor{std::as_const(number_).view(), std::as_const(tile_).view(), first_.view()});
  copy(begin_, first_);
  places_.resize(begin_.back());
}

#define SCREE_INSTANTIATE(Space) template class ContactList<Space>;
SCREE_FOR_EACH_SPACE(SCREE_INSTANTIATE)

}  // namespace scree::resident
