#include "sim/dynamics/impact.hpp"

#include "core/parallel.hpp"
#include "core/tolerances.hpp"
#include "sim/dynamics/rotation.hpp"

#include <algorithm>
#include <queue>
#include <tuple>

namespace scree {

namespace {

/// Impacts of one body in a flight after which it bounces no more, and after which it has no more.
constexpr std::int32_t most_bounces = 64;
constexpr std::int32_t most_hits = 256;

/// What may meet, as everything below sees it.
struct FlightStage {
  FlightStage(const ImpactProblem& p, const ResponseParameters& r, const BodyView& b, FlightLog& log)
      : problem(p),
        parameters(r),
        bodies(b),
        clock(log.clock.view()),
        hits(log.hits.view()),
        reach(log.reach.view()) {}

  ImpactProblem problem;
  ResponseParameters parameters;
  BodyView bodies;
  View<double> clock;
  View<std::int32_t> hits;
  View<double> reach;

  bool is_free(std::int32_t body) const { return bodies.mobility[body] == Mobility::free; }

  BodyFlight flight(std::int32_t body) const {
    return {.shape = bodies.shape[body],
            .size = bodies.size[body],
            .inverse_inertia = bodies.inverse_inertia[body],
            .position = bodies.position[body],
            .orientation = bodies.orientation[body],
            .velocity = bodies.velocity[body] - kick_of(body),
            .spin = parameters.rotation || !is_free(body) ? bodies.spin[body] : Vec3(Vec3::Zero()),
            .acceleration = is_free(body) ? parameters.acceleration_of(body) : Vec3(Vec3::Zero()),
            .midpoint = 0.5 * problem.step};
  }

  /// What the bodies' velocities have of the substep's kick already (m/s).
  Vec3 kick_of(std::int32_t body) const {
    return problem.from > 0 && is_free(body) ? Vec3(problem.step * parameters.acceleration_of(body))
                                             : Vec3(Vec3::Zero());
  }

  /// The slowest approach that bounces on a part without load (m/s).
  double slowest_bounce(std::int32_t i, std::int32_t j) const {
    const double restitution = problem.laws.between(i, j).restitution;
    if (!parameters.restitution || restitution == 0) return HUGE_VAL;
    const double rounding =
        tolerance::closing_speed * (bodies.velocity[i].norm() + bodies.velocity[j].norm());
    return std::max(parameters.restitution_threshold.of(restitution), rounding);
  }

  /// Two bodies until the end of the substep; no meeting of theirs counts yet.
  PairFlight pair_of(std::int32_t i, std::int32_t j, double until) const {
    PairFlight pair{.i = flight(i), .j = flight(j), .until = until, .slowest = {}};
    std::fill_n(pair.slowest, PairFlight::parts, HUGE_VAL);
    return pair;
  }

  /// Bound on how far any point of a body's surface gets from where it is at the midpoint (m).
  double reach_of(std::int32_t body) const {
    if (bodies.mobility[body] == Mobility::absent) return 0;
    return fastest_surface(flight(body), problem.step) * (0.5 * problem.step);
  }

  /// True if two bodies do not come near one another in the substep.
  bool are_far(std::int32_t i, std::int32_t j) const {
    const bool boundary_i = is_boundary(bodies.shape[i]);
    const bool boundary_j = is_boundary(bodies.shape[j]);
    double near = reach[i] + reach[j];
    if (!boundary_i) near += bounding_radius(bodies.shape[i], bodies.size[i]);
    if (!boundary_j) near += bounding_radius(bodies.shape[j], bodies.size[j]);
    const Vec3 offset = bodies.position[j] - bodies.position[i];
    if (!boundary_i && !boundary_j) return offset.squaredNorm() > near * near;
    const std::int32_t boundary = boundary_i ? i : j;
    if (bodies.shape[boundary] == Shape::tube) return false;
    const Vec3 up = bodies.orientation[boundary] * Vec3::UnitZ();
    return (boundary_i ? 1.0 : -1.0) * up.dot(offset) > near;
  }

