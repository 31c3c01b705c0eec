#include "sim/substepper.hpp"

#include "core/timing.hpp"
#include "core/tolerances.hpp"
#include "sim/contact_problem.hpp"
#include "sim/measurement.hpp"
#include "sim/response_parameters.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace scree {

void Substepper::Restart::save(const Substepper& now) {
  state.save(now.bodies_);
  gravity = now.parameters_.gravity;
  ledger = now.ledger;
  impacts = now.counters.impacts;
  unfinished_impacts = now.counters.unfinished_impacts;
  contact_impulse = now.contact_impulse_;
  contact_moment = now.contact_moment_;
}

void Substepper::Restart::restore(Substepper& now) const {
  state.restore(now.bodies_);
  now.parameters_.gravity = gravity;
  now.ledger = ledger;
  now.counters.impacts = impacts;
  now.counters.unfinished_impacts = unfinished_impacts;
  now.contact_impulse_ = contact_impulse;
  now.contact_moment_ = contact_moment;
}

Substepper::Substepper(const Scene& scene, const TimeGrid& grid, const PathTable& paths, bool on_device,
                       const Vec3& origin)
    : grid_(grid),
      geometry_(scene.geometry),
      paths_(paths),
      parameters_(response_parameters_of(scene)),
      materials_(static_cast<std::int64_t>(scene.materials.size())),
      forces_(scene, grid),
      gravity_(scene),
      kept_pairs_(scene.broadphase, on_device, origin),
      narrow_phase_(scene.narrowphase, shapes()),
      end_narrow_phase_({.box_box = scene.narrowphase.box_box, .convex = scene.narrowphase.convex},
                        shapes()) {
  copy_bodies(bodies_, scene.bodies);
  std::vector<Guide> guides;
  for (const Servo& servo : scene.servos) guides.push_back({servo.body, servo.axis});
  copy(guides_, guides);
  parameters_.guides = std::as_const(guides_).view();
  copy(laws_, pair_laws_of(scene));
  contact_impulse_.assign(scene.bodies.position.size(), Vec3::Zero());
  if (!scene.meshes.empty()) contact_moment_.assign(scene.bodies.position.size(), Vec3::Zero());
  start_.save(bodies_);
}

void Substepper::start_step(std::int64_t step) {
  step_ = step;
  start_.save(bodies_);
  start_ledger_ = ledger;
  start_gravity_ = parameters_.gravity;
  gravity_.start_step();
  std::fill(contact_impulse_.begin(), contact_impulse_.end(), Vec3(Vec3::Zero()));
  std::fill(contact_moment_.begin(), contact_moment_.end(), Vec3(Vec3::Zero()));
  forces_.act(step, bodies_, parameters_);
}

void Substepper::undo_step() {
  start_.restore(bodies_);
  ledger = start_ledger_;
  parameters_.gravity = start_gravity_;
  forget_pairs();
  memory_ = {};
  // The failed step may have left them half made.
  contacts_ = {};
  struck_.clear();
}

void Substepper::change_bodies(const std::function<void(Bodies<Host>&)>& change) {
  change(bodies_);
  forget_pairs();
}

BodyTable Substepper::take_out(const std::vector<BodyNumber>& numbers) {
  BodyTable gone = scree::take_out<Host>(numbers, bodies_);
  forget_pairs();
  return gone;
}

void Substepper::bring_in(const BodyTable& bodies) {
  scree::bring_in<Host>(bodies, bodies_);
  forget_pairs();
}

/// Others of the bodies are there now, or somewhere else.
void Substepper::forget_pairs() {
  kept_pairs_.forget();
  forces_.forget();
}

void Substepper::archive(Archive& archive) {
  archive("step", step_);
  archive("last_substep", last_substep_);
  archive("ledger", ledger);
  archive("counters", counters);
  archive.part("bodies", bodies_);
  archive("velocity_before", start_.velocity);
  archive.expect(start_.velocity.size() == bodies_.count(), "velocity_before");
  archive("contact_impulse", contact_impulse_);
  archive.expect(std::ssize(contact_impulse_) == bodies_.count(), "contact_impulse");
  const std::size_t moments = contact_moment_.size();
  archive("contact_moment", contact_moment_);
  archive.expect(contact_moment_.size() == moments, "contact_moment");
  archive.part("kept_pairs", kept_pairs_);
  archive.part("memory", memory_);
  gravity_.archive(archive, parameters_);
  if (!archive.is_loading()) return;
  forces_.forget();
  forces_.act(step_, bodies_, parameters_);
}

