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
  return bodies.velocity[k].norm() + turning_speed(bodies, k);
}

/// Finds the margin with which a body has room for its motion within dt (m).
struct MarginForMotion {
  ConstBodyView bodies;
  double dt;     ///< (s)
  double slack;  ///< (of smallest_size)
  ResponseParameters parameters;
  SCREE_HD double operator()(std::int64_t k, double speed) const {
    const Shape shape = bodies.shape[k];
    const double curving =
        bodies.mobility[k] == Mobility::prescribed ? parameters.prescribed_acceleration : 0.0;
    const double fall = (parameters.acceleration_of(k).norm() + curving) * dt * dt;
    return (is_surface(shape) ? 0.0 : slack * smallest_size(shape, bodies.size[k])) +
           tolerance::travel_factor * (speed * dt + fall);
  }
};

/// Sets contact margins, as contact_margins() does.
struct SetMargin {
  MarginForMotion margin_for;
  ApproachSpeeds approaches;
  View<double> margin;
  SCREE_HD void operator()(std::int64_t k) const {
    constexpr double most_change = 2;  // of a velocity by a contact, as a multiple of the approach speed
    const ConstBodyView& bodies = margin_for.bodies;
    if (bodies.mobility[k] == Mobility::fixed) {
      margin[k] = 0;
      return;
    }
    double speed = surface_speed(bodies, k);
    if (approaches.exist() && bodies.mobility[k] == Mobility::free)
      speed = fmin(speed, fmax(most_change * approaches.of(k), turning_speed(bodies, k)));
    margin[k] = margin_for(k, speed);
  }
};

/// Finds how far a body's surface may be from where it was, or would be on the body's path (m).
struct Deviation {
  ConstBodyView bodies;
  ConstView<Vec3> position;
  ConstView<Quat> orientation;
  BodyPaths paths;
  double passed;        ///< time since the bodies were at these positions (s)
  double half_substep;  ///< (s)
  /// Returns the distance now.
  SCREE_HD double operator()(std::int64_t k) const {
    if (bodies.mobility[k] == Mobility::fixed || bodies.mobility[k] == Mobility::absent) return 0;
    const Vec3 on_path = position[k] + paths.within(passed) * paths.velocity_of(bodies.mobility[k], k);
    const double moved = (bodies.position[k] - on_path).norm();
    if (bodies.shape[k] == Shape::sphere) return moved;
    // A turn by an angle moves a point by 2 r sin(angle / 2), which is at most 4 r sin(angle / 4).
    const Eigen::Vector4d& q = bodies.orientation[k].coeffs();
    const Eigen::Vector4d& before = orientation[k].coeffs();
    const double way = sqrt(fmin((q - before).squaredNorm(), (q + before).squaredNorm()));
    return moved + 2 * bounding_radius(bodies.shape[k], bodies.size[k]) * way;
  }
  SCREE_HD bool has_path(std::int64_t k) const {
    return paths.exist() && bodies.mobility[k] == Mobility::free;
  }
  /// Returns a bound on how much the distance to a path grows in the substep, if the body flies freely,
  /// without its accelerations (m).
  SCREE_HD double growth(std::int64_t k) const {
    const Vec3& velocity = bodies.velocity[k];
    double leaving = (velocity - paths.velocity[k]).norm();
    const bool is_on_path = paths.from <= passed - half_substep && passed + half_substep <= paths.until;
    if (!is_on_path) leaving = fmax(leaving, velocity.norm());
    return tolerance::travel_factor * half_substep * (leaving + turning_speed(bodies, k));
  }
};

/// Finds the margin that the box of a body must have for its contacts now, and for its flight in the substep.
/// A body without a path has room for its flight in its contact margin.
struct NeededMargin {
  Deviation deviation;
  MarginForMotion margin_for;
  SCREE_HD double operator()(std::int64_t k, double contact_margin) const {
    const double flight = deviation.has_path(k) ? margin_for(k, 0) + deviation.growth(k) : 0.0;
    return deviation(k) + fmax(contact_margin, flight);
  }
};

/// Sets the contact margin of a body, and notes whether it may touch something outside its box.
struct NoteOutside {
  SetMargin set_margin;
  NeededMargin needed;
  ConstView<double> box_margin;
  NearPairs now;
  BodiesOutside outside;
  SCREE_HD void operator()(std::int64_t k) const {
    set_margin(k);
    const Mobility mobility = now.bodies.mobility[k];
    if (mobility == Mobility::fixed || mobility == Mobility::absent) return;
    if (needed(k, now.margin[k]) > box_margin[k]) outside.add(now, k);
  }
};

struct LoadMargin {
  ConstView<double> margin;
  SCREE_HD double operator()(std::int64_t k) const { return margin[k]; }
};

struct RaiseTo {
  ConstView<double> least;
  View<double> margin;
  SCREE_HD void operator()(std::int64_t k) const { margin[k] = fmax(margin[k], least[k]); }
};

