#include "sim/dynamics/motion.hpp"

#include "core/parallel.hpp"
#include "core/tolerances.hpp"
#include "sim/dynamics/rotation.hpp"

#include <limits>

namespace scree {

namespace {

struct Translate {
  BodyView bodies;
  double dt;
  SCREE_HD void operator()(std::int64_t k) const {
    if (bodies.mobility[k] == Mobility::free) bodies.position[k] += dt * bodies.velocity[k];
  }
};

/// Returns the drift of the body's energy (J).
struct Rotate {
  BodyView bodies;
  double dt;
  RotationOrder order;
  SCREE_HD double operator()(std::int64_t k) const {
    if (bodies.mobility[k] != Mobility::free) return 0;
    return rotate_freely(bodies.orientation[k], bodies.spin[k], bodies.inverse_inertia[k], dt, order);
  }
};

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
    const double fall = parameters.acceleration_of(k).norm() * dt * dt;
    const double radius = bounding_radius(shape, bodies.size[k]);
    const double turn = shape == Shape::sphere ? 0.0 : radius * bodies.spin[k].norm() * dt;
    margin[k] = (is_boundary(shape) ? 0.0 : slack * smallest_size(shape, bodies.size[k])) +
                tolerance::travel_factor * (bodies.velocity[k].norm() * dt + turn + fall);
  }
};

/// How far a body's surface may have moved from where it was (m).
struct Travel {
  ConstBodyView bodies;
  ConstView<Vec3> position;
  ConstView<Quat> orientation;
  SCREE_HD double operator()(std::int64_t k) const {
    if (bodies.mobility[k] == Mobility::fixed || bodies.mobility[k] == Mobility::absent) return 0;
    const double moved = (bodies.position[k] - position[k]).norm();
    if (bodies.shape[k] == Shape::sphere) return moved;
    return moved + bounding_radius(bodies.shape[k], bodies.size[k]) *
                       bodies.orientation[k].angularDistance(orientation[k]);
  }
};

/// Whether a body may touch something outside its box.
struct IsOut {
  Travel travel;
  ConstView<double> box_margin;
  ConstView<double> contact_margin;
  SCREE_HD int operator()(std::int64_t k) const {
    const Mobility mobility = travel.bodies.mobility[k];
    if (mobility == Mobility::fixed || mobility == Mobility::absent) return 0;
    return travel(k) + contact_margin[k] > box_margin[k] ? 1 : 0;
  }
};

struct AddTravel {
  Travel travel;
  View<double> margin;
  SCREE_HD void operator()(std::int64_t k) const { margin[k] += travel(k); }
};

/// At least the margin wanted, and the skin.
struct RaiseMargin {
  ConstBodyView bodies;
  ConstView<double> wanted;
  View<double> margin;
  SCREE_HD void operator()(std::int64_t k) const {
    if (bodies.mobility[k] == Mobility::fixed || is_boundary(bodies.shape[k])) return;
    const double skin = tolerance::pair_skin * smallest_size(bodies.shape[k], bodies.size[k]);
    margin[k] = fmax(margin[k], wanted[k] + skin);
  }
};

struct WorkOfForce {
  ConstBodyView bodies;
  ConstView<Vec3> start;
  ConstView<Vec3> acceleration;
  SCREE_HD double operator()(std::int64_t k) const {
    if (bodies.mobility[k] != Mobility::free) return 0;
    return acceleration[k].dot(bodies.position[k] - start[k]) / bodies.inverse_mass[k];
  }
};

struct LoadSolverBody {
  ConstBodyView bodies;
  View<SolverBody> solver;
  SCREE_HD void operator()(std::int64_t k) const {
    solver[k] = {bodies.velocity[k], bodies.spin[k], bodies.inverse_mass[k],
                 world_inverse_inertia(bodies.orientation[k], bodies.inverse_inertia[k])};
  }
};

struct BodyTotals {
  ConstBodyView bodies;
  Vec3 gravity;
  Vec3 reference;
  SCREE_HD Totals operator()(std::int64_t k) const { return totals_of_body(bodies, k, gravity, reference); }
};

struct Speed {
  ConstBodyView bodies;
  SCREE_HD double operator()(std::int64_t k) const {
    return bodies.mobility[k] == Mobility::free ? bodies.velocity[k].norm() : 0.0;
  }
};

