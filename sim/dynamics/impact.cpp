#include "sim/dynamics/impact.hpp"

#include "core/parallel.hpp"
#include "core/tolerances.hpp"
#include "narrowphase/tube.hpp"
#include "sim/dynamics/colored.hpp"
#include "sim/dynamics/flight.hpp"
#include "sim/dynamics/rotation.hpp"

#include <utility>

namespace scree {

namespace {

/// The next impact of a contact: when, along which normal, and which of its points take part.
struct Impact {
  double time = HUGE_VAL;
  Vec3 normal;
  int count = 0;
  int point[Manifold::max_points] = {};
};

/// Everything that the functors below share.
struct ImpactStage {
  ConstView<Manifold> manifolds;
  double step;
  ResponseParameters parameters;
  BodyView bodies;
  View<SolverBody> solver;
  View<Contact> contacts;
  View<Vec3> shift;              ///< of the midpoint positions by impacts so far
  View<double> clock;            ///< time of each body's last impact in this substep
  View<std::int32_t> last_pass;  ///< in which each body was last hit
  View<Ledger> ledger;           ///< per contact

  Flight flight(std::int32_t body) const {
    return {bodies.position[body],
            solver[body].is_free() ? parameters.acceleration_of(body) : Vec3(Vec3::Zero())};
  }

  /// Geometry of a manifold's point after the shifts: gap, and the arms to the two surfaces.
  struct Point {
    double gap;
    Vec3 arm_i, arm_j;
  };
  Point point(const Manifold& m, int k) const {
    const Vec3 moved = shift[m.j] - shift[m.i];
    const double gap = m.points[k].gap + m.normal.dot(moved);
    const Vec3 middle = m.points[k].position + 0.5 * (shift[m.i] + shift[m.j]);
    return {gap, middle - (0.5 * gap) * m.normal - bodies.position[m.i],
            middle + (0.5 * gap) * m.normal - bodies.position[m.j]};
  }

  bool is_fast(double speed, const Contact& c) const {
    const double floor =
        tolerance::closing_speed * (solver[c.i].velocity.norm() + solver[c.j].velocity.norm());
    return speed < -fmax(parameters.restitution_threshold, floor);
  }

  /// True for a ball and the wall of a tube: its normal goes round with the ball.
  bool meets_wall(const Contact& c) const {
    const Shape i = bodies.shape[c.i];
    const Shape j = bodies.shape[c.j];
    return (i == Shape::tube || j == Shape::tube) && (i == Shape::sphere || j == Shape::sphere) &&
           manifolds[c.manifold].part == tube_wall;
  }

  Impact next_wall_impact_of(const Contact& c) const {
    const bool ball_first = bodies.shape[c.i] == Shape::sphere;
    const std::int32_t ball = ball_first ? c.i : c.j;
    const std::int32_t tube = ball_first ? c.j : c.i;
    const Vec3 axis = bodies.orientation[tube] * Vec3::UnitZ();
    const auto across = [&axis](const Vec3& v) { return Vec3(v - axis.dot(v) * axis); };
    const Vec3 offset = bodies.position[ball] - bodies.position[tube];
    // Spin about the axis leaves the wall where it is; spin across it does not.
    const Vec3 wall_velocity = solver[tube].velocity_at(axis.dot(offset) * axis);
    const WallImpact next = next_wall_impact({.flight = {across(offset), across(flight(ball).acceleration)},
                                              .velocity = across(solver[ball].velocity - wall_velocity),
                                              .reach = bodies.size[tube].x() - bodies.size[ball].x()},
                                             step, fmax(clock[c.i], clock[c.j]));
    if (next.time == HUGE_VAL || !is_fast(-next.speed, c)) return {};
    return {.time = next.time, .normal = ball_first ? next.outward : Vec3(-next.outward), .count = 1};
  }

