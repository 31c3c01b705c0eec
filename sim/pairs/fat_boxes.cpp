#include "sim/pairs/fat_boxes.hpp"

#include "core/parallel.hpp"
#include "core/space_tiles.hpp"
#include "core/tolerances.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace scree {

namespace {

/// Returns a bound on the speeds of all points of a body (m/s).
SCREE_HD double surface_speed(const ConstBodyView& bodies, std::int64_t k) {
  const Shape shape = bodies.shape[k];
  const double turning =
      shape == Shape::sphere ? 0.0 : bounding_radius(shape, bodies.size[k]) * bodies.spin[k].norm();
  return bodies.velocity[k].norm() + turning;
}

struct SetMargin {
  ConstBodyView bodies;
  View<double> margin;
  double dt;
  double slack;
  ResponseParameters parameters;
  SCREE_HD void operator()(std::int64_t k) const {
    const Shape shape = bodies.shape[k];
    if (bodies.mobility[k] == Mobility::fixed) {
      margin[k] = 0;
      return;
    }
    const double curving =
        bodies.mobility[k] == Mobility::prescribed ? parameters.prescribed_acceleration : 0.0;
    const double fall = (parameters.acceleration_of(k).norm() + curving) * dt * dt;
    margin[k] = (is_surface(shape) ? 0.0 : slack * smallest_size(shape, bodies.size[k])) +
                tolerance::travel_factor * (surface_speed(bodies, k) * dt + fall);
  }
};

/// Finds how far a body's surface may have moved from where it was (m).
struct Travel {
  ConstBodyView bodies;
  ConstView<Vec3> position;
  ConstView<Quat> orientation;
  SCREE_HD double operator()(std::int64_t k) const {
    if (bodies.mobility[k] == Mobility::fixed || bodies.mobility[k] == Mobility::absent) return 0;
    const double moved = (bodies.position[k] - position[k]).norm();
    if (bodies.shape[k] == Shape::sphere) return moved;
    // A turn by an angle moves a point by 2 r sin(angle / 2), which is at most 4 r sin(angle / 4).
    const Eigen::Vector4d& q = bodies.orientation[k].coeffs();
    const Eigen::Vector4d& before = orientation[k].coeffs();
    const double way = sqrt(fmin((q - before).squaredNorm(), (q + before).squaredNorm()));
    return moved + 2 * bounding_radius(bodies.shape[k], bodies.size[k]) * way;
  }
};

/// Finds whether a body may touch something outside its box.
struct IsOut {
  Travel travel;
  ConstView<double> box_margin;
  ConstView<double> contact_margin;
  SCREE_HD bool operator()(std::int64_t k) const {
    const Mobility mobility = travel.bodies.mobility[k];
    if (mobility == Mobility::fixed || mobility == Mobility::absent) return false;
    return travel(k) + contact_margin[k] > box_margin[k];
  }
};

struct NoteOutside {
  IsOut is_out;
  BodiesOutside outside;
  SCREE_HD void operator()(std::int64_t k) const {
    if (is_out(k)) outside.add({is_out.travel.bodies, is_out.contact_margin}, k);
  }
};

/// Sets the contact margin of a body before it is checked.
struct NoteOutsideWithMargin {
  SetMargin margins;
  NoteOutside note;
  SCREE_HD void operator()(std::int64_t k) const {
    margins(k);
    note(k);
  }
};

struct LoadMargin {
  ConstView<double> margin;
  SCREE_HD double operator()(std::int64_t k) const { return margin[k]; }
};

struct AddTravel {
  Travel travel;
  View<double> margin;
  SCREE_HD void operator()(std::int64_t k) const { margin[k] += travel(k); }
};

/// Raises the margin of a box to at least the wanted one plus the skin, and adds the distance that the body's
/// surface travels at its own speed or the typical one, whichever is larger. Fast bodies are few, but without
/// that room they alone would force new boxes around all bodies. So would a slow body among fast ones, which
/// pass their speed on to it.
struct RaiseMargin {
  ConstBodyView bodies;
  ConstView<double> wanted;
  View<double> margin;
  double substep;  ///< length of a substep: the margin has room for contacts within it (s)
  double life;     ///< time for which the margin shall have room (s)
  double typical;  ///< typical speed of bodies, in their smallest_size (1/s)
  double most;     ///< largest margin, unless the wanted one is larger (m)
  SCREE_HD void operator()(std::int64_t k) const {
    if (bodies.mobility[k] == Mobility::fixed || is_surface(bodies.shape[k])) return;
    const double size = smallest_size(bodies.shape[k], bodies.size[k]);
    const double skin = tolerance::pair_skin * size;
    const double speed = fmax(surface_speed(bodies, k), typical * size);
    const double contacts =
        fmax(fmax(margin[k], wanted[k] + skin), tolerance::contact_slack * size + skin + substep * speed);
    margin[k] = fmax(wanted[k], fmin(contacts + (life - substep) * speed, most));
  }
};

/// Rates at which bodies leave their positions: speeds in their own smallest_size (1/s).
struct Leaving {
  double rates = 0;  ///< sum of the rates (1/s)
  std::int64_t count = 0;
  SCREE_HD friend Leaving operator+(const Leaving& a, const Leaving& b) {
    return {a.rates + b.rates, a.count + b.count};
  }
};
struct LeavingOf {
  ConstBodyView bodies;
  SCREE_HD Leaving operator()(std::int64_t k) const {
    if (bodies.mobility[k] != Mobility::free) return {};
    return {surface_speed(bodies, k) / smallest_size(bodies.shape[k], bodies.size[k]), 1};
  }
};

}  // namespace