// What stops by a blow and not by friction does so no sooner in a shorter part: then cuts do not help, and
// there are none.
void Substepper::substep(double h, double done) {
  constexpr int most_cuts = 16;
  constexpr double helps = 0.25;  // of what the cut before it found too long
  const double end = done + h;
  int cuts = 0;
  bool cuts_help = parameters_.accurate;
  while (done < end) {
    double part = end - done;
    if (cuts_help) before_.save(*this);
    Manifolds manifolds = fly_and_respond(part, done);
    double last = HUGE_VAL;
    while (cuts_help && response_.slip_end() < 1) {
      const double too_long = 1 - response_.slip_end();
      cuts_help = too_long < helps * last && ++cuts <= most_cuts;
      part = cuts_help ? response_.slip_end() * part : end - done;
      last = too_long;
      before_.restore(*this);
      manifolds = fly_and_respond(part, done);
    }
    fly_on(manifolds, part, done);
    done = part < end - done ? done + part : end;
  }
  counters.cuts += cuts;
}

/// Moreau's midpoint step. Its first half: free flight to the midpoint, impacts on the way, contacts there,
/// impulses. `done`: how much of the step went before (s).
Manifolds Substepper::fly_and_respond(double h, double done) {
  struck_.clear();
  turn_gravity(grid_.time(step_) + done + 0.5 * h);
  forces_.start_substep(bodies_);
  {
    const timing::Region region("integration");
    fly(grid_.time(step_) + done + 0.5 * h, 0.5 * h);
  }
  resolve_impacts(h, 0, reach_from(h, done));
  const Manifolds manifolds = find_contacts(h, reach_from(h, done));
  respond(manifolds, h);
  return manifolds;
}

/// And its second: impacts on the way, since the response has changed it, and free flight to the end.
void Substepper::fly_on(const Manifolds& manifolds, double h, double done) {
  resolve_impacts(h, 0.5 * h, reach_from(h, done));
  if (!impacts_.impacts().empty()) load_solver_bodies(bodies_, solver_);
  fly(grid_.time(step_) + done + h, 0.5 * h);
  ledger.work += forces_.work(bodies_);
  gravity_.count(h, parameters_);
  ledger = ledger + corrector_.correct(h, parameters_, view_of(bodies_), solver_, contacts_);
  memory_.remember(manifolds, contacts_, bodies_.count());
  for (std::int64_t k = 0; k < contacts_.others(); ++k) {
    const Contact& c = std::as_const(contacts_.contacts).view()[k];
    if (c.free_ends == 2) continue;
    add_impulse_on_driven_bodies(c.i, c.j, contacts_.impulse_of(c));
    if (contact_moment_.empty()) continue;
    for (int r = 0; r < c.count; ++r) {
      const ContactRow& row = std::as_const(contacts_.rows).view()[c.first_row + r];
      add_moment_on_triangle(c.i, -row.arm_i.cross(row.impulse));
      add_moment_on_triangle(c.j, row.arm_j.cross(row.impulse));
    }
  }
  contacts_.batches.for_each_driven_pair([this](std::int32_t i, std::int32_t j, const Vec3& impulse) {
    add_impulse_on_driven_bodies(i, j, impulse);
  });
  last_substep_ = h;
}

/// Time from a substep to the end of its step, and as long again as the substep (s).
double Substepper::reach_from(double h, double done) const { return grid_.length(step_ + 1) - done + h; }

/// To what it is at a time (s), the midpoint of the substep that begins.
void Substepper::turn_gravity(double midpoint) {
  if (!gravity_.turns()) return;
  ledger.work += gravity_.turn_to<Host>(midpoint, bodies_, parameters_);
  forces_.forget();
  forces_.act(step_, bodies_, parameters_);
}

/// Moves every body to the time given, dt later than it is.
void Substepper::fly(double time, double dt) {
  ledger.integration += advance<Host>(bodies_, dt, parameters_);
  place_prescribed(paths_, time, bodies_);
}

/// Impacts of the flight of a substep from `problem.from` on. `reach`: to the end of the step (s).
void Substepper::resolve_impacts(double h, double from, double reach) {
  constexpr int most_attempts = 8;
  // The flight is never more than half a substep away from the midpoint.
  const auto set_margins = [&] {
    contact_margins(bodies_, 0.5 * h, tolerance::contact_slack, parameters_, contact_margin_);
  };
  set_margins();
  for (int attempt = 1;; ++attempt) {
    const ConstView<Pair> pairs = kept_pairs_.covering(bodies_, contact_margin_, reach, parameters_);
    const timing::Region region("impacts");
    const Ledger moved = impacts_.resolve(impact_problem(pairs, h, from), parameters_, view_of(bodies_));
    if (impacts_.impacts().empty()) return;
    // What was struck may have left the boxes: others that it can meet now are not among the pairs.
    set_margins();
    if (attempt == most_attempts || kept_pairs_.cover(bodies_, contact_margin_)) {
      ledger = ledger + moved;
      break;
    }
    kept_pairs_.add_travel(bodies_, contact_margin_);
    impacts_.undo(view_of(bodies_));
  }
  counters.impacts += static_cast<std::int64_t>(impacts_.impacts().size());
  if (impacts_.hit_bound()) ++counters.unfinished_impacts;
  for (const Impact& impact : impacts_.impacts()) {
    add_impulse_on_driven_bodies(impact.i, impact.j, impact.impulse);
    const auto arm = [&](std::int32_t body) {
      return bodies_.period.nearest(impact.point - std::as_const(bodies_.position).view()[body]);
    };
    add_moment_on_triangle(impact.i, -arm(impact.i).cross(impact.impulse));
    add_moment_on_triangle(impact.j, arm(impact.j).cross(impact.impulse));
    struck_.push_back(impact);
  }
}