  bool is_of_balls(const Contact& c) const {
    return bodies.shape[c.i] == Shape::sphere && bodies.shape[c.j] == Shape::sphere;
  }

  BallImpact next_meeting(const Contact& c) const {
    const Flight i = flight(c.i);
    const Flight j = flight(c.j);
    return next_ball_impact({.flight = {j.position - i.position, j.acceleration - i.acceleration},
                             .velocity = solver[c.j].velocity - solver[c.i].velocity,
                             .touching = bodies.size[c.i].x() + bodies.size[c.j].x()},
                            step, fmax(clock[c.i], clock[c.j]));
  }

  Impact next_ball_impact_of(const Contact& c) const {
    const BallImpact next = next_meeting(c);
    if (next.time == HUGE_VAL || !is_fast(next.speed, c)) return {};
    return {.time = next.time, .normal = next.normal, .count = 1};
  }

  Impact next_impact(const Contact& c) const {
    if (is_of_balls(c)) return next_ball_impact_of(c);
    if (meets_wall(c)) return next_wall_impact_of(c);
    Impact impact;
    const Manifold& m = manifolds[c.manifold];
    const SolverBody& bi = solver[c.i];
    const SolverBody& bj = solver[c.j];
    const double a = m.normal.dot(flight(c.j).acceleration - flight(c.i).acceleration);
    const double earliest = fmax(clock[c.i], clock[c.j]);
    double gap[Manifold::max_points];
    double u[Manifold::max_points];
    for (int k = 0; k < m.count; ++k) {
      const Point p = point(m, k);
      u[k] = m.normal.dot(bj.velocity_at(p.arm_j) - bi.velocity_at(p.arm_i));
      gap[k] = p.gap - 0.5 * step * u[k];  // at s = 0
      const double s = fmax(earliest, time_of_impact(gap[k], u[k], a));
      if (s < impact.time && is_fast(u[k] + a * s, c)) impact.time = s;
    }
    if (impact.time == HUGE_VAL) return impact;
    impact.normal = m.normal;
    const double touching = tolerance::closed_gap * fmin(smallest_size(bodies.shape[c.i], bodies.size[c.i]),
                                                         smallest_size(bodies.shape[c.j], bodies.size[c.j]));
    for (int k = 0; k < m.count; ++k) {
      const double s = impact.time;
      if (u[k] + a * s < 0 && gap[k] + u[k] * s + 0.5 * a * s * s <= touching)
        impact.point[impact.count++] = k;
    }
    return impact;
  }

  /// Where a body's surface point is at the time of impact, `direction` pointing out of the body.
  Vec3 surface(std::int32_t body, const Vec3& position, const Vec3& direction, const Vec3& arm,
               double tau) const {
    if (bodies.shape[body] == Shape::sphere) return position + bodies.size[body].x() * direction;
    return position + rotation_of(tau * solver[body].spin) * arm;
  }

  /// The common point. Bodies slide along one another between the midpoint and the impact: the more curved
  /// surface carries the point with it (sphere before box before plane or tube); between equals it lies in
  /// the middle.
  Vec3 touching_point(const Contact& c, const Vec3& normal, const Vec3& on_i, const Vec3& on_j) const {
    const Shape i = bodies.shape[c.i];
    const Shape j = bodies.shape[c.j];
    // The point of the wall at the midpoint says nothing of where the wall is at the impact.
    const double apart = meets_wall(c) ? 0.0 : normal.dot(on_j - on_i);
    if (i == j) return 0.5 * (on_i + on_j);
    return i < j ? Vec3(on_i + (0.5 * apart) * normal) : Vec3(on_j - (0.5 * apart) * normal);
  }