  /// The next impact of two bodies.
  Meeting next(std::int32_t i, std::int32_t j) const {
    if (!is_free(i) && !is_free(j)) return {};
    if (bodies.mobility[i] == Mobility::absent || bodies.mobility[j] == Mobility::absent) return {};
    if (are_far(i, j) || std::max(hits[i], hits[j]) >= most_hits) return {};
    const double earliest = std::max(clock[i], clock[j]);
    if (!(earliest < problem.step)) return {};
    PairFlight pair = pair_of(i, j, problem.step);
    pair.farthest = tolerance::deep_approach * std::min(smallest_size(pair.i.shape, pair.i.size),
                                                        smallest_size(pair.j.shape, pair.j.size));
    const double fastest = fastest_approach(pair);
    const double slowest = problem.bounces ? slowest_bounce(i, j) : HUGE_VAL;
    const bool may_bounce = fastest > slowest;
    const bool may_go_deep = parameters.continuous && fastest * (problem.step - earliest) > pair.farthest;
    if (!(may_bounce || may_go_deep)) return {};
    if (may_bounce) {
      for (int part = 0; part < PairFlight::parts; ++part) {
        if (!problem.memory.is_loaded(i, j, part)) pair.slowest[part] = slowest;
      }
    }
    if (!may_go_deep) pair.farthest = HUGE_VAL;
    return next_meeting(pair, earliest);
  }

  /// Newton's law u+ = -e u- at all points that touch and close, at one configuration, with Coulomb
  /// friction. False if none does.
  bool resolve(std::int32_t i, std::int32_t j, const Meeting& meeting, Impact& impact, Ledger& ledger) const {
    const double s = meeting.time;
    const BodyFlight flight_i = flight(i);
    const BodyFlight flight_j = flight(j);
    const BodyInstant at_i = instant_of(flight_i, s);
    const BodyInstant at_j = instant_of(flight_j, s);
    const double touching = tolerance::closed_gap * std::min(smallest_size(flight_i.shape, flight_i.size),
                                                             smallest_size(flight_j.shape, flight_j.size));
    Manifold m;
    if (!contact_at(at_i, flight_i.shape, at_j, flight_j.shape, meeting.part, touching, m)) return false;
    SolverBody a = solver_body(i, at_i);
    SolverBody b = solver_body(j, at_j);
    ContactRow rows[Manifold::max_points];
    RowCoupling couplings[Manifold::max_points];
    Vec3 before[Manifold::max_points];
    Vec3 middle = Vec3::Zero();
    double fastest = 0;
    int count = 0;
    for (int k = 0; k < m.count; ++k) {
      const double closing = closing_speed(m, k, at_i, at_j);
      if (!(closing > 0)) continue;
      const Vec3& point = m.points[k].position;
      rows[count] = make_row(m.normal, point - at_i.solid.position, point - at_j.solid.position, 0.0, a, b,
                             couplings[count]);
      before[count] = rows[count].relative_velocity(a, b);
      fastest = std::max(fastest, closing);
      middle += point;
      ++count;
    }
    if (count == 0) return false;
    const PairLaw& law = problem.laws.between(i, j);
    const bool bounces = fastest > slowest_bounce(i, j) && !problem.memory.is_loaded(i, j, meeting.part) &&
                         std::max(hits[i], hits[j]) < most_bounces;
    const double restitution = bounces ? law.restitution : 0.0;
    for (int k = 0; k < count; ++k) rows[k].target = -restitution * before[k].dot(m.normal);
    const double friction = parameters.friction ? law.friction : 0.0;
    solve(rows, couplings, count, m.normal, friction, a, b);
    keep_from_gaining(rows, before, count, a, b);
    const bool driven = !(a.is_free() && b.is_free());
    impact = {.i = i, .j = j, .impulse = Vec3::Zero(), .point = middle / count};
    for (int k = 0; k < count; ++k) {
      const Vec3 driver = !driven       ? Vec3(Vec3::Zero())
                          : a.is_free() ? b.velocity_at(rows[k].arm_j)
                                        : a.velocity_at(rows[k].arm_i);
      ledger = ledger + account(rows[k].impulse, m.normal, before[k], rows[k].relative_velocity(a, b), driver,
                                a.is_free() ? -1.0 : 1.0);
      impact.impulse += rows[k].impulse;
    }
    ledger.integration += fly_on(i, flight_i, at_i, a, s) + fly_on(j, flight_j, at_j, b, s);
    return true;
  }

