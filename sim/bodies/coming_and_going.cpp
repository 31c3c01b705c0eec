#include "sim/bodies/coming_and_going.hpp"

#include "core/parallel.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace scree {

namespace {

SCREE_HD inline bool is_in(const Vec3& x, const Vec3& low, const Vec3& high) {
  return (x.array() >= low.array()).all() && (x.array() <= high.array()).all();
}

struct IsFreeAnd {
  ConstBodyView bodies;
  Vec3 low;
  Vec3 high;
  bool inside;
  SCREE_HD int operator()(std::int64_t k) const {
    if (bodies.mobility[k] != Mobility::free) return 0;
    Vec3 x = bodies.position[k];
    bodies.period.bring_near(0.5 * (low + high), x);
    return is_in(x, low, high) == inside ? 1 : 0;
  }
};

struct IsNear {
  ConstBodyView bodies;
  Vec3 low;
  Vec3 high;
  SCREE_HD int operator()(std::int64_t k) const {
    if (bodies.mobility[k] == Mobility::absent) return 0;
    if (is_boundary(bodies.shape[k])) return 1;
    Vec3 x = bodies.position[k];
    bodies.period.bring_near(0.5 * (low + high), x);
    const double distance = (x - x.cwiseMax(low).cwiseMin(high)).norm();
    return distance <= bounding_radius(bodies.shape[k], bodies.size[k]) ? 1 : 0;
  }
};

template <class Is>
struct PlaceWhere {
  static constexpr std::int32_t none = -1;
  Is is;
  SCREE_HD std::int32_t operator()(std::int64_t k) const {
    return is(k) != 0 ? static_cast<std::int32_t>(k) : none;
  }
};

/// Returns the places for which `is` holds. If there are none, this costs one pass that writes nothing.
template <class Space, class Is>
Array<std::int32_t, Space> places_where(const Is& is, std::int64_t count) {
  Array<std::int32_t, Space> places;
  if (parallel::max<int, Space>("coming_and_going.any", count, is, 0) == 0) return places;
  parallel::select<Space>("coming_and_going.places", count, PlaceWhere<Is>{is}, PlaceWhere<Is>::none, places);
  return places;
}

/// Returns the numbers of the bodies at some places, in ascending order.
template <class Space>
std::vector<BodyNumber> numbers_at(const Array<std::int32_t, Space>& places, const Bodies<Space>& bodies) {
  Array<BodyNumber, Space> numbers;
  parallel::gather("coming_and_going.numbers", bodies.id, places, numbers);
  std::vector<BodyNumber> sorted = to_vector(numbers);
  std::ranges::sort(sorted);
  return sorted;
}

struct FindPlaceOf {
  ConstBodyView bodies;
  ConstView<BodyNumber> numbers;
  View<std::int32_t> places;
  SCREE_HD void operator()(std::int64_t k) const { places[k] = bodies.place(numbers[k]); }
};

template <class Space>
Array<std::int32_t, Space> places_of(const std::vector<BodyNumber>& numbers, const Bodies<Space>& bodies) {
  Array<BodyNumber, Space> those;
  Array<std::int32_t, Space> places;
  copy(those, numbers);
  places.resize(those.size());
  parallel::for_each<Space>("coming_and_going.places", those.size(),
                            FindPlaceOf{view_of(bodies), std::as_const(those).view(), places.view()});
  return places;
}

struct TakeOut {
  ConstView<std::int32_t> places;
  BodyView bodies;
  SCREE_HD void operator()(std::int64_t k) const { set_absent(places[k], bodies); }
};

template <class Space>
BodyTable table_of(const Array<std::int32_t, Space>& places, const Bodies<Space>& bodies) {
  Bodies<Space> those;
  for_each_field(
      [&places](const char*, auto& to, const auto& from) {
        parallel::gather("coming_and_going.table", from, places, to);
      },
      those, bodies);
  those.period = bodies.period;
  BodyTable on_host;
  copy_bodies(on_host, those);
  return on_host;
}

}  // namespace

template <class Space>
std::vector<BodyNumber> bodies_beyond(const World& world, const Bodies<Space>& bodies) {
  const IsFreeAnd is_outside{view_of(bodies), world.from, world.to, false};
  return numbers_at(places_where<Space>(is_outside, bodies.count()), bodies);
}

template <class Space>
std::vector<BodyNumber> bodies_in(const Region& region, const Bodies<Space>& bodies) {
  const IsFreeAnd is_inside{view_of(bodies), region.from, region.to, true};
  return numbers_at(places_where<Space>(is_inside, bodies.count()), bodies);
}

template <class Space>
BodyTable bodies_near(const Vec3& low, const Vec3& high, const Bodies<Space>& bodies) {
  BodyTable near = table_of(places_where<Space>(IsNear{view_of(bodies), low, high}, bodies.count()), bodies);
  std::vector<std::int32_t> order(near.id.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::sort(order, {}, [&near](std::int32_t k) { return near.id[static_cast<std::size_t>(k)]; });
  permute(near, order);
  return near;
}

template <class Space>
void bring_in(const BodyTable& those, Bodies<Space>& bodies) {
  const Array<std::int32_t, Space> places = places_of<Space>(those.id, bodies);
  Bodies<Space> come;
  copy_bodies(come, those);
  for_each_field(
      [&places](const char*, auto& to, const auto& from) {
        parallel::scatter("coming_and_going.bring_in", from, places, to);
      },
      bodies, std::as_const(come));
}

template <class Space>
BodyTable take_out(const std::vector<BodyNumber>& numbers, Bodies<Space>& bodies) {
  const Array<std::int32_t, Space> places = places_of<Space>(numbers, bodies);
  BodyTable gone = table_of(places, bodies);
  parallel::for_each<Space>("coming_and_going.take_out", places.size(),
                            TakeOut{places.view(), view_of(bodies)});
  return gone;
}

#define SCREE_INSTANTIATE(Space)                                                             \
  template std::vector<BodyNumber> bodies_beyond<Space>(const World&, const Bodies<Space>&); \
  template std::vector<BodyNumber> bodies_in<Space>(const Region&, const Bodies<Space>&);    \
  template BodyTable bodies_near<Space>(const Vec3&, const Vec3&, const Bodies<Space>&);     \
  template void bring_in<Space>(const BodyTable&, Bodies<Space>&);                           \
  template BodyTable take_out<Space>(const std::vector<BodyNumber>&, Bodies<Space>&);
SCREE_FOR_EACH_SPACE(SCREE_INSTANTIATE)
#undef SCREE_INSTANTIATE

}  // namespace scree