/// That may close by the next midpoint. `reach`: to the end of the step (s).
Manifolds Substepper::find_contacts(double h, double reach) {
  contact_margins(bodies_, h, tolerance::contact_slack, parameters_, contact_margin_);
  const ConstView<Pair> pairs = kept_pairs_.covering(bodies_, contact_margin_, reach, parameters_);
  const ConstBodyView views = view_of(std::as_const(bodies_));
  BallPairs& balls = memory_.balls;
  if (counters.pcs_made != kept_pairs_.times_made()) balls.take(views, pairs, contact_laws(), parameters_);
  counters.pcs_made = kept_pairs_.times_made();
  const timing::Region region("narrowphase");
  const LateBodies* late = impacts_.late_bodies(impact_problem(pairs, h, 0), parameters_, view_of(bodies_));
  any_late_ = late != nullptr;
  balls.find(views, contact_margin_.view(), late);
  const Manifolds manifolds =
      narrow_phase_.find(views, balls.others(pairs, late), contact_margin_.view(), late);
  impacts_.take_normals_of_faces(impact_problem(pairs, h, 0), parameters_, view_of(bodies_),
                                 narrow_phase_.headers(), narrow_phase_.points());
  counters.narrowphase += narrow_phase_.stats();
  counters.narrowphase.tested += balls.tested();
  return manifolds;
}

void Substepper::respond(const Manifolds& manifolds, double h) {
  const timing::Region region("response");
  load_solver_bodies(bodies_, solver_);
  color_contacts(memory_.balls, manifolds.headers, std::as_const(bodies_.mobility).view(),
                 contacts_.coloring);
  const double scale = last_substep_ > 0 ? h / last_substep_ : 1.0;
  prepare_contacts(manifolds, contact_laws(), memory_, scale, parameters_, contacts_);
  impacts_.mark_flights(impact_problem({}, h, 0), parameters_, manifolds, view_of(bodies_), contacts_,
                        memory_.balls);
  ledger =
      ledger + response_.solve(manifolds, h, parameters_, memory_.balls, parameters_.warm_start ? scale : 0.0,
                               view_of(bodies_), solver_, contacts_, counters);
  if (any_late_) contacts_.list_all(solver_.view());
  ledger = ledger + impacts_.shift_late(impact_problem({}, h, 0), parameters_, view_of(bodies_), contacts_);
}

/// For the state as it is, with its margins. Valid until the next call.
ConstView<Pair> Substepper::pairs_now() {
  contact_margins(bodies_, 0, tolerance::contact_slack, parameters_, contact_margin_);
  return kept_pairs_.covering(bodies_, contact_margin_, 0, parameters_);
}

ImpactProblem Substepper::impact_problem(ConstView<Pair> pairs, double h, double from) const {
  return {.pairs = pairs,
          .memory = memory_,
          .terms = {.laws = contact_laws(), .step = h, .from = from, .bounces = from == 0}};
}

ContactLaws Substepper::contact_laws() const {
  return {bodies_.shape.view(),
          bodies_.size.view(),
          bodies_.mobility.view(),
          bodies_.material.view(),
          laws_.view(),
          materials_,
          shapes()};
}

/// Bodies are in the order of their numbers here, as in the scene.
ConstView<ShapeData> Substepper::shapes() const {
  if (!geometry_) return {};
  return {geometry_->of_body.data(), std::ssize(geometry_->of_body)};
}

/// The impulse of j, and reversed of i.
void Substepper::add_impulse_on_driven_bodies(std::int32_t i, std::int32_t j, const Vec3& impulse) {
  const ConstView<Mobility> mobility = std::as_const(bodies_.mobility).view();
  if (mobility[i] != Mobility::free) contact_impulse_[static_cast<std::size_t>(i)] -= impulse;
  if (mobility[j] != Mobility::free) contact_impulse_[static_cast<std::size_t>(j)] += impulse;
}