 private:
  SolverBody solver_body(std::int32_t body, const BodyInstant& at) const {
    return {at.velocity, at.spin, bodies.inverse_mass[body],
            world_inverse_inertia(at.solid.orientation, bodies.inverse_inertia[body])};
  }

  static void solve(ContactRow* rows, const RowCoupling* couplings, int count, const Vec3& normal,
                    double friction, SolverBody& i, SolverBody& j) {
    constexpr int most_sweeps = 200;
    for (int sweep = 0; sweep < most_sweeps; ++sweep) {
      double change = 0;
      double size = 0;
      Vec3 last[Manifold::max_points];
      for (int k = 0; k < count; ++k) last[k] = rows[k].impulse;
      sweep_rows(rows, couplings, count, normal, friction, i, j);
      for (int k = 0; k < count; ++k) {
        change += (rows[k].impulse - last[k]).norm();
        size += rows[k].impulse.norm();
      }
      if (change <= tolerance::impact_residual * size) break;
    }
  }

  /// Newton's law with friction at several points, or at one whose Delassus matrix couples normal and
  /// tangents, can gain energy. What the impulses p move is a parabola in their common scale, p.u- + p.W p /
  /// 2; they are scaled down to where it is 0, which keeps momentum and the cone.
  static void keep_from_gaining(ContactRow* rows, const Vec3* before, int count, SolverBody& i,
                                SolverBody& j) {
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

  /// Gives a body the flight that leads from the impact on. Returns the drift of its energy on the way there
  /// and back (J).
  double fly_on(std::int32_t body, const BodyFlight& flown, const BodyInstant& at, const SolverBody& after,
                double s) const {
    if (!after.is_free()) return 0;
    const Vec3 velocity = after.velocity - s * flown.acceleration;
    bodies.position[body] -= (s - flown.midpoint) * (velocity - flown.velocity);
    bodies.velocity[body] = velocity + kick_of(body);
    clock[body] = s;
    ++hits[body];
    double drift = 0;
    if (parameters.rotation) {
      const auto energy = [&](const Quat& orientation, const Vec3& spin) {
        return rotational_energy(orientation, spin, flown.inverse_inertia);
      };
      drift = energy(at.solid.orientation, at.spin) - energy(flown.orientation, flown.spin) -
              energy(at.solid.orientation, after.spin);
      bodies.orientation[body] = at.solid.orientation;
      bodies.spin[body] = after.spin;
      rotate_freely(bodies.orientation[body], bodies.spin[body], flown.inverse_inertia, flown.midpoint - s);
      drift += energy(bodies.orientation[body], bodies.spin[body]);
    }
    reach[body] = reach_of(body);
    return drift;
  }
};

/// The first impact of each pair, then of each plane with each body.
struct FindFirst {
  FlightStage stage;
  const std::int32_t* planes;
  View<Meeting> first;

  void operator()(std::int64_t k) const {
    const auto [i, j] = candidate(k);
    first[k] = stage.next(i, j);
  }