template <class Space>
void contact_margins(const Bodies<Space>& bodies, double dt, double slack,
                     const ResponseParameters& parameters, Array<double, Space>& margin) {
  margin.resize(bodies.count());
  parallel::for_each<Space>("pairs.margins", bodies.count(),
                            SetMargin{view_of(bodies), margin.view(), dt, slack, parameters});
}

template <class Space>
double largest_margin(const Array<double, Space>& margin) {
  return parallel::max<double, Space>("pairs.margins", margin.size(), LoadMargin{margin.view()}, 0.0);
}

template <class Space>
void FatBoxes<Space>::put_around(const Bodies<Space>& bodies, double now, double substep,
                                 const ResponseParameters& parameters,
                                 const Array<double, Space>& contact_margin) {
  const auto leaving =
      parallel::sum_by_tiles<Leaving, Space>("pairs.leaving", bodies.count(), LeavingOf{view_of(bodies)});
  rate_ = leaving.rates / static_cast<double>(std::max<std::int64_t>(leaving.count, 1));
  const double life = life_.choose(now, substep, rate_);
  contact_margins(bodies, substep, tolerance::contact_slack + tolerance::pair_skin, parameters, margin_);
  parallel::for_each<Space>("pairs.margins", bodies.count(),
                            RaiseMargin{view_of(bodies), contact_margin.view(), margin_.view(), substep, life,
                                        rate_, bodies.period.most_margin});
  copy(position_, bodies.position);
  copy(orientation_, bodies.orientation);
}

template <class Space>
bool FatBoxes<Space>::pairs_last(const Bodies<Space>& bodies, const Array<double, Space>& contact_margin) {
  const ConstBodyView now = view_of(bodies);
  const IsOut is_out{{now, position_.view(), orientation_.view()}, margin_.view(), contact_margin.view()};
  parallel::for_each<Space>("pairs.out", bodies.count(), NoteOutside{is_out, new_pairs_.start()});
  return pairs_last_now(now, contact_margin);
}

template <class Space>
bool FatBoxes<Space>::pairs_last(const Bodies<Space>& bodies, double dt, const ResponseParameters& parameters,
                                 Array<double, Space>& contact_margin) {
  contact_margin.resize(bodies.count());
  const ConstBodyView now = view_of(bodies);
  const SetMargin margins{now, contact_margin.view(), dt, tolerance::contact_slack, parameters};
  const IsOut is_out{
      {now, position_.view(), orientation_.view()}, margin_.view(), std::as_const(contact_margin).view()};
  parallel::for_each<Space>("pairs.out", bodies.count(),
                            NoteOutsideWithMargin{margins, {is_out, new_pairs_.start()}});
  return pairs_last_now(now, contact_margin);
}

template <class Space>
bool FatBoxes<Space>::pairs_last_now(const ConstBodyView& now, const Array<double, Space>& contact_margin) {
  ConstBodyView then = now;
  then.position = std::as_const(position_).view();
  then.orientation = std::as_const(orientation_).view();
  return !new_pairs_.exist({now, contact_margin.view()}, {then, std::as_const(margin_).view()});
}

template <class Space>
void FatBoxes<Space>::add_travel(const Bodies<Space>& bodies, Array<double, Space>& contact_margin) {
  life_.make_room();
  parallel::for_each<Space>(
      "pairs.travel", bodies.count(),
      AddTravel{{view_of(bodies), std::as_const(position_).view(), std::as_const(orientation_).view()},
                contact_margin.view()});
}

#define SCREE_INSTANTIATE(Space)                                                                 \
  template void contact_margins(const Bodies<Space>&, double, double, const ResponseParameters&, \
                                Array<double, Space>&);                                          \
  template double largest_margin<Space>(const Array<double, Space>&);                            \
  template class FatBoxes<Space>;
SCREE_FOR_EACH_SPACE(SCREE_INSTANTIATE)
#undef SCREE_INSTANTIATE

}  // namespace scree
