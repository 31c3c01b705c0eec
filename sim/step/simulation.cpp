#include "sim/step/simulation.hpp"

#include "core/error.hpp"
#include "core/timing.hpp"
#include "sim/bodies/prescribed.hpp"
#include "sim/bodies/presence.hpp"
#include "sim/scene/measure.hpp"
#include "sim/scene/motion_bounds.hpp"
#include "sim/scene/time_grid.hpp"
#include "sim/step/guarded_steps.hpp"
#include "sim/step/measurement.hpp"
#include "sim/step/space_stepper.hpp"
#include "sim/step/step_failure.hpp"
#include "sim/step/stepper.hpp"

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace scree {

namespace {

/// Returns the middle of the free bodies, around which float bounds are finest.
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

/// Returns the energy that lifts every free body of the scene by its smallest_size (J).
double lifting_energy(const Scene& scene) {
  double energy = 0;
  const BodyTable& bodies = scene.bodies;
  for (std::size_t k = 0; k < bodies.position.size(); ++k) {
    if (bodies.mobility[k] != Mobility::free) continue;
    energy +=
        largest_gravity(scene) / bodies.inverse_mass[k] * smallest_size(bodies.shape[k], bodies.size[k]);
  }
  return energy;
}

/// Makes the paths of the prescribed bodies, each of which starts when its body appears.
PathTable paths_of(const Scene& scene, const TimeGrid& grid, const Presence& presence) {
  PathTable table = prescribed_paths(scene);
  for (std::size_t k = 0; k < table.paths.size(); ++k)
    table.paths[k].start = grid.time(presence.first_step(scene.motions[k].body));
  return table;
}

Vector plain(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
std::array<double, 4> plain(const Quat& q) { return {q.w(), q.x(), q.y(), q.z()}; }

Body body_at(const BodyTable& bodies, std::size_t k) {
  return {.id = static_cast<std::int32_t>(bodies.id[k]),
          .shape = bodies.shape[k],
          .mobility = bodies.mobility[k],
          .size = plain(bodies.size[k]),
          .mass = 1 / bodies.inverse_mass[k],
          .position = plain(bodies.position[k]),
          .orientation = plain(bodies.orientation[k]),
          .velocity = plain(bodies.velocity[k]),
          .spin = plain(bodies.spin[k])};
}

/// Number of free bodies from which on the steps are taken on Device, if the choice is automatic
/// (docs/decisions/0022).
constexpr std::int64_t few_for_device = 20000;

/// Returns whether a check of the scene measures a force.
bool checks_forces(const Scene& scene) {
  return std::ranges::any_of(
      scene.checks, [&](const Check& check) { return is_of_forces(parse_measure(check.measure, scene)); });
}

std::unique_ptr<Stepper> make_stepper(const Scene& scene, const TimeGrid& grid, const Presence& presence,
                                      const SimulationOptions& options, const Vec3& origin) {
  const bool on_device = options.space == SpaceChoice::cuda ||
                         (options.space == SpaceChoice::automatic && device_info().available &&
                          std::ranges::count(scene.bodies.mobility, Mobility::free) >= few_for_device);
  return make_space_stepper(scene, grid, paths_of(scene, grid, presence),
                            {.on_device = on_device,
                             .origin = origin,
                             .sums_impulses_on_walls = options.all_forces || checks_forces(scene)});
}

}  // namespace

struct Simulation::Parts {
  Scene scene;
  TimeGrid grid;
  Presence presence;
  tbb::global_control threads;
  Vec3 origin;     // local origin of the broad phase (m)
  Vec3 reference;  // where potential energies are 0 (m): the world's origin if gravity turns
  std::unique_ptr<Stepper> stepper;

  std::int64_t step = 0;
  GuardedSteps steps;
  double last_step = 0;  // length of the last step (s)
  std::vector<Quat> first_orientation;
  Exchange exchange;                            // with potential energies relative to `reference`
  std::int64_t left = 0;                        // number of bodies that have left the world and were removed
  std::vector<Removed> removed;                 // bodies that each region has removed
  std::vector<RegionContents> contents;         // what each region holds
  std::vector<RegionContents> contents_before;  // what each region held one step earlier
  Observation observation;
  bool observed = false;
  bool overlaps_observed = false;
  bool loaded = false;  // until the next step the observation's contact values are saved or unknown ones

  Parts(const Scene& s, const SimulationOptions& options)
      : scene(s),
        grid(s.time),
        presence(s, grid),
        threads(tbb::global_control::max_allowed_parallelism,
                options.threads > 0
                    ? static_cast<std::size_t>(options.threads)
                    : tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism)),
        origin(middle_of(s.bodies)),
        reference(s.gravity_turn ? Vec3(Vec3::Zero()) : origin),
        stepper(make_stepper(s, grid, presence, options, origin)),
        steps(scene, reference) {
    if (presence.count() < scene.bodies.count())
      stepper->change_bodies([this](Bodies<Host>& bodies) { presence.begin(bodies); });
    first_orientation = scene.bodies.orientation;
    steps.start(*stepper, lifting_energy(scene));
    removed.resize(scene.regions.size());
    emit();
    contents = contents_before = region_contents();
  }

  std::vector<RegionContents> region_contents() const {
    std::vector<RegionContents> all;
    for (const Region& region : scene.regions) all.push_back(stepper->contents_of(region));
    return all;
  }

  void do_step() {
    if (step >= grid.last()) throw std::logic_error("Simulation::step() at time.end: there is no step more");
    const double dt = grid.length(step + 1);
    try {
      steps.take(step, grid.time(step), dt, exchange, *stepper);
    } catch (...) {
      if (!observed) forget_contacts();
      throw;
    }
    ++step;
    come_and_go();
    contents_before = std::exchange(contents, region_contents());
    last_step = dt;
    observed = overlaps_observed = loaded = false;
  }

  /// Marks the observation's contact values as unknown, since the contacts at hand are those of a step that
  /// was undone.
  void forget_contacts() {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    observation.contacts = -1;
    observation.gap_mean = observation.coordination_mean = nan;
    loaded = true;
  }

  /// Removes the bodies that have left the world or have entered a region that removes them, then brings in
  /// or removes the bodies whose lifetime begins or ends, and then lets the emitters send theirs.
  void come_and_go() {
    if (scene.world && scene.world->leaving == Leaving::remove)
      left += take_out(stepper->bodies_beyond(*scene.world)).count;
    for (std::size_t r = 0; r < scene.regions.size(); ++r)
      if (scene.regions[r].removes.value_or(false))
        removed[r] += take_out(stepper->bodies_in(scene.regions[r]));
    if (presence.changes(step)) {
      Presence::Change change;
      stepper->change_bodies(
          [&](Bodies<Host>& bodies) { change = presence.update(step, scene, field(), bodies); });
      account(change);
    }
    emit();
  }

  Removed take_out(const std::vector<BodyNumber>& bodies) {
    if (bodies.empty()) return {};
    const Presence::Change change = presence.account_for_removed(stepper->take_out(bodies), scene, field());
    account(change);
    return {static_cast<std::int64_t>(bodies.size()), -change.exchange.mass};
  }

  /// Lets one emitter after another send its bodies, each where those before it have left room.
  void emit() {
    for (Emission& emission : presence.emissions()) {
      const BodyTable come = emission.emit(
          step, scene, [this](const Vec3& low, const Vec3& high) { return stepper->bodies_near(low, high); });
      if (come.count() == 0) continue;
      stepper->bring_in(come);
      account(presence.account_for_added(come, scene, field()));
    }
  }

  PotentialField field() const { return {stepper->gravity(), reference}; }

  void account(const Presence::Change& change) {
    exchange = exchange + change.exchange;
    steps.change_bodies(change.first_potential, exchange, *stepper);
  }

  void observe_bodies(double time) {
    Observation& o = observation;
    o.time = time;
    o.step = step;
    o.ledger = stepper->ledger;
    o.exchange = exchange;
    o.bodies = presence.count();
    o.left = left;
    o.counters = stepper->counters;
    const Totals totals = stepper->totals(reference);
    measure_totals(totals, steps.baseline(), stepper->gravity(), reference, o);
    o.speed_max = stepper->largest_speed();
    o.requested = presence.requested();
    o.emitted = presence.emitted();
    measure_regions(scene.regions, contents, contents_before, removed, last_step, o.regions);
    if (!loaded) stepper->measure_contacts(totals.count, o);
    o.penetration = Penetration::unknown();
    o.pairs = -1;
    observed = true;
  }

  void observe_overlaps() {
    stepper->measure_overlaps(observation);
    overlaps_observed = true;
  }

  void archive(Archive& archive) {
    if (!observed) observe_bodies(grid.time(step));
    archive("contacts", observation.contacts);
    archive("gap_mean", observation.gap_mean);
    archive("coordination_mean", observation.coordination_mean);
    archive("step", step);
    archive("last_step", last_step);
    archive.part("steps", steps);
    archive("exchange", exchange);
    archive("left", left);
    archive("removed", removed);
    archive.expect(removed.size() == scene.regions.size(), "removed");
    archive.part("presence", presence);
    archive("contents", contents);
    archive("contents_before", contents_before);
    archive.expect(contents.size() == scene.regions.size() && contents_before.size() == contents.size(),
                   "contents");
    archive.part("stepper", *stepper);
    if (!archive.is_loading()) return;
    loaded = true;
    observed = overlaps_observed = false;
  }
};

Simulation::Simulation(const Scene& scene, const SimulationOptions& options)
    : parts_(std::make_unique<Parts>(scene, options)) {}
Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;

void Simulation::step() { parts_->do_step(); }
void Simulation::archive(Archive& archive) { parts_->archive(archive); }
bool Simulation::finished() const { return parts_->step >= parts_->grid.last(); }
double Simulation::time() const { return parts_->grid.time(parts_->step); }
std::int64_t Simulation::steps() const { return parts_->step; }
std::int64_t Simulation::steps_total() const { return parts_->grid.last(); }
const char* Simulation::space_name() const { return parts_->stepper->space_name(); }
const Scene& Simulation::scene() const { return parts_->scene; }

void Simulation::snapshot(Snapshot& out) const {
  out.time = time();
  out.step = parts_->step;
  parts_->stepper->copy_state(out.bodies);
}

std::uint64_t Simulation::state_hash() const {
  BodyTable table;
  parts_->stepper->copy_state(table);
  return hash_of(table);
}

BodyState Simulation::body(std::int32_t id) const {
  const Parts& p = *parts_;
  const SteppedBody body = p.stepper->body(BodyNumber{id});
  if (body.mobility == Mobility::absent) return BodyState::absent();
  BodyState state{.position = body.position,
                  .velocity = body.velocity,
                  .spin = body.spin,
                  .orientation = body.orientation,
                  .start_orientation = p.first_orientation[static_cast<std::size_t>(id)],
                  .acceleration = Vec3::Zero(),
                  .force = Vec3::Zero(),
                  .torque = Vec3::Zero()};
  if (p.step == 0 || !p.presence.holds(id, p.step - 1)) return state;
  state.acceleration = (body.velocity - body.velocity_before) / p.last_step;
  // The contact impulse on a free body is the change of its momentum that gravity and applied forces do not
  // explain.
  state.force = body.mobility == Mobility::free
                    ? Vec3((state.acceleration - body.acceleration) / body.inverse_mass)
                    : Vec3(body.contact_impulse / p.last_step);
  state.torque = body.contact_moment / p.last_step;
  return state;
}

Body Simulation::read_body(std::int32_t id) const {
  const Parts& p = *parts_;
  if (id < 0 || id >= p.scene.bodies.count())
    throw InputError(fmt::format("there is no body {}: they are 0 to {}", id, p.scene.bodies.count() - 1));
  const SteppedBody now = p.stepper->body(BodyNumber{id});
  Body body = body_at(p.scene.bodies, static_cast<std::size_t>(id));
  body.mobility = now.mobility;
  body.mass = 1 / now.inverse_mass;
  body.position = plain(now.position);
  body.orientation = plain(now.orientation);
  body.velocity = plain(now.velocity);
  body.spin = plain(now.spin);
  return body;
}

std::vector<Body> Simulation::bodies() const {
  BodyTable now;
  parts_->stepper->copy_state(now);
  std::vector<Body> all;
  all.reserve(now.position.size());
  for (std::size_t k = 0; k < now.position.size(); ++k) all.push_back(body_at(now, k));
  return all;
}

std::vector<BodyPair> Simulation::pairs() { return parts_->stepper->pairs(); }

std::vector<BodyBox> Simulation::boxes() const { return parts_->stepper->boxes(); }

std::vector<ContactForce> Simulation::contact_forces() const { return parts_->stepper->contact_forces(); }

ContactProblem Simulation::contact_problem() const { return parts_->stepper->contact_problem(); }

GridOccupancy Simulation::grid_occupancy() { return parts_->stepper->grid_occupancy(); }

const Observation& Simulation::observe(bool overlaps) {
  Parts& p = *parts_;
  const timing::Region region("observation");
  if (!p.observed) p.observe_bodies(time());
  if (overlaps && !p.overlaps_observed) p.observe_overlaps();
  return p.observation;
}

}  // namespace scree