  /// Pairs with planes may be among the others too: they are left to the planes.
  std::pair<std::int32_t, std::int32_t> candidate(std::int64_t k) const {
    const ConstView<Pair> pairs = stage.problem.pairs;
    if (k < pairs.size()) {
      const Pair& pair = pairs[k];
      const bool has_plane =
          stage.bodies.shape[pair.i] == Shape::plane || stage.bodies.shape[pair.j] == Shape::plane;
      return has_plane ? std::pair(pair.i, pair.i) : std::pair(pair.i, pair.j);
    }
    const std::int64_t bodies = stage.bodies.count();
    const std::int32_t plane = planes[(k - pairs.size()) / bodies];
    const auto body = static_cast<std::int32_t>((k - pairs.size()) % bodies);
    return std::minmax(plane, body);
  }
};

/// Who has had an impact later than the flight begins has been where it was before that.
struct StartClock {
  View<double> clock;
  double from;
  SCREE_HD void operator()(std::int64_t k) const { clock[k] = from > 0 ? fmax(clock[k], from) : 0.0; }
};

struct SetReach {
  FlightStage stage;
  void operator()(std::int64_t k) const { stage.reach[k] = stage.reach_of(static_cast<std::int32_t>(k)); }
};

struct LoadReach {
  View<double> reach;
  SCREE_HD double operator()(std::int64_t k) const { return reach[k]; }
};

struct MinusSize {
  BodyView bodies;
  SCREE_HD double operator()(std::int64_t k) const {
    return bodies.mobility[k] == Mobility::absent ? -HUGE_VAL
                                                  : -smallest_size(bodies.shape[k], bodies.size[k]);
  }
};

/// False if no two bodies can go deep into one another.
bool may_go_deep(const FlightStage& stage) {
  const std::int64_t n = stage.bodies.count();
  const double reach = parallel::max<double, Host>("impact.reach", n, LoadReach{stage.reach}, 0.0);
  const double size = -parallel::max<double, Host>("impact.size", n, MinusSize{stage.bodies}, -HUGE_VAL);
  // The reach is of half a substep: two bodies, and both halves.
  return stage.parameters.continuous && 4 * reach > tolerance::deep_approach * size;
}

struct Event {
  Meeting meeting;
  std::int32_t i, j;
  std::int32_t hits_i, hits_j;  // of the bodies when it was foreseen

  friend bool operator>(const Event& a, const Event& b) {
    return std::tuple(a.meeting.time, a.i, a.j, a.meeting.part) >
           std::tuple(b.meeting.time, b.i, b.j, b.meeting.part);
  }
};

/// Pairs of bodies after their impacts. What the response will do comes after: their flight is straight, with
/// all of the substep's kick.
class StruckBodies final : public LateBodies {
 public:
  explicit StruckBodies(const FlightStage& stage) : stage_(stage) {}

  double time_of(std::int32_t i, std::int32_t j) const override {
    return std::max(stage_.clock[i], stage_.clock[j]);
  }
  double now() const override { return 0.5 * stage_.problem.step; }
  Solid solid_at(std::int32_t body, double time) const override { return at(body, time).solid; }

  BodyInstant at(std::int32_t body, double time) const {
    BodyFlight flight = stage_.flight(body);
    flight.velocity = flight.velocity_at(stage_.problem.step);
    flight.acceleration.setZero();
    return instant_of(flight, time);
  }

 private:
  FlightStage stage_;
};

struct MarkFlights {
  FlightStage stage;
  ConstView<Manifold> manifolds;
  View<Contact> contacts;

  /// Two bodies that the rows would hold apart, though nothing else has touched them, may pass by each other:
  /// the normal of the midpoint says nothing of it. Or they meet later, in an impact that will bounce.
  void operator()(std::int64_t index) const {
    Contact& contact = contacts[index];
    const Manifold& m = manifolds[contact.manifold];
    const double step = stage.problem.step;
    const double seen = std::max(0.5 * step, StruckBodies(stage).time_of(m.i, m.j));
    contact.lead = seen - 0.5 * step;
    if (contact.loaded || !would_push_apart(m, seen)) return;
    PairFlight pair = stage.pair_of(m.i, m.j, 1.5 * step);
    pair.slowest[m.part] = 0;
    const Meeting meeting = next_meeting(pair, std::max(stage.clock[m.i], stage.clock[m.j]));
    contact.flying = meeting.time == HUGE_VAL ||
                     (meeting.time > step && fastest_approach(pair) > stage.slowest_bounce(m.i, m.j));
  }