struct AddTravel {
  NeededMargin needed;
  View<double> margin;
  SCREE_HD void operator()(std::int64_t k) const { margin[k] = needed(k, margin[k]); }
};

/// Returns the speed at which a body may leave its place, or its path if approach speeds are given (m/s).
SCREE_HD double leaving_speed(const ConstBodyView& bodies, const ApproachSpeeds& approaches, std::int64_t k) {
  const double speed = surface_speed(bodies, k);
  if (!approaches.exist() || bodies.mobility[k] != Mobility::free) return speed;
  return fmax(fmin(speed, approaches.of(k)), turning_speed(bodies, k));
}

/// Sets the margin of a box: at least the wanted one plus the skin, and that of contacts within a substep. It
/// adds the distance that the body's surface travels at its own leaving_speed() or the typical one, whichever
/// is larger. Fast bodies are few, but without that room they alone would force new boxes around all bodies.
/// So would a slow body among fast ones, which pass their speed on to it.
struct SetBoxMargin {
  SetMargin contacts;  ///< sets the margin for contacts within a substep, with the skin
  ConstView<double> wanted;
  double life;     ///< time for which the margin shall have room (s)
  double typical;  ///< typical leaving_speed() of bodies, in their smallest_size (1/s)
  double most;     ///< largest margin, unless the wanted one is larger (m)
  SCREE_HD void operator()(std::int64_t k) const {
    contacts(k);
    const MarginForMotion& margin_for = contacts.margin_for;
    const ConstBodyView& bodies = margin_for.bodies;
    if (bodies.mobility[k] == Mobility::fixed || is_surface(bodies.shape[k])) return;
    const double size = smallest_size(bodies.shape[k], bodies.size[k]);
    const double skin = tolerance::pair_skin * size;
    const double speed = fmax(leaving_speed(bodies, contacts.approaches, k), typical * size);
    double& margin = contacts.margin[k];
    double least =
        fmax(fmax(margin, wanted[k] + skin), tolerance::contact_slack * size + skin + margin_for.dt * speed);
    // A body that something stops in the middle of a substep leaves its path at the speed that it had.
    if (contacts.approaches.exist()) least = fmax(least, margin_for(k, 0.5 * surface_speed(bodies, k)));
    margin = fmax(wanted[k], fmin(least + (life - margin_for.dt) * speed, most));
  }
};

/// Sums of rates: speeds of free bodies in their own smallest_size (1/s).
struct Rates {
  double leaving = 0;  ///< of leaving_speed()
  double surface = 0;  ///< of surface_speed()
  std::int64_t count = 0;
  SCREE_HD friend Rates operator+(const Rates& a, const Rates& b) {
    return {a.leaving + b.leaving, a.surface + b.surface, a.count + b.count};
  }
};
struct RatesOf {
  ConstBodyView bodies;
  ApproachSpeeds approaches;
  SCREE_HD Rates operator()(std::int64_t k) const {
    if (bodies.mobility[k] != Mobility::free) return {};
    const double size = smallest_size(bodies.shape[k], bodies.size[k]);
    return {leaving_speed(bodies, approaches, k) / size, surface_speed(bodies, k) / size, 1};
  }
};

/// Returns the mean rates of the free bodies.
template <class Space>
Rates mean_rates(const Bodies<Space>& bodies, const ApproachSpeeds& approaches) {
  const auto sum = parallel::sum_by_tiles<Rates, Space>("pairs.leaving", bodies.count(),
                                                        RatesOf{view_of(bodies), approaches});
  const auto count = static_cast<double>(std::max<std::int64_t>(sum.count, 1));
  return {sum.leaving / count, sum.surface / count, 1};
}

struct FreeSpeed {
  ConstBodyView bodies;
  SCREE_HD double operator()(std::int64_t k) const {
    return bodies.mobility[k] == Mobility::free ? bodies.velocity[k].norm() : 0.0;
  }
};

/// Returns the largest speed of a free body (m/s).
template <class Space>
double fastest(const Bodies<Space>& bodies) {
  return parallel::max<double, Space>("pairs.leaving", bodies.count(), FreeSpeed{view_of(bodies)}, 0.0);
}

}  // namespace

template <class Space>
void contact_margins(const Bodies<Space>& bodies, double dt, double slack,
                     const ResponseParameters& parameters, const ApproachSpeeds& approaches,
                     Array<double, Space>& margin) {
  margin.resize(bodies.count());
  parallel::for_each<Space>("pairs.margins", bodies.count(),
                            SetMargin{{view_of(bodies), dt, slack, parameters}, approaches, margin.view()});
}

template <class Space>
void raise_margins(const Array<double, Space>& least, Array<double, Space>& margin) {
  parallel::for_each<Space>("pairs.margins", margin.size(), RaiseTo{least.view(), margin.view()});
}

