#include "sim/simulation.hpp"

#include "core/error.hpp"
#include "core/timing.hpp"
#include "core/tolerances.hpp"
#include "narrowphase/narrow_phase.hpp"
#include "sim/dynamics/region.hpp"
#include "sim/measurement.hpp"
#include "sim/presence.hpp"
#include "sim/scene/time_grid.hpp"
#include "sim/substepper.hpp"

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace scree {

namespace {

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

}  // namespace

struct Simulation::Parts {
  Scene scene;
  TimeGrid grid;
  Presence presence;
  tbb::global_control threads;
  Vec3 origin;
  Substepper substepper;
  NarrowPhase end_narrow_phase;  // for the penetration at the end of a step

  std::int64_t step = 0;
  int substeps = 1;      // of the next, if the scene leaves it open
  double last_step = 0;  // its length
  MovingState start;     // of the last step
  std::vector<Quat> first_orientation;
  Exchange exchange;  // potential energy about `origin`
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
        origin(middle_of(s.bodies)),
        substepper(s, grid, runs_on_device(options.space), origin),
        end_narrow_phase({.box_box = s.narrowphase.box_box}) {
    presence.begin(substepper.bodies);
    for (PrescribedPath& path : substepper.paths.view())
      path.start = grid.time(presence.first_step(path.body));
    first_orientation = scene.bodies.orientation;
    start.save(substepper.bodies);
    baseline.start(totals_of(substepper.bodies, substepper.parameters().gravity, origin),
                   lifting_energy(scene));
    contents = contents_before = region_contents();
  }

  std::vector<RegionContents> region_contents() const {
    std::vector<RegionContents> all;
    for (const Region& region : scene.regions) all.push_back(contents_of(region, substepper.bodies));
    return all;
  }

  void do_step() {
    const double dt = grid.length(step + 1);
    const int n = scene.time.substeps.value_or(substeps);
    const double h = dt / n;
    double overlap = 0;
    start.save(substepper.bodies);
    const Ledger ledger_before = substepper.ledger;
    try {
      substepper.start_step(step);
      for (int s = 0; s < n; ++s) {
        substepper.substep(h, s * h);
        overlap = std::max(overlap, substepper.overlap());
      }
      baseline.extend(totals_of(substepper.bodies, substepper.parameters().gravity, origin));
      if (!baseline.is_finite()) throw RunError(non_finite_body());
    } catch (const RunError& error) {
      start.restore(substepper.bodies);
      substepper.ledger = ledger_before;
      throw RunError(fmt::format("step {} (t = {} s): {}", step + 1, grid.time(step), error.what()));
    }
    if (overlap > tolerance::substep_overlap) substeps = std::min(2 * n, tolerance::most_substeps);
    if (overlap < tolerance::coarser_overlap) substeps = std::max(n / 2, 1);
    substepper.counters.substeps += n;
    ++step;
    come_and_go();
    contents_before = std::exchange(contents, region_contents());
    last_step = dt;
    observed = overlaps_observed = false;
  }

  /// Bodies whose time has come or is over.
  void come_and_go() {
    const Presence::Change change = presence.update(step, scene, origin, substepper.bodies);
    if (!change.any) return;
    exchange = exchange + change.exchange;
    baseline.exchange(change.first_potential);
    baseline.extend(totals_of(substepper.bodies, substepper.parameters().gravity, origin));
    substepper.forget_pairs();
  }

  void observe_bodies(double time) {
    Observation& o = observation;
    o.time = time;
    o.step = step;
    o.ledger = substepper.ledger;
    o.exchange = exchange;
    o.bodies = presence.count();
    o.counters = substepper.counters;
    const Totals totals = totals_of(substepper.bodies, substepper.parameters().gravity, origin);
    measure_totals(totals, baseline, substepper.parameters().gravity, origin, o);
    o.speed_max = largest_speed(substepper.bodies);
    measure_regions(scene.regions, contents, contents_before, last_step, o.regions);
    measure_contacts(substepper.contacts(), totals.count, o);
    o.penetration = Penetration::unknown();
    o.pairs = -1;
    observed = true;
  }

  void observe_overlaps() {
    const ConstView<Pair> pairs = substepper.pairs_now();
    observation.pairs = substepper.kept_pairs().size();
    measure_penetration(
        end_narrow_phase.find(view_of(std::as_const(substepper.bodies)), pairs, substepper.margins()),
        view_of(std::as_const(substepper.bodies)), observation.penetration);
    overlaps_observed = true;
  }

  std::string non_finite_body() const {
    for (std::int64_t k = 0; k < substepper.bodies.count(); ++k) {
      const auto views = view_of(std::as_const(substepper.bodies));
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
const char* Simulation::space_name() const { return parts_->substepper.kept_pairs().space_name(); }

void Simulation::snapshot(Snapshot& out) const {
  out.time = time();
  out.step = parts_->step;
  copy_bodies(out.bodies, parts_->substepper.bodies);
}

std::uint64_t Simulation::state_hash() const {
  BodyTable table;
  copy_bodies(table, parts_->substepper.bodies);
  return hash_of(table);
}

BodyState Simulation::body(std::int32_t id) const {
  const Parts& p = *parts_;
  const auto k = static_cast<std::size_t>(id);
  const ConstBodyView views = view_of(std::as_const(p.substepper.bodies));
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
                    ? Vec3((state.acceleration - p.substepper.parameters().acceleration_of(id)) /
                           views.inverse_mass[id])
                    : Vec3(p.substepper.contact_impulse(id) / p.last_step);
  return state;
}

std::vector<BodyPair> Simulation::pairs() {
  std::vector<BodyPair> pairs;
  const ConstView<Shape> shape = std::as_const(parts_->substepper.bodies.shape).view();
  for (const Pair& pair : parts_->substepper.pairs_now()) {
    if (shape[pair.i] != Shape::plane && shape[pair.j] != Shape::plane) pairs.push_back({pair.i, pair.j});
  }
  return pairs;
}

std::vector<BodyBox> Simulation::boxes() const { return parts_->substepper.kept_pairs().boxes(); }

std::vector<ContactForce> Simulation::contact_forces() const { return parts_->substepper.contact_forces(); }

ContactProblem Simulation::contact_problem() const { return parts_->substepper.contact_problem(); }

GridOccupancy Simulation::grid_occupancy() {
  parts_->substepper.pairs_now();
  return parts_->substepper.kept_pairs().grid_occupancy();
}

const Observation& Simulation::observe(bool overlaps) {
  Parts& p = *parts_;
  const timing::Region region("observation");
  if (!p.observed) p.observe_bodies(time());
  if (overlaps && !p.overlaps_observed) p.observe_overlaps();
  return p.observation;
}

}  // namespace scree