  bool would_push_apart(const Manifold& m, double seen) const {
    const StruckBodies struck(stage);
    const BodyInstant i = struck.at(m.i, seen);
    const BodyInstant j = struck.at(m.j, seen);
    bool pushes = false;
    for (int k = 0; k < m.count; ++k) {
      const double closing = closing_speed(m, k, i, j);
      if (closing <= 0 || closing * (1.5 * stage.problem.step - seen) <= m.points[k].gap) continue;
      if (m.points[k].gap <= 0) return false;  // touches: no impact is to come
      pushes = true;
    }
    return pushes;
  }
};

}  // namespace

Ledger ImpactSolver::resolve(const ImpactProblem& problem, const ResponseParameters& parameters,
                             BodyView bodies) {
  const std::int64_t n = bodies.count();
  log_.clock.resize(n);
  log_.hits.resize(n);
  parallel::for_each<Host>("impact.reset", n, StartClock{log_.clock.view(), problem.from});
  parallel::fill("impact.reset", log_.hits, std::int32_t{0});
  impacts_.clear();
  saved_.clear();
  hit_bound_ = false;
  log_.reach.resize(n);
  const FlightStage stage(problem, parameters, bodies, log_);
  parallel::for_each<Host>("impact.reach", n, SetReach{stage});
  if (!(problem.bounces && parameters.restitution) && !may_go_deep(stage)) return {};
  planes_.clear();
  for (std::int64_t k = 0; k < n; ++k) {
    if (bodies.shape[k] == Shape::plane) planes_.push_back(static_cast<std::int32_t>(k));
  }
  first_.resize(problem.pairs.size() + static_cast<std::int64_t>(planes_.size()) * n);
  const FindFirst find{stage, planes_.data(), first_.view()};
  parallel::for_each<Host>("impact.first", first_.size(), find);

  std::priority_queue<Event, std::vector<Event>, std::greater<>> events;
  const auto foresee = [&](std::int32_t i, std::int32_t j, const Meeting& meeting) {
    if (meeting.time <= problem.step) events.push({meeting, i, j, stage.hits[i], stage.hits[j]});
  };
  for (std::int64_t k = 0; k < first_.size(); ++k) {
    if (first_.view()[k].time > problem.step) continue;
    const auto [i, j] = find.candidate(k);
    foresee(i, j, first_.view()[k]);
  }
  if (events.empty()) return {};
  list_partners(problem.pairs, bodies);

  const auto foresee_all_of = [&](std::int32_t body, std::int32_t but) {
    if (!stage.is_free(body)) return;
    const auto look_at = [&](std::int32_t other) {
      if (other == body || other == but) return;
      const auto [i, j] = std::minmax(body, other);
      foresee(i, j, stage.next(i, j));
    };
    const auto k = static_cast<std::size_t>(body);
    for (std::int64_t p = begin_[k]; p < begin_[k + 1]; ++p) look_at(partners_[static_cast<std::size_t>(p)]);
    for (const std::int32_t plane : planes_) look_at(plane);
  };
  const auto save = [&](std::int32_t body) {
    if (!stage.is_free(body) || stage.hits[body] > 0) return;
    saved_.push_back({body, bodies.position[body], bodies.orientation[body], bodies.velocity[body],
                      bodies.spin[body], stage.clock[body]});
  };
  Ledger ledger;
  while (!events.empty()) {
    const Event event = events.top();
    events.pop();
    const auto [meeting, i, j, hits_i, hits_j] = event;
    if (stage.hits[i] != hits_i || stage.hits[j] != hits_j) continue;
    const std::size_t saved = saved_.size();
    save(i);
    save(j);
    Impact impact;
    if (!stage.resolve(i, j, meeting, impact, ledger)) {
      saved_.resize(saved);
      continue;
    }
    impacts_.push_back(impact);
    hit_bound_ = hit_bound_ || std::max(stage.hits[i], stage.hits[j]) >= most_bounces;
    foresee(i, j, stage.next(i, j));
    foresee_all_of(i, j);
    foresee_all_of(j, i);
  }
  return ledger;
}

void ImpactSolver::list_partners(ConstView<Pair> pairs, const BodyView& bodies) {
  begin_.assign(static_cast<std::size_t>(bodies.count()) + 1, 0);
  const auto count = [&](std::int32_t body) { ++begin_[static_cast<std::size_t>(body) + 1]; };
  const auto is_listed = [&](const Pair& pair) {
    return bodies.shape[pair.i] != Shape::plane && bodies.shape[pair.j] != Shape::plane;
  };
  for (const Pair& pair : pairs) {
    if (!is_listed(pair)) continue;
    count(pair.i);
    count(pair.j);
  }
  for (std::size_t k = 1; k < begin_.size(); ++k) begin_[k] += begin_[k - 1];
  partners_.resize(static_cast<std::size_t>(begin_.back()));
  std::vector<std::int64_t>& next = next_;
  next.assign(begin_.begin(), begin_.end());
  for (const Pair& pair : pairs) {
    if (!is_listed(pair)) continue;
    partners_[static_cast<std::size_t>(next[static_cast<std::size_t>(pair.i)]++)] = pair.j;
    partners_[static_cast<std::size_t>(next[static_cast<std::size_t>(pair.j)]++)] = pair.i;
  }
}

void ImpactSolver::undo(BodyView bodies) {
  for (const Saved& saved : saved_) {
    bodies.position[saved.body] = saved.position;
    bodies.orientation[saved.body] = saved.orientation;
    bodies.velocity[saved.body] = saved.velocity;
    bodies.spin[saved.body] = saved.spin;
    log_.clock.view()[saved.body] = saved.clock;
  }
  saved_.clear();
  impacts_.clear();
}

const LateBodies* ImpactSolver::late_bodies(const ImpactProblem& problem,
                                            const ResponseParameters& parameters, BodyView bodies) {
  const auto is_late = [&](const Saved& saved) { return log_.clock.view()[saved.body] > 0.5 * problem.step; };
  if (std::none_of(saved_.begin(), saved_.end(), is_late)) return nullptr;
  late_ = std::make_unique<StruckBodies>(FlightStage(problem, parameters, bodies, log_));
  return late_.get();
}

void ImpactSolver::mark_flights(const ImpactProblem& problem, const ResponseParameters& parameters,
                                ConstView<Manifold> manifolds, BodyView bodies, ContactSet& set) {
  parallel::for_each<Host>(
      "impact.flights", set.contacts.size(),
      MarkFlights{FlightStage(problem, parameters, bodies, log_), manifolds, set.contacts.view()});
}

Ledger ImpactSolver::shift_late(const ImpactProblem& problem, const ResponseParameters& parameters,
                                BodyView bodies, const ContactSet& set) {
  const double midpoint = 0.5 * problem.step;
  const auto is_late = [&](const Saved& saved) { return log_.clock.view()[saved.body] > midpoint; };
  if (std::none_of(saved_.begin(), saved_.end(), is_late)) return {};
  const auto for_each_end = [&bodies](const Contact& c, auto&& act) {
    if (bodies.mobility[c.i] == Mobility::free) act(c.i, Vec3(-c.impulse));
    if (bodies.mobility[c.j] == Mobility::free) act(c.j, c.impulse);
  };
  impulse_.assign(static_cast<std::size_t>(bodies.count()), Vec3::Zero());
  for (const Contact& c : set.contacts.view()) {
    for_each_end(c, [this](std::int32_t body, const Vec3& impulse) {
      impulse_[static_cast<std::size_t>(body)] += impulse;
    });
  }
  Ledger ledger;
  // An impulse at a contact's time acts beside the midpoint by as much as the body flies until then.
  for (const Contact& c : set.contacts.view()) {
    if (c.lead == 0 || c.impulse.isZero(0)) continue;
    for_each_end(c, [&](std::int32_t body, const Vec3& impulse) {
      const Vec3 before =
          bodies.velocity[body] - bodies.inverse_mass[body] * impulse_[static_cast<std::size_t>(body)];
      ledger.angular_correction -= c.lead * before.cross(impulse);
    });
  }
  for (const Saved& saved : saved_) {
    const std::int32_t body = saved.body;
    const double lead = log_.clock.view()[body] - midpoint;
    const Vec3 moment = lead * impulse_[static_cast<std::size_t>(body)];
    if (!is_late(saved)) continue;
    bodies.position[body] -= bodies.inverse_mass[body] * moment;
    ledger.correction -= moment.dot(parameters.acceleration_of(body));
    ledger.angular_correction -= moment.cross(bodies.velocity[body]);
  }
  return ledger;
}

}  // namespace scree
