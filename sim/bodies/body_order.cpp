#include "sim/bodies/body_order.hpp"

#include "core/parallel.hpp"
#include "core/z_order.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <type_traits>
#include <utility>

namespace scree {

namespace {

struct FindPlace {
  ConstView<BodyNumber> number;
  View<std::int32_t> place_of;
  SCREE_HD void operator()(std::int64_t k) const {
    place_of[static_cast<std::int64_t>(number[k])] = static_cast<std::int32_t>(k);
  }
};

/// Writes the key and the place of each body, in the order of numbers: so a stable sort leaves the bodies of
/// one cell in this order.
struct FindCell {
  ConstBodyView bodies;
  Vec3 origin;
  double cell;
  View<std::uint64_t> key;
  View<std::int32_t> place;
  SCREE_HD void operator()(std::int64_t number) const {
    const std::int32_t k = bodies.place(BodyNumber{static_cast<std::int32_t>(number)});
    Vec3 x = bodies.position[k];
    bodies.period.wrap(x);
    x = (x - origin) / cell;
    place[number] = k;
    key[number] = bodies.mobility[k] == Mobility::absent
                      ? beyond_z_order
                      : z_order(coordinate(x.x()), coordinate(x.y()), coordinate(x.z()));
  }

 private:
  /// Returns the index of a cell along one axis. A position beyond all cells is in the first or the last one.
  SCREE_HD static std::uint32_t coordinate(double x) {
    constexpr double half = 1 << (z_order_bits - 1);
    return static_cast<std::uint32_t>(fmin(fmax(x + half, 0.0), 2 * half - 1));
  }
};

template <class T>
struct Move {
  ConstView<T> from;
  ConstView<std::int32_t> place_before;
  T* to;
  SCREE_HD void operator()(std::int64_t k) const { to[k] = from[place_before[k]]; }
};

template <class Space>
std::int64_t largest_element(Bodies<Space>& bodies) {
  std::size_t largest = 0;
  for_each_field([&largest](const char*, auto& field) { largest = std::max(largest, sizeof(*field.data())); },
                 bodies);
  return static_cast<std::int64_t>(largest);
}

/// Returns twice the geometric mean of the free bodies' bounding radii (m); 1 m if no body is free.
double typical_width(const BodyTable& bodies) {
  double sum = 0;
  double count = 0;
  for (std::size_t k = 0; k < bodies.size.size(); ++k) {
    if (bodies.mobility[k] != Mobility::free) continue;
    sum += std::log(bounding_radius(bodies.shape[k], bodies.size[k]));
    count += 1;
  }
  return count > 0 ? 2 * std::exp(sum / count) : 1.0;
}

}  // namespace

template <class Space>
void find_places(Bodies<Space>& bodies) {
  bodies.place_of.resize(bodies.count());
  parallel::for_each<Space>("body_order.places", bodies.count(),
                            FindPlace{std::as_const(bodies.id).view(), bodies.place_of.view()});
}

template <class Space>
void copy_by_number(BodyTable& out, const Bodies<Space>& bodies) {
  for_each_field(
      [&bodies](const char*, auto& to, const auto& from) {
        std::remove_cvref_t<decltype(from)> in_order;
        parallel::gather("body_order.by_number", from, bodies.place_of, in_order);
        copy(to, in_order);
      },
      out, bodies);
  out.period = bodies.period;
}

template <class Space>
BodyOrder<Space>::BodyOrder(const BodyTable& bodies, const Vec3& origin)
    : origin_(origin), cell_(typical_width(bodies)) {}

template <class Space>
void BodyOrder<Space>::sort(Bodies<Space>& bodies) {
  const std::int64_t n = bodies.count();
  // All memory is allocated before anything moves, so that the bodies stay whole if there is not enough.
  Array<std::byte, Space> moved(n * largest_element<Space>(bodies));
  Array<std::uint64_t, Space> key(n);
  place_before_.resize(n);
  parallel::for_each<Space>(
      "body_order.cells", n,
      FindCell{view_of(std::as_const(bodies)), origin_, cell_, key.view(), place_before_.view()});
  parallel::sort_by_key("body_order.sort", key, place_before_);
  for_each_field(
      [&](const char*, auto& field) {
        using T = std::remove_cvref_t<decltype(*field.data())>;
        auto* const to = reinterpret_cast<T*>(moved.data());
        parallel::for_each<Space>("body_order.move", n,
                                  Move<T>{std::as_const(field).view(), place_before_.view(), to});
        copy_bytes<Space, Space>(field.data(), to, static_cast<std::size_t>(n) * sizeof(T));
      },
      bodies);
  find_places<Space>(bodies);
}

#define SCREE_INSTANTIATE(Space)                                         \
  template void find_places<Space>(Bodies<Space>&);                      \
  template void copy_by_number<Space>(BodyTable&, const Bodies<Space>&); \
  template class BodyOrder<Space>;
SCREE_FOR_EACH_SPACE(SCREE_INSTANTIATE)
#undef SCREE_INSTANTIATE

}  // namespace scree