SCREE_HD bool is_finite(const Vec3& v) {
  return fabs(v.x()) < HUGE_VAL && fabs(v.y()) < HUGE_VAL && fabs(v.z()) < HUGE_VAL;
}

/// The id of a body whose state is no longer finite; `none` for the others.
struct NonFinite {
  static constexpr std::int32_t none = std::numeric_limits<std::int32_t>::max();
  ConstBodyView bodies;
  SCREE_HD std::int32_t operator()(std::int64_t k) const {
    const bool finite =
        is_finite(bodies.position[k]) && is_finite(bodies.velocity[k]) && is_finite(bodies.spin[k]);
    return finite ? none : bodies.id[k];
  }
};

}  // namespace

double advance(Bodies<Host>& bodies, double dt, const ResponseParameters& parameters) {
  const std::int64_t n = bodies.count();
  const BodyView views = view_of(bodies);
  parallel::for_each<Host>("motion.translate", n, Translate{views, dt});
  if (!parameters.rotation) return 0;
  const Rotate rotate{views, dt, parameters.accurate ? RotationOrder::fourth : RotationOrder::second};
  if (parameters.gyroscopic) return parallel::sum<double, Host>("motion.rotate", n, rotate);
  parallel::for_each<Host>("motion.rotate", n, rotate);
  return 0;
}

void contact_margins(const Bodies<Host>& bodies, double dt, double slack,
                     const ResponseParameters& parameters, Array<double, Host>& margin) {
  margin.resize(bodies.count());
  parallel::for_each<Host>("motion.margins", bodies.count(),
                           SetMargin{view_of(bodies), margin.view(), dt, slack, parameters});
}

void FatBoxes::put_around(const Bodies<Host>& bodies, double dt, const ResponseParameters& parameters,
                          const Array<double, Host>& contact_margin) {
  contact_margins(bodies, dt, tolerance::contact_slack + tolerance::pair_skin, parameters, margin_);
  parallel::for_each<Host>("motion.margins", bodies.count(),
                           RaiseMargin{view_of(bodies), contact_margin.view(), margin_.view()});
  copy(position_, bodies.position);
  copy(orientation_, bodies.orientation);
}

bool FatBoxes::hold(const Bodies<Host>& bodies, const Array<double, Host>& contact_margin) const {
  const IsOut is_out{
      {view_of(bodies), position_.view(), orientation_.view()}, margin_.view(), contact_margin.view()};
  return parallel::max<int, Host>("motion.out", bodies.count(), is_out, 0) == 0;
}

void FatBoxes::add_travel(const Bodies<Host>& bodies, Array<double, Host>& contact_margin) const {
  parallel::for_each<Host>(
      "motion.travel", bodies.count(),
      AddTravel{{view_of(bodies), position_.view(), orientation_.view()}, contact_margin.view()});
}

double work_of_forces(const Bodies<Host>& bodies, const Array<Vec3, Host>& start,
                      ConstView<Vec3> acceleration) {
  return parallel::sum<double, Host>("motion.work", bodies.count(),
                                     WorkOfForce{view_of(bodies), start.view(), acceleration});
}

void load_solver_bodies(const Bodies<Host>& bodies, Array<SolverBody, Host>& solver) {
  solver.resize(bodies.count());
  parallel::for_each<Host>("motion.load", bodies.count(), LoadSolverBody{view_of(bodies), solver.view()});
}

Totals totals_of(const Bodies<Host>& bodies, const Vec3& gravity, const Vec3& reference) {
  return parallel::sum<Totals, Host>("motion.totals", bodies.count(),
                                     BodyTotals{view_of(bodies), gravity, reference});
}

double largest_speed(const Bodies<Host>& bodies) {
  return parallel::max<double, Host>("motion.speed", bodies.count(), Speed{view_of(bodies)}, 0.0);
}

std::int32_t first_non_finite(const Bodies<Host>& bodies) {
  const std::int32_t first = parallel::min<std::int32_t, Host>("motion.finite", bodies.count(),
                                                               NonFinite{view_of(bodies)}, NonFinite::none);
  return first == NonFinite::none ? -1 : first;
}

}  // namespace scree