  /// Newton's law u+ = -e u- at all points of the impact at once, with Coulomb friction, at one
  /// configuration.
  void resolve(std::int64_t index, const Impact& impact, std::int32_t pass) const {
    Contact& c = contacts[index];
    const Manifold& m = manifolds[c.manifold];
    const double s = impact.time;
    const double tau = s - 0.5 * step;
    SolverBody i = solver[c.i];
    SolverBody j = solver[c.j];
    const Flight fi = flight(c.i);
    const Flight fj = flight(c.j);
    const Vec3 xi = fi.at(i.velocity, step, s);
    const Vec3 xj = fj.at(j.velocity, step, s);
    ContactRow rows[Manifold::max_points];
    RowCoupling couplings[Manifold::max_points];
    Vec3 before[Manifold::max_points];
    for (int k = 0; k < impact.count; ++k) {
      const Point p = point(m, impact.point[k]);
      const Vec3 touch = touching_point(c, impact.normal, surface(c.i, xi, impact.normal, p.arm_i, tau),
                                        surface(c.j, xj, -impact.normal, p.arm_j, tau));
      rows[k] = make_row(impact.normal, touch - xi, touch - xj, 0.0, i, j, couplings[k]);
    }
    i.velocity += s * fi.acceleration;
    j.velocity += s * fj.acceleration;
    for (int k = 0; k < impact.count; ++k) {
      before[k] = rows[k].relative_velocity(i, j);
      rows[k].target = -c.restitution * before[k].dot(impact.normal);
    }
    for (int sweep = 0; sweep < impact_sweeps; ++sweep) {
      double change = 0;
      double size = 0;
      Vec3 last[Manifold::max_points];
      for (int k = 0; k < impact.count; ++k) last[k] = rows[k].impulse;
      sweep_rows(rows, couplings, impact.count, impact.normal, c.friction, i, j);
      for (int k = 0; k < impact.count; ++k) {
        change += (rows[k].impulse - last[k]).norm();
        size += rows[k].impulse.norm();
      }
      if (change <= tolerance::impact_residual * size) break;
    }
    keep_from_gaining(rows, before, impact.count, i, j);
    Vec3 total = Vec3::Zero();
    for (int k = 0; k < impact.count; ++k) {
      const SolverBody& driver = i.is_free() ? j : i;
      const bool driven = !(i.is_free() && j.is_free());
      const Vec3 arm = i.is_free() ? rows[k].arm_j : rows[k].arm_i;
      ledger[index] =
          ledger[index] + account(rows[k].impulse, impact.normal, before[k], rows[k].relative_velocity(i, j),
                                  driven ? driver.velocity_at(arm) : Vec3(Vec3::Zero()),
                                  i.is_free() ? -1.0 : 1.0);
      total += rows[k].impulse;
    }
    c.impulse += total;
    store(c.i, i, fi, s, tau, pass);
    store(c.j, j, fj, s, tau, pass);
  }

  /// Newton's law with friction at several points, or at one whose Delassus matrix couples normal and
  /// tangents, can gain energy. What the impulses p move is a parabola in their common scale, p.u- + p.W p /
  /// 2; they are scaled down to where it is 0, which keeps momentum and the cone.
  void keep_from_gaining(ContactRow* rows, const Vec3* before, int count, SolverBody& i,
                         SolverBody& j) const {
    double linear = 0;
    double moved = 0;
    for (int k = 0; k < count; ++k) {
      linear += rows[k].impulse.dot(before[k]);
      moved += 0.5 * rows[k].impulse.dot(before[k] + rows[k].relative_velocity(i, j));
    }
    if (moved <= tolerance::impact_gain * fabs(linear)) return;
    const double scale = linear < 0 ? -linear / (moved - linear) : 0.0;
    for (int k = 0; k < count; ++k) {
      rows[k].push((scale - 1) * rows[k].impulse, i, j);
      rows[k].impulse *= scale;
    }
  }