template <class Space>
double largest_margin(const Array<double, Space>& margin) {
  return parallel::max<double, Space>("pairs.margins", margin.size(), LoadMargin{margin.view()}, 0.0);
}

template <class Space>
bool FatBoxes<Space>::shall_follow_paths(const Bodies<Space>& bodies, const SearchTime& time,
                                         const ResponseParameters& parameters) {
  constexpr double most_share = 0.25;  // of what the period allows, for the motion within a substep
  if (parameters.accurate || mean_rates<Space>(bodies, {}).surface * time.substep < tolerance::little_travel)
    return false;
  return !bodies.period.exists ||
         fastest<Space>(bodies) * time.substep <= most_share * bodies.period.most_margin;
}

template <class Space>
void FatBoxes<Space>::put_around(const Bodies<Space>& bodies, const SearchTime& time,
                                 const ResponseParameters& parameters, const ApproachSpeeds& approaches,
                                 const Array<double, Space>& contact_margin) {
  const Rates rates = mean_rates<Space>(bodies, approaches);
  const double along = approaches.exist() ? rates.surface : 0;
  const double life = life_.choose(time.now, time.substep, rates.leaving, along);
  const Period& period = bodies.period;
  // In a period, half of the way to the second image is for the path.
  const double most = (approaches.exist() ? 0.5 : 1.0) * period.most_margin;
  margin_.resize(bodies.count());
  parallel::for_each<Space>("pairs.margins", bodies.count(),
                            SetBoxMargin{{{view_of(bodies), time.substep,
                                           tolerance::contact_slack + tolerance::pair_skin, parameters},
                                          approaches,
                                          margin_.view()},
                                         contact_margin.view(),
                                         life,
                                         rates.leaving,
                                         most});
  made_ = time.now;
  from_ = -0.5 * time.substep;
  // The paths go on for a substep, so that bodies are paired before they meet, and have room for it.
  until_ = (life_.planned() + 1) * time.substep;
  copy(position_, bodies.position);
  copy(orientation_, bodies.orientation);
  if (approaches.exist()) {
    copy(velocity_, bodies.velocity);
    const double speed = period.exists ? fastest<Space>(bodies) : 0;
    if (speed > 0) {
      const double most_time = std::max(period.most_margin - largest_margin<Space>(margin_), 0.0) / speed;
      from_ = std::max(from_, -most_time);
      until_ = std::min(until_, most_time);
    }
  } else {
    velocity_.resize(0);
  }
}

template <class Space>
auto FatBoxes<Space>::deviation(const Bodies<Space>& bodies, const SearchTime& time) const {
  return Deviation{view_of(bodies), position_.view(), orientation_.view(),
                   paths(),         time.now - made_, 0.5 * time.substep};
}

template <class Space>
bool FatBoxes<Space>::pairs_last(const Bodies<Space>& bodies, const SearchTime& time,
                                 const ResponseParameters& parameters, const ApproachSpeeds& approaches,
                                 Array<double, Space>& contact_margin) {
  contact_margin.resize(bodies.count());
  const ConstBodyView now = view_of(bodies);
  ConstBodyView then = now;
  then.position = std::as_const(position_).view();
  then.orientation = std::as_const(orientation_).view();
  const double half = 0.5 * time.substep;
  const MarginForMotion margin_for{now, time.foresight, tolerance::contact_slack, parameters};
  const NearPairs near_now{now, std::as_const(contact_margin).view(),
                           follow_paths() ? BodyPaths{now.velocity, -half, half} : BodyPaths{}};
  const NearPairs near_then{then, std::as_const(margin_).view(), paths()};
  parallel::for_each<Space>("pairs.out", bodies.count(),
                            NoteOutside{{margin_for, approaches, contact_margin.view()},
                                        {deviation(bodies, time), margin_for},
                                        near_then.margin,
                                        near_now,
                                        new_pairs_.start()});
  return !new_pairs_.exist(near_now, near_then);
}

template <class Space>
void FatBoxes<Space>::add_travel(const Bodies<Space>& bodies, const SearchTime& time,
                                 const ResponseParameters& parameters, Array<double, Space>& contact_margin) {
  life_.make_room();
  const MarginForMotion margin_for{view_of(bodies), time.foresight, tolerance::contact_slack, parameters};
  parallel::for_each<Space>("pairs.travel", bodies.count(),
                            AddTravel{{deviation(bodies, time), margin_for}, contact_margin.view()});
}

#define SCREE_INSTANTIATE(Space)                                                                 \
  template void contact_margins(const Bodies<Space>&, double, double, const ResponseParameters&, \
                                const ApproachSpeeds&, Array<double, Space>&);                   \
  template void raise_margins<Space>(const Array<double, Space>&, Array<double, Space>&);        \
  template double largest_margin<Space>(const Array<double, Space>&);                            \
  template class FatBoxes<Space>;
SCREE_FOR_EACH_SPACE(SCREE_INSTANTIATE)
#undef SCREE_INSTANTIATE

}  // namespace scree
