#include "sim/dynamics/motion.hpp"

#include "core/parallel.hpp"
#include "core/tolerances.hpp"
#include "sim/dynamics/rotation.hpp"

namespace scree {

namespace {

struct Translate {
  BodyView bodies;
  double dt;
  SCREE_HD void operator()(std::int64_t k) const {
    if (bodies.mobility[k] == Mobility::free) bodies.position[k] += dt * bodies.velocity[k];
  }
};

struct Rotate {
  BodyView bodies;
  double dt;
  SCREE_HD void operator()(std::int64_t k) const {
    if (bodies.mobility[k] != Mobility::free) return;
    rotate_freely(bodies.orientation[k], bodies.spin[k], bodies.inverse_inertia[k], dt);
  }
};

struct RotationalEnergy {
  ConstBodyView bodies;
  SCREE_HD double operator()(std::int64_t k) const {
    const Vec3& inverse_inertia = bodies.inverse_inertia[k];
    if (has_equal_moments(inverse_inertia)) return 0;  // does not drift
    return rotational_energy(bodies.orientation[k], bodies.spin[k], inverse_inertia);
  }
};

struct SetMargin {
  ConstBodyView bodies;
  View<double> margin;
  double dt;
  double fall;
  SCREE_HD void operator()(std::int64_t k) const {
    const Shape shape = bodies.shape[k];
    if (bodies.mobility[k] == Mobility::fixed) {
      margin[k] = 0;
      return;
    }
    const double slack =
        is_boundary(shape) ? 0.0 : tolerance::contact_slack * smallest_size(shape, bodies.size[k]);
    const double radius = bounding_radius(shape, bodies.size[k]);
    const double turn = shape == Shape::sphere ? 0.0 : radius * bodies.spin[k].norm() * dt;
    margin[k] = slack + tolerance::travel_factor * (bodies.velocity[k].norm() * dt + turn + fall);
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

}  // namespace

double advance(Bodies<Host>& bodies, double dt, const ResponseParameters& parameters) {
  const std::int64_t n = bodies.count();
  const BodyView views = view_of(bodies);
  parallel::for_each<Host>("motion.translate", n, Translate{views, dt});
  if (!parameters.rotation) return 0;
  if (!parameters.gyroscopic) {
    parallel::for_each<Host>("motion.rotate", n, Rotate{views, dt});
    return 0;
  }
  const RotationalEnergy energy{view_of(std::as_const(bodies))};
  const double before = parallel::sum<double, Host>("motion.energy", n, energy);
  parallel::for_each<Host>("motion.rotate", n, Rotate{views, dt});
  return parallel::sum<double, Host>("motion.energy", n, energy) - before;
}

void contact_margins(const Bodies<Host>& bodies, double dt, const Vec3& gravity,
                     Array<double, Host>& margin) {
  margin.resize(bodies.count());
  parallel::for_each<Host>("motion.margins", bodies.count(),
                           SetMargin{view_of(bodies), margin.view(), dt, gravity.norm() * dt * dt});
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

}  // namespace scree