  void store(std::int32_t body, const SolverBody& after, const Flight& flown, double s, double tau,
             std::int32_t pass) const {
    SolverBody& state = solver[body];
    if (!state.is_free()) return;
    const Vec3 velocity = after.velocity - s * flown.acceleration;
    const Vec3 move = -tau * (velocity - state.velocity);
    state.velocity = velocity;
    state.spin = after.spin;
    bodies.position[body] += move;
    shift[body] += move;
    clock[body] = s;
    last_pass[body] = pass;
  }

  /// False if nothing has changed for a contact since its visit in the pass before.
  bool is_due(const Contact& c, std::int32_t pass) const {
    if (c.restitution == 0 || c.loaded) return false;
    return pass == 0 || last_pass[c.i] >= pass - 1 || last_pass[c.j] >= pass - 1;
  }

  static constexpr int impact_sweeps = 200;
};

/// One visit of a contact: resolves its next impact if that falls into the substep.
struct VisitContact {
  ImpactStage stage;
  std::int64_t first;
  View<std::uint8_t> hit;
  std::int32_t pass;

  void operator()(std::int64_t k) const {
    const std::int64_t index = first + k;
    hit[index] = 0;
    const Contact& c = stage.contacts[index];
    if (!stage.is_due(c, pass)) return;
    const Impact impact = stage.next_impact(c);
    if (impact.count == 0 || impact.time > stage.step) return;
    stage.resolve(index, impact, pass);
    hit[index] = 1;
  }
};

struct MarkFlying {
  ImpactStage stage;
  void operator()(std::int64_t index) const {
    Contact& c = stage.contacts[index];
    if (c.restitution == 0 || c.loaded) return;
    if (stage.is_of_balls(c)) {
      // Their flight is exact: what does not meet passes by, whatever the midpoint's normal says.
      c.flying = stage.next_meeting(c).time > stage.step;
    } else {
      const double time = stage.next_impact(c).time;
      c.flying = time > stage.step && time < HUGE_VAL;
    }
  }
};

struct AnyHit {
  ConstView<std::uint8_t> hit;
  SCREE_HD std::int64_t operator()(std::int64_t k) const { return hit[k]; }
};

struct LoadLedger {
  ConstView<Ledger> ledger;
  SCREE_HD Ledger operator()(std::int64_t k) const { return ledger[k]; }
};

constexpr int chain_passes = 64;

}  // namespace

Ledger ImpactSolver::resolve(const ImpactProblem& problem, const ResponseParameters& parameters,
                             Array<SolverBody, Host>& solver, ContactSet& set, Counters& counters) {
  const std::int64_t n = set.contacts.size();
  set.shift.resize(solver.size());
  parallel::fill("impact.reset", set.shift, Vec3(Vec3::Zero()));
  if (!parameters.restitution || n == 0) return {};
  clock_.resize(solver.size());
  last_pass_.resize(solver.size());
  ledger_.resize(n);
  hit_.resize(n);
  parallel::fill("impact.reset", clock_, 0.0);
  parallel::fill("impact.reset", last_pass_, std::int32_t{-2});
  parallel::fill("impact.reset", ledger_, Ledger{});
  const ImpactStage stage{problem.manifolds, problem.step,        parameters,       problem.bodies,
                          solver.view(),     set.contacts.view(), set.shift.view(), clock_.view(),
                          last_pass_.view(), ledger_.view()};
  bool closing = true;
  for (std::int32_t pass = 0; pass < chain_passes && closing; ++pass) {
    for_each_color("impact.visit", set.coloring, [&](std::int64_t first) {
      return VisitContact{stage, first, hit_.view(), pass};
    });
    const auto hits =
        parallel::sum<std::int64_t, Host>("impact.count", n, AnyHit{std::as_const(hit_).view()});
    counters.impacts += hits;
    closing = hits > 0;
  }
  if (closing) ++counters.unfinished_impacts;
  parallel::for_each<Host>("impact.flying", n, MarkFlying{stage});
  return parallel::sum<Ledger, Host>("impact.ledger", n, LoadLedger{std::as_const(ledger_).view()});
}

}  // namespace scree
