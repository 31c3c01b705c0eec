#include "sim/simulation.hpp"

#include "core/error.hpp"
#include "core/timing.hpp"
#include "core/tolerances.hpp"
#include "narrowphase/narrow_phase.hpp"
#include "sim/applied_forces.hpp"
#include "sim/contact_problem.hpp"
#include "sim/dynamics/contact_set.hpp"
#include "sim/dynamics/correction.hpp"
#include "sim/dynamics/impact_solver.hpp"
#include "sim/dynamics/motion.hpp"
#include "sim/dynamics/prescribed.hpp"
#include "sim/dynamics/region.hpp"
#include "sim/dynamics/response.hpp"
#include "sim/measurement.hpp"
#include "sim/model.hpp"
#include "sim/pair_finder.hpp"
#include "sim/presence.hpp"
#include "sim/scene/time_grid.hpp"

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace scree {

namespace {

ResponseParameters parameters_of(const Scene& scene) {
  const ModelPlan plan = plan_model(scene);
  return {.gravity = scene.gravity,
          .acceleration = {},
          .torque = {},
          .friction = plan.friction.on,
          .restitution = plan.restitution.on,
          .rotation = plan.rotation.on,
          .gyroscopic = plan.gyroscopic.on,
          .continuous = plan.continuous.on,
          .warm_start = scene.response.warm_start,
          .accurate = scene.response.mode == ResponseMode::accurate,
          .iterations = scene.response.iterations.value_or(0),
          .block_sweeps = scene.response.block_sweeps.value_or(0),
          .tolerance = scene.response.tolerance.value_or(0),
          .restitution_threshold = plan.restitution_threshold};
}

std::vector<PairLaw> table_of(const Scene& scene) {
  std::vector<PairLaw> table;
  for (const ContactLaw& law : scene.laws) table.push_back({law.restitution, law.friction});
  return table;
}

bool runs_on_device(SpaceChoice space) {
  return space == SpaceChoice::cuda || (space == SpaceChoice::automatic && device_info().available);
}

/// Middle of the free bodies: where float bounds are finest.
Vec3 middle_of(const BodyTable& bodies) {
  Vec3 sum = Vec3::Zero();
  double count = 0;
  for (std::size_t k = 0; k < bodies.position.size(); ++k) {
    if (bodies.mobility[k] != Mobility::free) continue;
    sum += bodies.position[k];
    count += 1;
  }
  return count > 0 ? Vec3(sum / count) : sum;
}

/// Energy that lifts every free body of the scene by its own size (J).
double lifting_energy(const Scene& scene) {
  double energy = 0;
  const BodyTable& bodies = scene.bodies;
  for (std::size_t k = 0; k < bodies.position.size(); ++k) {
    if (bodies.mobility[k] != Mobility::free) continue;
    energy += scene.gravity.norm() / bodies.inverse_mass[k] * smallest_size(bodies.shape[k], bodies.size[k]);
  }
  return energy;
}

/// The fields that a step changes, to go back to.
struct MovingState {
  std::vector<Vec3> position, velocity, spin;
  std::vector<Quat> orientation;

  void save(const Bodies<Host>& bodies) {
    copy(position, bodies.position);
    copy(velocity, bodies.velocity);
    copy(spin, bodies.spin);
    copy(orientation, bodies.orientation);
  }
  void restore(Bodies<Host>& bodies) const {
    copy(bodies.position, position);
    copy(bodies.velocity, velocity);
    copy(bodies.spin, spin);
    copy(bodies.orientation, orientation);
  }
};

}  // namespace

struct Simulation::Parts {
  /// What the first half of a substep changes.
  struct Restart {
    MovingState state;
    Ledger ledger;
    std::int64_t impacts = 0, unfinished_impacts = 0;
    std::vector<Vec3> contact_impulse;

    void save(const Parts& parts) {
      state.save(parts.bodies);
      ledger = parts.ledger;
      impacts = parts.counters.impacts;
      unfinished_impacts = parts.counters.unfinished_impacts;
      contact_impulse = parts.contact_impulse;
    }
    void restore(Parts& parts) const {
      state.restore(parts.bodies);
      parts.ledger = ledger;
      parts.counters.impacts = impacts;
      parts.counters.unfinished_impacts = unfinished_impacts;
      parts.contact_impulse = contact_impulse;
    }
  };

  Scene scene;
  TimeGrid grid;
  Presence presence;
  tbb::global_control threads;
  ResponseParameters parameters;
  Vec3 origin;
  Bodies<Host> bodies;
  Array<PrescribedPath, Host> paths;
  Array<PairLaw, Host> laws;
  AppliedForces forces;
  KeptPairs kept_pairs;
  NarrowPhase narrow_phase;
  NarrowPhase end_narrow_phase;  // for the penetration at the end of a step
  ImpactSolver impacts;
  ResponseSolver response;
  PositionCorrector corrector;

  std::int64_t step = 0;
  int substeps = 1;         // of the next, if the scene leaves it open
  double last_step = 0;     // its length
  double last_substep = 0;  // likewise; scales the remembered impulses
  MovingState start;        // of the last step
  Restart before;           // of the last substep, in the accurate mode
  std::vector<Quat> first_orientation;
  std::vector<Vec3> contact_impulse;  // on each body that is not free, over the last step
  Array<double, Host> contact_margin;
  Array<SolverBody, Host> solver;
  std::vector<Impact> struck;  // in the last substep
  ContactSet contacts;
  ImpulseMemory memory;
  Ledger ledger;
  Exchange exchange;  // potential energy about `origin`
  Counters counters;
  EnergyBaseline baseline;
  std::vector<RegionContents> contents;         // of each region
  std::vector<RegionContents> contents_before;  // and one step earlier
  Observation observation;
  bool observed = false;
  bool overlaps_observed = false;

  Parts(const Scene& s, const SimulationOptions& options)
      : scene(s),
        grid(s.time),
        presence(s, grid),
        threads(tbb::global_control::max_allowed_parallelism,
                options.threads > 0
                    ? static_cast<std::size_t>(options.threads)
                    : tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism)),
        parameters(parameters_of(s)),
        origin(middle_of(s.bodies)),
        forces(s, grid),
        kept_pairs(s.broadphase, runs_on_device(options.space), origin),
        narrow_phase(s.narrowphase),
        end_narrow_phase({.box_box = s.narrowphase.box_box}) {
    copy_bodies(bodies, scene.bodies);
    presence.begin(bodies);
    copy(laws, table_of(scene));
    copy(paths, prescribed_paths(scene));
    for (PrescribedPath& path : paths.view()) path.start = grid.time(presence.first_step(path.body));
    first_orientation = scene.bodies.orientation;
    start.save(bodies);
    contact_impulse.assign(scene.bodies.position.size(), Vec3::Zero());
    baseline.start(totals_of(bodies, parameters.gravity, origin), lifting_energy(scene));
    contents = contents_before = region_contents();
  }

  std::vector<RegionContents> region_contents() const {
    std::vector<RegionContents> all;
    for (const Region& region : scene.regions) all.push_back(contents_of(region, bodies));
    return all;
  }

  /// Impacts of the flight of a substep from `problem.from` on. `reach`: to the end of the step (s).
  void resolve_impacts(double h, double from, double reach) {
    constexpr int most_attempts = 8;
    // The flight is never more than half a substep away from the midpoint.
    const auto set_margins = [&] {
      contact_margins(bodies, 0.5 * h, tolerance::contact_slack, parameters, contact_margin);
    };
    set_margins();
    for (int attempt = 1;; ++attempt) {
      const ConstView<Pair> pairs = kept_pairs.covering(bodies, contact_margin, reach, parameters);
      const timing::Region region("impacts");
      const Ledger moved = impacts.resolve(impact_problem(pairs, h, from), parameters, view_of(bodies));
      if (impacts.impacts().empty()) return;
      // What was struck may have left the boxes: others that it can meet now are not among the pairs.
      set_margins();
      if (attempt == most_attempts || kept_pairs.cover(bodies, contact_margin)) {
        ledger = ledger + moved;
        break;
      }
      kept_pairs.add_travel(bodies, contact_margin);
      impacts.undo(view_of(bodies));
    }
    counters.impacts += static_cast<std::int64_t>(impacts.impacts().size());
    if (impacts.hit_bound()) ++counters.unfinished_impacts;
    for (const Impact& impact : impacts.impacts()) {
      add_impulse_on_driven_bodies(impact.i, impact.j, impact.impulse);
      struck.push_back(impact);
    }
  }

  ImpactProblem impact_problem(ConstView<Pair> pairs, double h, double from) const {
    return {.pairs = pairs,
            .laws = contact_laws(),
            .memory = memory,
            .step = h,
            .from = from,
            .bounces = from == 0};
  }

  ContactLaws contact_laws() const {
    return {bodies.shape.view(),    bodies.size.view(), bodies.mobility.view(),
            bodies.material.view(), laws.view(),        static_cast<std::int64_t>(scene.materials.size())};
  }

  /// That may close by the next midpoint. `reach`: to the end of the step (s).
  Manifolds find_contacts(double h, double reach) {
    contact_margins(bodies, h, tolerance::contact_slack, parameters, contact_margin);
    const ConstView<Pair> pairs = kept_pairs.covering(bodies, contact_margin, reach, parameters);
    counters.pcs_made = kept_pairs.times_made();
    const timing::Region region("narrowphase");
    const Manifolds manifolds =
        narrow_phase.find(view_of(std::as_const(bodies)), pairs, contact_margin.view(),
                          impacts.late_bodies(impact_problem(pairs, h, 0), parameters, view_of(bodies)));
    counters.narrowphase += narrow_phase.stats();
    return manifolds;
  }

  /// For the state as it is; fills contact_margin for it too.
  ConstView<Pair> pairs_now() {
    contact_margins(bodies, 0, tolerance::contact_slack, parameters, contact_margin);
    return kept_pairs.covering(bodies, contact_margin, 0, parameters);
  }

  /// One substep; in the accurate mode in parts that end where contacts come to stick. What stops otherwise,
  /// by a blow and not by friction, does so no sooner in a shorter part: then cuts do not help, and there are
  /// none.
  void substep(double h, double done) {
    constexpr int most_cuts = 16;
    constexpr double helps = 0.25;  // of what the cut before it found too long
    const double end = done + h;
    int cuts = 0;
    bool cuts_help = parameters.accurate;
    while (done < end) {
      double part = end - done;
      if (cuts_help) before.save(*this);
      Manifolds manifolds = fly_and_respond(part, done);
      double last = HUGE_VAL;
      while (cuts_help && response.slip_end() < 1) {
        const double too_long = 1 - response.slip_end();
        cuts_help = too_long < helps * last && ++cuts <= most_cuts;
        part = cuts_help ? response.slip_end() * part : end - done;
        last = too_long;
        before.restore(*this);
        manifolds = fly_and_respond(part, done);
      }
      fly_on(manifolds, part, done);
      done = part < end - done ? done + part : end;
    }
    counters.cuts += cuts;
  }

  /// Moreau's midpoint step. Its first half: free flight to the midpoint, impacts on the way, contacts there,
  /// impulses. `done`: how much of the step went before (s).
  Manifolds fly_and_respond(double h, double done) {
    struck.clear();
    forces.start_substep(bodies);
    timed_fly(grid.time(step) + done + 0.5 * h, 0.5 * h);
    resolve_impacts(h, 0, reach_from(h, done));
    const Manifolds manifolds = find_contacts(h, reach_from(h, done));
    respond(manifolds, h);
    return manifolds;
  }

  /// And its second: impacts on the way, since the response has changed it, and free flight to the end.
  void fly_on(const Manifolds& manifolds, double h, double done) {
    resolve_impacts(h, 0.5 * h, reach_from(h, done));
    if (!impacts.impacts().empty()) load_solver_bodies(bodies, solver);
    fly(grid.time(step) + done + h, 0.5 * h);
    ledger.work += forces.work(bodies);
    ledger = ledger + corrector.correct(h, parameters, view_of(bodies), solver, contacts);
    memory.remember(manifolds, contacts, bodies.count());
    for (const Contact& c : std::as_const(contacts.contacts).view()) {
      if (c.free_ends < 2) add_impulse_on_driven_bodies(c.i, c.j, contacts.impulse_of(c));
    }
    last_substep = h;
  }

  /// Time from a substep to the end of its step, and as long again as the substep (s).
  double reach_from(double h, double done) const { return grid.length(step + 1) - done + h; }

  void respond(const Manifolds& manifolds, double h) {
    const timing::Region region("response");
    load_solver_bodies(bodies, solver);
    color_contacts(manifolds.headers, std::as_const(bodies.mobility).view(), contacts.coloring);
    const double scale = last_substep > 0 ? h / last_substep : 1.0;
    prepare_contacts(manifolds, contact_laws(), memory, scale, parameters, contacts);
    impacts.mark_flights(impact_problem({}, h, 0), parameters, manifolds, view_of(bodies), contacts);
    ledger = ledger + response.solve(manifolds, h, parameters, view_of(bodies), solver, contacts, counters);
    ledger = ledger + impacts.shift_late(impact_problem({}, h, 0), parameters, view_of(bodies), contacts);
  }

  /// Moves every body to the time given, dt later than it is.
  void fly(double time, double dt) {
    ledger.integration += advance(bodies, dt, parameters);
    place_prescribed(paths, time, bodies);
  }

  void timed_fly(double time, double dt) {
    const timing::Region region("integration");
    fly(time, dt);
  }

  /// The impulse of j, and reversed of i.
  void add_impulse_on_driven_bodies(std::int32_t i, std::int32_t j, const Vec3& impulse) {
    const ConstView<Mobility> mobility = std::as_const(bodies.mobility).view();
    if (mobility[i] != Mobility::free) contact_impulse[static_cast<std::size_t>(i)] -= impulse;
    if (mobility[j] != Mobility::free) contact_impulse[static_cast<std::size_t>(j)] += impulse;
  }

  void do_step() {
    const double dt = grid.length(step + 1);
    const int n = scene.time.substeps.value_or(substeps);
    const double h = dt / n;
    double overlap = 0;
    start.save(bodies);
    const Ledger ledger_before = ledger;
    std::fill(contact_impulse.begin(), contact_impulse.end(), Vec3(Vec3::Zero()));
    try {
      forces.act(step, bodies, parameters);
      for (int s = 0; s < n; ++s) {
        substep(h, s * h);
        overlap = std::max(overlap, corrector.overlap());
      }
      baseline.extend(totals_of(bodies, parameters.gravity, origin));
      if (!baseline.is_finite()) throw RunError(non_finite_body());
    } catch (const RunError& error) {
      start.restore(bodies);
      ledger = ledger_before;
      throw RunError(fmt::format("step {} (t = {} s): {}", step + 1, grid.time(step), error.what()));
    }
    if (overlap > tolerance::substep_overlap) substeps = std::min(2 * n, tolerance::most_substeps);
    if (overlap < tolerance::coarser_overlap) substeps = std::max(n / 2, 1);
    counters.substeps += n;
    ++step;
    come_and_go();
    contents_before = std::exchange(contents, region_contents());
    last_step = dt;
    observed = overlaps_observed = false;
  }

  /// Bodies whose time has come or is over.
  void come_and_go() {
    const Presence::Change change = presence.update(step, scene, origin, bodies);
    if (!change.any) return;
    exchange = exchange + change.exchange;
    baseline.exchange(change.first_potential);
    baseline.extend(totals_of(bodies, parameters.gravity, origin));
    kept_pairs.forget();
  }

  void observe_bodies(double time) {
    Observation& o = observation;
    o.time = time;
    o.step = step;
    o.ledger = ledger;
    o.exchange = exchange;
    o.bodies = presence.count();
    o.counters = counters;
    const Totals totals = totals_of(bodies, parameters.gravity, origin);
    measure_totals(totals, baseline, parameters.gravity, origin, o);
    o.speed_max = largest_speed(bodies);
    measure_regions(scene.regions, contents, contents_before, last_step, o.regions);
    measure_contacts(contacts, totals.count, o);
    o.penetration = Penetration::unknown();
    o.pairs = -1;
    observed = true;
  }

  void observe_overlaps() {
    const ConstView<Pair> pairs = pairs_now();
    observation.pairs = kept_pairs.size();
    measure_penetration(end_narrow_phase.find(view_of(std::as_const(bodies)), pairs, contact_margin.view()),
                        view_of(std::as_const(bodies)), observation.penetration);
    overlaps_observed = true;
  }

  std::string non_finite_body() const {
    for (std::int64_t k = 0; k < bodies.count(); ++k) {
      const auto views = view_of(std::as_const(bodies));
      if (views.position[k].allFinite() && views.velocity[k].allFinite() && views.spin[k].allFinite())
        continue;
      return fmt::format("the state of body {} is no longer finite; try a smaller time.step", views.id[k]);
    }
    return "the total energy is no longer finite; try a smaller time.step";
  }
};

