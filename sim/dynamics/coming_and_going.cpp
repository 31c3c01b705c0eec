#include "sim/dynamics/coming_and_going.hpp"

#include "core/parallel.hpp"

#include <type_traits>
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
struct IdWhere {
  static constexpr std::int32_t none = -1;
  Is is;
  SCREE_HD std::int32_t operator()(std::int64_t k) const {
    return is(k) != 0 ? static_cast<std::int32_t>(k) : none;
  }
};

/// In order; none costs one pass that writes nothing.
template <class Space, class Is>
Array<std::int32_t, Space> ids_where(const Is& is, std::int64_t count) {
  Array<std::int32_t, Space> ids;
  if (parallel::max<int, Space>("coming_and_going.any", count, is, 0) == 0) return ids;
  parallel::select<Space>("coming_and_going.ids", count, IdWhere<Is>{is}, IdWhere<Is>::none, ids);
  return ids;
}

template <class T>
struct Gather {
  ConstView<T> from;
  ConstView<std::int32_t> ids;
  View<T> to;
  SCREE_HD void operator()(std::int64_t k) const { to[k] = from[ids[k]]; }
};

template <class T>
struct Spread {
  ConstView<T> from;
  ConstView<std::int32_t> ids;
  View<T> to;
  SCREE_HD void operator()(std::int64_t k) const { to[ids[k]] = from[k]; }
};

struct TakeOut {
  ConstView<std::int32_t> ids;
  BodyView bodies;
  SCREE_HD void operator()(std::int64_t k) const { set_absent(ids[k], bodies); }
};

template <class T, class Space>
void gather(const Array<T, Space>& from, const Array<std::int32_t, Space>& ids, Array<T, Space>& to) {
  to.resize(ids.size());
  parallel::for_each<Space>("coming_and_going.gather", ids.size(),
                            Gather<T>{from.view(), ids.view(), to.view()});
}

template <class Space>
BodyTable table_of(const Array<std::int32_t, Space>& ids, const Bodies<Space>& bodies) {
  Bodies<Space> those;
  for_each_field([&ids](const char*, auto& to, const auto& from) { gather(from, ids, to); }, those, bodies);
  those.period = bodies.period;
  BodyTable on_host;
  copy_bodies(on_host, those);
  return on_host;
}

}  // namespace

template <class Space>
std::vector<std::int32_t> bodies_beyond(const World& world, const Bodies<Space>& bodies) {
  return to_vector(ids_where<Space>(IsFreeAnd{view_of(bodies), world.from, world.to, false}, bodies.count()));
}

template <class Space>
std::vector<std::int32_t> bodies_in(const Region& region, const Bodies<Space>& bodies) {
  return to_vector(
      ids_where<Space>(IsFreeAnd{view_of(bodies), region.from, region.to, true}, bodies.count()));
}

template <class Space>
BodyTable bodies_near(const Vec3& low, const Vec3& high, const Bodies<Space>& bodies) {
  return table_of<Space>(ids_where<Space>(IsNear{view_of(bodies), low, high}, bodies.count()), bodies);
}

template <class Space>
void bring_in(const BodyTable& those, Bodies<Space>& bodies) {
  Array<std::int32_t, Space> ids;
  copy(ids, those.id);
  Bodies<Space> come;
  copy_bodies(come, those);
  for_each_field(
      [&ids](const char*, auto& to, const auto& from) {
        using T = std::decay_t<decltype(to.view()[0])>;
        parallel::for_each<Space>("coming_and_going.bring_in", ids.size(),
                                  Spread<T>{from.view(), std::as_const(ids).view(), to.view()});
      },
      bodies, std::as_const(come));
}

template <class Space>
BodyTable take_out(const std::vector<std::int32_t>& ids, Bodies<Space>& bodies) {
  Array<std::int32_t, Space> those;
  copy(those, ids);
  BodyTable gone = table_of<Space>(those, std::as_const(bodies));
  parallel::for_each<Space>("coming_and_going.take_out", those.size(),
                            TakeOut{std::as_const(those).view(), view_of(bodies)});
  return gone;
}

#define SCREE_INSTANTIATE(Space)                                                               \
  template std::vector<std::int32_t> bodies_beyond<Space>(const World&, const Bodies<Space>&); \
  template std::vector<std::int32_t> bodies_in<Space>(const Region&, const Bodies<Space>&);    \
  template BodyTable bodies_near<Space>(const Vec3&, const Vec3&, const Bodies<Space>&);       \
  template void bring_in<Space>(const BodyTable&, Bodies<Space>&);                             \
  template BodyTable take_out<Space>(const std::vector<std::int32_t>&, Bodies<Space>&);
SCREE_FOR_EACH_SPACE(SCREE_INSTANTIATE)
#undef SCREE_INSTANTIATE

}  // namespace scree
