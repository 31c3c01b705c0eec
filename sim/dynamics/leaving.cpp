#include "sim/dynamics/leaving.hpp"

#include "core/parallel.hpp"

#include <utility>

namespace scree {

namespace {

struct IsBeyond {
  ConstBodyView bodies;
  Vec3 low;
  Vec3 high;
  SCREE_HD int operator()(std::int64_t k) const {
    if (bodies.mobility[k] != Mobility::free) return 0;
    const Vec3& x = bodies.position[k];
    return (x.array() < low.array()).any() || (x.array() > high.array()).any() ? 1 : 0;
  }
};

struct IdBeyond {
  static constexpr std::int32_t none = -1;
  IsBeyond is_beyond;
  SCREE_HD std::int32_t operator()(std::int64_t k) const {
    return is_beyond(k) != 0 ? static_cast<std::int32_t>(k) : none;
  }
};

template <class T>
struct Gather {
  ConstView<T> from;
  ConstView<std::int32_t> ids;
  View<T> to;
  SCREE_HD void operator()(std::int64_t k) const { to[k] = from[ids[k]]; }
};

struct TakeOut {
  ConstView<std::int32_t> ids;
  BodyView bodies;
  SCREE_HD void operator()(std::int64_t k) const { set_absent(ids[k], bodies); }
};

template <class T, class Space>
void gather(const Array<T, Space>& from, const Array<std::int32_t, Space>& ids, Array<T, Space>& to) {
  to.resize(ids.size());
  parallel::for_each<Space>("leaving.gather", ids.size(), Gather<T>{from.view(), ids.view(), to.view()});
}

}  // namespace

template <class Space>
std::vector<std::int32_t> bodies_beyond(const World& world, const Bodies<Space>& bodies) {
  const IsBeyond is_beyond{view_of(bodies), world.from, world.to};
  if (parallel::max<int, Space>("leaving.any", bodies.count(), is_beyond, 0) == 0) return {};
  Array<std::int32_t, Space> ids;
  parallel::select<Space>("leaving.ids", bodies.count(), IdBeyond{is_beyond}, IdBeyond::none, ids);
  return to_vector(ids);
}

template <class Space>
BodyTable take_out(const std::vector<std::int32_t>& ids, Bodies<Space>& bodies) {
  Array<std::int32_t, Space> those;
  copy(those, ids);
  Bodies<Space> gone;
  for_each_field([&those](const char*, auto& to, const auto& from) { gather(from, those, to); }, gone,
                 std::as_const(bodies));
  parallel::for_each<Space>("leaving.take_out", those.size(),
                            TakeOut{std::as_const(those).view(), view_of(bodies)});
  BodyTable on_host;
  copy_bodies(on_host, gone);
  return on_host;
}

#define SCREE_INSTANTIATE(Space)                                                               \
  template std::vector<std::int32_t> bodies_beyond<Space>(const World&, const Bodies<Space>&); \
  template BodyTable take_out<Space>(const std::vector<std::int32_t>&, Bodies<Space>&);
SCREE_FOR_EACH_SPACE(SCREE_INSTANTIATE)
#undef SCREE_INSTANTIATE

}  // namespace scree