Simulation::Simulation(const Scene& scene, const SimulationOptions& options)
    : parts_(std::make_unique<Parts>(scene, options)) {}
Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;

void Simulation::step() { parts_->do_step(); }
bool Simulation::finished() const { return parts_->step >= parts_->grid.last(); }
double Simulation::time() const { return parts_->grid.time(parts_->step); }
std::int64_t Simulation::steps() const { return parts_->step; }
std::int64_t Simulation::steps_total() const { return parts_->grid.last(); }
const char* Simulation::space_name() const { return parts_->kept_pairs.space_name(); }

void Simulation::snapshot(Snapshot& out) const {
  out.time = time();
  out.step = parts_->step;
  copy_bodies(out.bodies, parts_->bodies);
}

std::uint64_t Simulation::state_hash() const {
  BodyTable table;
  copy_bodies(table, parts_->bodies);
  return hash_of(table);
}

BodyState Simulation::body(std::int32_t id) const {
  const Parts& p = *parts_;
  const auto k = static_cast<std::size_t>(id);
  const ConstBodyView views = view_of(std::as_const(p.bodies));
  if (views.mobility[id] == Mobility::absent) return BodyState::absent();
  BodyState state{.position = views.position[id],
                  .velocity = views.velocity[id],
                  .spin = views.spin[id],
                  .orientation = views.orientation[id],
                  .start_orientation = p.first_orientation[k],
                  .acceleration = Vec3::Zero(),
                  .force = Vec3::Zero()};
  if (p.step == 0 || !p.presence.holds(id, p.step - 1)) return state;
  state.acceleration = (state.velocity - p.start.velocity[k]) / p.last_step;
  // On a free body the contact impulse is what gravity and applied forces do not explain of the change of its
  // momentum.
  state.force = views.mobility[id] == Mobility::free
                    ? Vec3((state.acceleration - p.parameters.acceleration_of(id)) / views.inverse_mass[id])
                    : Vec3(p.contact_impulse[k] / p.last_step);
  return state;
}