/// About its centre.
void Substepper::add_moment_on_triangle(std::int32_t id, const Vec3& moment) {
  if (!contact_moment_.empty() && std::as_const(bodies_.shape).view()[id] == Shape::triangle)
    contact_moment_[static_cast<std::size_t>(id)] += moment;
}

SteppedBody Substepper::body(BodyNumber number) const {
  const ConstBodyView views = view_of(bodies_);
  const std::int32_t place = views.place(number);
  const bool guided =
      std::ranges::any_of(guides_.view(), [place](const Guide& guide) { return guide.body == place; });
  // A servo's drive bears its weight, whatever that is.
  const Vec3 excess =
      guided ? Vec3(Vec3::Zero()) : gravity_.excess_of_mean(grid_.length(step_ + 1), parameters_);
  return {.mobility = views.mobility[place],
          .inverse_mass = views.inverse_mass[place],
          .position = views.position[place],
          .orientation = views.orientation[place],
          .velocity = views.velocity[place],
          .spin = views.spin[place],
          .velocity_before = start_.velocity.view()[place],
          .acceleration = parameters_.acceleration_of(place) + excess,
          .contact_impulse = contact_impulse_[static_cast<std::size_t>(place)],
          .contact_moment = contact_moment_.empty() ? Vec3(Vec3::Zero())
                                                    : contact_moment_[static_cast<std::size_t>(place)]};
}

/// The volume of polyhedra is not told by their sizes.
RegionContents Substepper::contents_of(const Region& region) const {
  RegionContents contents = scree::contents_of<Host>(region, bodies_);
  if (!geometry_) return contents;
  for (const BodyNumber number : bodies_in(region)) {
    const std::int32_t k = view_of(bodies_).place(number);
    const Hull* hull = shapes()[k].hull;
    if (hull) contents.volume += hull->volume - volume_of(Shape::polyhedron, bodies_.size.view()[k]);
  }
  return contents;
}

Energies Substepper::energies(const Vec3& reference) const {
  return energies_of<Host>(bodies_, parameters_.gravity, reference);
}
Totals Substepper::totals(const Vec3& reference) const {
  return totals_of<Host>(bodies_, parameters_.gravity, reference);
}

std::vector<BodyPair> Substepper::pairs() {
  std::vector<BodyPair> pairs;
  const ConstView<Shape> shape = std::as_const(bodies_.shape).view();
  for (const Pair& pair : pairs_now()) {
    if (shape[pair.i] != Shape::plane && shape[pair.j] != Shape::plane) pairs.push_back({pair.i, pair.j});
  }
  return pairs;
}

GridOccupancy Substepper::grid_occupancy() {
  pairs_now();
  return kept_pairs_.grid_occupancy();
}

void Substepper::measure_overlaps(Observation& out) {
  const ConstView<Pair> pairs = pairs_now();
  out.pairs = kept_pairs_.size();
  const ConstBodyView views = view_of(std::as_const(bodies_));
  measure_penetration(end_narrow_phase_.find(views, pairs, contact_margin_.view()), views, out.penetration);
}

void Substepper::measure_contacts(std::int64_t free_bodies, Observation& out) const {
  scree::measure_contacts(listed_contacts(), free_bodies, out);
}

const ContactSet& Substepper::listed_contacts() const {
  contacts_.list_all(solver_.view());
  return contacts_;
}

std::vector<ContactForce> Substepper::contact_forces() const {
  const ConstView<Contact> contacts = listed_contacts().contacts.view();
  const ConstView<ContactRow> rows = listed_contacts().rows.view();
  const ConstBodyView views = view_of(bodies_);
  std::vector<ContactForce> forces;
  for (std::int64_t c = 0; c < contacts.size(); ++c) {
    const Contact& contact = contacts[c];
    const Vec3 impulse = contacts_.impulse_of(contact);
    if (impulse.isZero(0)) continue;
    // From the body that moves freely: the centre of a plane is nowhere near.
    const bool from_j = views.mobility[contact.j] == Mobility::free;
    Vec3 arm = Vec3::Zero();
    for (int k = 0; k < contact.count; ++k) {
      const ContactRow& row = rows[contact.first_row + k];
      arm += (from_j ? row.arm_j : row.arm_i) / contact.count;
    }
    forces.push_back({contact.i, contact.j, impulse / last_substep_,
                      views.position[from_j ? contact.j : contact.i] + arm});
  }
  for (const Impact& impact : struck_)
    forces.push_back({impact.i, impact.j, impact.impulse / last_substep_, impact.point});
  return forces;
}

ContactProblem Substepper::contact_problem() const {
  return contact_problem_of(listed_contacts(), solver_.view(), response_.free_velocity(),
                            response_.free_spin());
}

}  // namespace scree