std::vector<BodyPair> Simulation::pairs() {
  std::vector<BodyPair> pairs;
  const ConstView<Shape> shape = std::as_const(parts_->bodies.shape).view();
  for (const Pair& pair : parts_->pairs_now()) {
    if (shape[pair.i] != Shape::plane && shape[pair.j] != Shape::plane) pairs.push_back({pair.i, pair.j});
  }
  return pairs;
}

std::vector<ContactForce> Simulation::contact_forces() const {
  const Parts& p = *parts_;
  const ConstView<Contact> contacts = p.contacts.contacts.view();
  const ConstView<ContactRow> rows = p.contacts.rows.view();
  const ConstBodyView views = view_of(p.bodies);
  std::vector<ContactForce> forces;
  for (std::int64_t c = 0; c < contacts.size(); ++c) {
    const Contact& contact = contacts[c];
    const Vec3 impulse = p.contacts.impulse_of(contact);
    if (impulse.isZero(0)) continue;
    // From the body that moves freely: the centre of a plane is nowhere near.
    const bool from_j = views.mobility[contact.j] == Mobility::free;
    Vec3 arm = Vec3::Zero();
    for (int k = 0; k < contact.count; ++k) {
      const ContactRow& row = rows[contact.first_row + k];
      arm += (from_j ? row.arm_j : row.arm_i) / contact.count;
    }
    forces.push_back({contact.i, contact.j, impulse / p.last_substep,
                      views.position[from_j ? contact.j : contact.i] + arm});
  }
  for (const Impact& impact : p.struck)
    forces.push_back({impact.i, impact.j, impact.impulse / p.last_substep, impact.point});
  return forces;
}

ContactProblem Simulation::contact_problem() const {
  const ResponseSolver& response = parts_->response;
  return contact_problem_of(parts_->contacts, parts_->solver.view(), response.free_velocity(),
                            response.free_spin());
}

GridOccupancy Simulation::grid_occupancy() {
  parts_->pairs_now();
  return parts_->kept_pairs.grid_occupancy();
}

const Observation& Simulation::observe(bool overlaps) {
  Parts& p = *parts_;
  const timing::Region region("observation");
  if (!p.observed) p.observe_bodies(time());
  if (overlaps && !p.overlaps_observed) p.observe_overlaps();
  return p.observation;
}

}  // namespace scree
