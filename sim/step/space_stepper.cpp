#include "sim/step/space_stepper.hpp"

#include "core/error.hpp"
#include "core/geometry.hpp"
#include "core/space_chosen.hpp"
#include "core/timing.hpp"
#include "core/tolerances.hpp"
#include "sim/bodies/applied_forces.hpp"
#include "sim/bodies/body_order.hpp"
#include "sim/bodies/coming_and_going.hpp"
#include "sim/bodies/motion.hpp"
#include "sim/bodies/turning_gravity.hpp"
#include "sim/impacts/impact_rounds.hpp"
#include "sim/model/resolved_response.hpp"
#include "sim/observe/overlaps.hpp"
#include "sim/pairs/pair_finder.hpp"
#include "sim/response/contact_inspection.hpp"
#include "sim/response/contact_solver.hpp"
#include "sim/step/moving_state.hpp"
#include "sim/step/wall_impacts.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

namespace scree {

namespace {

/// Returns whether the list holds each number from 0 on once.
bool are_numbers(std::vector<BodyNumber> list) {
  std::ranges::sort(list);
  for (std::size_t k = 0; k < list.size(); ++k)
    if (index_of(list[k]) != k) return false;
  return true;
}

/// The stepper of one space. Real: type of the impulses and of the velocities with which they are found.
template <class Space, class Real>
class SpaceStepper final : public Stepper {
 public:
  /// If options.on_device, the PCS is found on Device, even for bodies on Host.
  SpaceStepper(const Scene& scene, const TimeGrid& grid, const PathTable& paths,
               const StepperOptions& options)
      : grid_(grid),
        steps_in_order_(options.steps_in_order),
        sums_impulses_on_walls_(options.sums_impulses_on_walls),
        geometry_(scene.geometry),
        paths_(paths),
        parameters_(response_parameters_of(scene)),
        forces_(scene, grid),
        gravity_(scene),
        order_(scene.bodies, options.origin),
        kept_pairs_(scene.broadphase, options.on_device, options.origin),
        seen_pairs_(scene.broadphase, options.on_device, options.origin),
        libccd_(scene.narrowphase) {
    copy_bodies(bodies_, scene.bodies);
    find_places<Space>(bodies_);
    for (const Servo& servo : scene.servos) servo_axis_[BodyNumber{servo.body}] = servo.axis;
    find_guides();
    copy(laws_, pair_laws_of(scene));
    materials_ = static_cast<std::int64_t>(scene.materials.size());
    find_shapes();
    wall_impacts_.find_walls(scene.bodies.id, scene.bodies.mobility);
    start_.save(bodies_);
  }

  void start_step(std::int64_t step) override {
    step_ = step;
    start_ledger_ = ledger;
    start_gravity_ = parameters_.gravity;
    start_.save(bodies_);
    if (step % steps_in_order_ == 0) {
      sort_bodies();  // if memory runs out here, no body has moved, and the state is saved already
      start_.save(bodies_);
    }
    gravity_.start_step();
    clear_wall_impulses();
    forces_.act(step, bodies_, parameters_);
  }

  void substep(double h, double done) override;
  double overlap() const override { return contacts_.overlap(); }
  bool has_heap() const override { return contacts_.has_heap(); }
  OverlapsLeft overlaps_left() const override {
    const timing::Region region("correction");
    const Penetration left = scree::measure_overlaps<Space>(view_of(bodies_), std::as_const(shapes_).view(),
                                                            kept_pairs_.pairs(), Quantiles::none);
    return {left.relative_mean, left.relative_max};
  }

  void undo_step() override {
    start_.restore(bodies_);
    ledger = start_ledger_;
    parameters_.gravity = start_gravity_;
    forget_pairs();
    contacts_ = {};
    struck_.clear();
    have_moved_ = false;
  }

  void change_bodies(const std::function<void(Bodies<Host>&)>& change) override {
    Bodies<Host> on_host;
    copy_bodies(on_host, bodies_);
    change(on_host);
    copy_bodies(bodies_, on_host);
    wall_impacts_.find_walls(to_vector(on_host.id), to_vector(on_host.mobility));
    forget_pairs();
  }
  BodyTable take_out(const std::vector<BodyNumber>& numbers) override {
    BodyTable gone = scree::take_out<Space>(numbers, bodies_);
    forget_pairs();
    return gone;
  }
  void bring_in(const BodyTable& bodies) override {
    scree::bring_in<Space>(bodies, bodies_);
    forget_pairs();
  }

  void archive(Archive& archive) override;

  void copy_state(BodyTable& out) const override { copy_by_number<Space>(out, bodies_); }
  SteppedBody body(BodyNumber number) const override;
  Vec3 gravity() const override { return parameters_.gravity; }
  Energies energies(const Vec3& reference) const override {
    return energies_of<Space>(bodies_, parameters_.gravity, reference);
  }
  Totals totals(const Vec3& reference) const override {
    return totals_of<Space>(bodies_, parameters_.gravity, reference);
  }
  double largest_speed() const override { return scree::largest_speed<Space>(bodies_); }
  RegionContents contents_of(const Region& region) const override;
  std::vector<BodyNumber> bodies_beyond(const World& world) const override {
    return scree::bodies_beyond<Space>(world, bodies_);
  }
  std::vector<BodyNumber> bodies_in(const Region& region) const override {
    return scree::bodies_in<Space>(region, bodies_);
  }
  BodyTable bodies_near(const Vec3& low, const Vec3& high) const override {
    return scree::bodies_near<Space>(low, high, bodies_);
  }

  std::vector<BodyPair> pairs() override;
  GridOccupancy grid_occupancy() override {
    pairs_now();
    GridOccupancy grid = pairs_seen().grid_occupancy();
    grid.level = by_number(grid.level);
    return grid;
  }
  std::vector<BodyBox> boxes() const override { return by_number(kept_pairs_.boxes()); }
  void measure_overlaps(Observation& out) override {
    const ConstView<Pair> pairs = pairs_now();
    out.pairs = pairs_seen().size();
    out.penetration = scree::measure_overlaps<Space>(view_of(std::as_const(bodies_)), shapes_.view(), pairs);
  }

  ContactProblem contact_problem() const override;
  std::vector<ContactForce> contact_forces() const override;
  void measure_contacts(std::int64_t free_bodies, Observation& out) const override;

  const char* space_name() const override { return kept_pairs_.space_name(); }

 private:
  static constexpr bool is_device = !std::is_same_v<Space, Host>;

  BodyView views() { return view_of(bodies_); }
  /// Sorts the bodies along a curve. All that was found for their old places is forgotten, except what
  /// contacts remember. The boxes of the new pairs suit the bodies' present speeds, and not those of long
  /// ago.
  void sort_bodies() {
    const timing::Region region("broadphase");
    order_.sort(bodies_);
    have_moved_ = true;
    walls_are_listed_ = false;
    forces_.forget();
    kept_pairs_.forget();
    seen_pairs_.forget();
    find_shapes();
    find_guides();
  }
  void clear_wall_impulses() {
    impulses_on_walls_known_ = sums_impulses_on_walls_;
    if (!sums_impulses_on_walls_) return;
    if (walls_are_listed_) {
      contacts_.wall_sums().start_step();
    } else {
      contacts_.wall_sums().list_walls(std::as_const(bodies_).mobility.view());
    }
    walls_are_listed_ = true;
    wall_impacts_.clear();
  }
  void find_guides() {
    std::vector<Guide> guides;
    for (const auto& [number, axis] : servo_axis_) guides.push_back({place(number), axis});
    copy(guides_, guides);
    parameters_.guides = std::as_const(guides_).view();
  }
  ConstView<std::int32_t> place_before() const {
    return have_moved_ ? order_.place_before() : ConstView<std::int32_t>{};
  }
  /// Sets the shape data of each place. General shapes are known on Host alone.
  void find_shapes() {
    if constexpr (!is_device) {
      if (!geometry_) return;
      shapes_.resize(bodies_.count());
      for (std::int64_t k = 0; k < bodies_.count(); ++k)
        shapes_.view()[k] = geometry_->of_body[index_of(bodies_.id.view()[k])];
    }
  }
  std::int32_t place(BodyNumber number) const {
    std::int32_t place;
    copy_bytes<Host, Space>(&place, bodies_.place_of.data() + index_of(number), sizeof(place));
    return place;
  }
  /// Returns one value of a field of the bodies, or of another list by place.
  template <class List>
  auto value_at(const List& list, std::int32_t place) const {
    std::remove_cvref_t<decltype(list.data()[0])> value;
    copy_bytes<Host, Space>(&value, list.data() + place, sizeof(value));
    return value;
  }
  /// Returns a list by place, which may be empty, in the order of the bodies' numbers.
  template <class T>
  std::vector<T> by_number(const std::vector<T>& by_place) const {
    std::vector<T> ordered;
    if (by_place.empty()) return ordered;
    for (const std::int32_t place : to_vector(bodies_.place_of))
      ordered.push_back(by_place[static_cast<std::size_t>(place)]);
    return ordered;
  }
  /// Must be called when bodies have come or gone, or have been moved other than by a step.
  void forget_pairs() {
    walls_are_listed_ = false;
    forces_.forget();
    kept_pairs_.forget();
    seen_pairs_.forget();
    contacts_.change_bodies();
  }
  FlightTerms terms(double h, double from) const {
    return {.laws = {bodies_.shape.view(), bodies_.size.view(), bodies_.mobility.view(),
                     bodies_.material.view(), laws_.view(), materials_, shapes_.view()},
            .step = h,
            .from = from,
            .bounces = from == 0};
  }

  /// Sets gravity for the substep that begins, to its value at the midpoint (a time in s).
  void turn_gravity(double midpoint) {
    if (!gravity_.turns()) return;
    ledger.work += gravity_.turn_to<Space>(midpoint, bodies_, parameters_);
    forces_.forget();
    forces_.act(step_, bodies_, parameters_);
  }
  void fly(double time, double dt) {
    const timing::Region region("integration");
    ledger.integration += advance<Space>(bodies_, dt, parameters_);
    place_prescribed<Space>(paths_, time, bodies_);
  }
  bool fly_and_respond(double h, double done, bool may_be_undone);
  void fly_on(double h, double done, bool any_late_impact);
  void give_candidates(ConstView<Pair> pairs);
  ConstView<std::int64_t> known(ConstView<Pair> pairs);
  ConstView<LoadedParts> loads_of(ConstView<Pair> pairs);
  bool resolve_impacts(double h, double from, double foresight, double midpoint);
  Vec3 arm_on_wall(const Impact& impact, BodyNumber wall) const;

  /// Finds the pairs for the present state. If the step's pairs no longer cover it, others are made apart,
  /// because the pairs that the step keeps must not depend on observations.
  ConstView<Pair> pairs_now();
  const KeptPairs<Space>& pairs_seen() const { return sees_kept_ ? kept_pairs_ : seen_pairs_; }
  TimeGrid grid_;
  std::int64_t steps_in_order_;
  bool sums_impulses_on_walls_;
  std::shared_ptr<const Geometry> geometry_;
  std::int64_t step_ = 0;
  Bodies<Space> bodies_;
  Array<ShapeData, Space> shapes_;  // by place; empty if no body's shape is general
  std::map<BodyNumber, Vec3> servo_axis_;
  Array<Guide, Space> guides_;  // by place
  PrescribedPaths<Space> paths_;
  ResponseParameters parameters_;
  Array<PairLaw, Space> laws_;
  std::int64_t materials_ = 0;
  AppliedForces<Space> forces_;
  TurningGravity gravity_;
  BodyOrder<Space> order_;
  bool have_moved_ = false;  // whether bodies changed places since the contacts last took candidates
  KeptPairs<Space> kept_pairs_;
  KeptPairs<Space> seen_pairs_;
  bool sees_kept_ = true;
  std::int64_t pairs_taken_ = 0;  // kept_pairs_.times_made() when the contacts last took candidates
  std::int64_t pairs_known_ = 0;  // kept_pairs_.times_made() when known_ was found
  Array<std::int64_t, Space> known_;
  Array<LoadedParts, Space> loads_;
  LibccdContacts libccd_;
  ImpactRounds<Space> impacts_;
  mutable solver::ContactSolver<Space, Real> contacts_;  // mutable: inspect() shows them in place on Host

  double last_substep_ = 0;  // length of the last substep (s); scales the remembered impulses
  MovingState<Space> start_;
  Ledger start_ledger_;
  Vec3 start_gravity_ = Vec3::Zero();
  WallImpacts wall_impacts_;  // of the step
  bool impulses_on_walls_known_ = false;
  // Whether the wall sums know which bodies are walls, at their present places.
  bool walls_are_listed_ = false;
  /// The data that the first half of a substep changes, besides what contacts remember.
  struct Restart {
    MovingState<Space> state;
    Vec3 gravity;
    Ledger ledger;
    std::int64_t impacts = 0, unfinished_impacts = 0;
    Array<solver::WallImpulse, Space> on_walls;
    WallImpacts wall_impacts;

    void save(const SpaceStepper& now);
    void restore(SpaceStepper& now) const;
  };
  Restart before_;  // state before the part of a substep that may be taken again, in the accurate mode
  Array<double, Space> contact_margin_;
  std::vector<Impact> struck_;  // impacts of the last substep
};

/// Takes a substep; in the accurate mode in parts that end where a sliding contact comes to stick. A contact
/// that a blow stops, and not friction, still sticks too early in a shorter part: then cuts do not help, and
/// the rest of the substep is taken whole.
template <class Space, class Real>
void SpaceStepper<Space, Real>::substep(double h, double done) {
  constexpr int most_cuts = 16;
  constexpr double helps = 0.25;  // a cut helps if less than this share of the excess before it is left
  const double end = done + h;
  int cuts = 0;
  bool cuts_help = parameters_.accurate;
  while (done < end) {
    double part = end - done;
    if (cuts_help) before_.save(*this);
    bool any_late_impact = fly_and_respond(part, done, cuts_help);
    double last = HUGE_VAL;
    while (cuts_help && contacts_.slip_end() < 1) {
      const double too_long = 1 - contacts_.slip_end();
      cuts_help = too_long < helps * last && ++cuts <= most_cuts;
      part = cuts_help ? contacts_.slip_end() * part : end - done;
      last = too_long;
      before_.restore(*this);
      any_late_impact = fly_and_respond(part, done, cuts_help);
    }
    fly_on(part, done, any_late_impact);
    done = part < end - done ? done + part : end;
  }
  counters.cuts += cuts;
}

/// Takes the first half of Moreau's midpoint step: free flight to the midpoint, impacts on the way, contacts
/// there, impulses. Returns whether a body was struck after the midpoint. `done`: the time of the step that
/// has passed before this substep (s); `may_be_undone`: before_ may be restored after it.
template <class Space, class Real>
bool SpaceStepper<Space, Real>::fly_and_respond(double h, double done, bool may_be_undone) {
  struck_.clear();
  const double midpoint = grid_.time(step_) + done + 0.5 * h;
  turn_gravity(midpoint);
  forces_.start_substep(bodies_);
  fly(midpoint, 0.5 * h);
  resolve_impacts(h, 0, h, midpoint);
  const bool any_late_impact = impacts_.any_late_impact();
  give_candidates(kept_pairs_.pairs());
  counters.pcs_made = kept_pairs_.times_made();
  if (may_be_undone) contacts_.keep_memory();
  const double scale = last_substep_ > 0 ? h / last_substep_ : 1.0;
  const FlightStage flight = impacts_.stage(terms(h, 0), parameters_, views());
  {
    const timing::Region region("narrowphase");
    libccd_.start_search();
    contacts_.find(std::as_const(contact_margin_).view(), scale, flight, any_late_impact,
                   libccd_.is_needed() ? &libccd_ : nullptr);
    counters.narrowphase.tested += contacts_.slots().candidates().size();
    counters.narrowphase += libccd_.take_stats();
  }
  const timing::Region region("response");
  ledger = ledger + contacts_.solve(flight, any_late_impact, h / grid_.length(step_ + 1), counters);
  return any_late_impact;
}

/// Takes the second half of the midpoint step: impacts on the way, since the response has changed it, free
/// flight to the end, and position correction.
template <class Space, class Real>
void SpaceStepper<Space, Real>::fly_on(double h, double done, bool any_late_impact) {
  const FlightStage flight = impacts_.stage(terms(h, 0), parameters_, views());
  contacts_.add_wall_impulses(flight);
  if (resolve_impacts(h, 0.5 * h, 0.5 * h, grid_.time(step_) + done + 0.5 * h))
    contacts_.take_velocities(flight);
  fly(grid_.time(step_) + done + h, 0.5 * h);
  ledger.work += forces_.work(bodies_);
  gravity_.count(h, parameters_);
  {
    const timing::Region region("correction");
    ledger = ledger + contacts_.correct(flight, any_late_impact);
  }
  last_substep_ = h;
}

template <class Space, class Real>
void SpaceStepper<Space, Real>::Restart::save(const SpaceStepper& now) {
  state.save(now.bodies_);
  gravity = now.parameters_.gravity;
  ledger = now.ledger;
  impacts = now.counters.impacts;
  unfinished_impacts = now.counters.unfinished_impacts;
  copy(on_walls, now.contacts_.wall_sums().totals());
  wall_impacts = now.wall_impacts_;
}

template <class Space, class Real>
void SpaceStepper<Space, Real>::Restart::restore(SpaceStepper& now) const {
  state.restore(now.bodies_);
  now.parameters_.gravity = gravity;
  now.ledger = ledger;
  now.counters.impacts = impacts;
  now.counters.unfinished_impacts = unfinished_impacts;
  now.contacts_.wall_sums().restore_totals(on_walls);
  now.wall_impacts_ = wall_impacts;
  now.contacts_.recall_memory();
}

template <class Space, class Real>
void SpaceStepper<Space, Real>::archive(Archive& archive) {
  archive("step", step_);
  archive("last_substep", last_substep_);
  archive("ledger", ledger);
  archive("counters", counters);
  archive.part("bodies", bodies_);
  if (archive.is_loading()) {
    struck_.clear();
    have_moved_ = false;
    archive.expect(are_numbers(to_vector(bodies_.id)), "bodies/id");
    find_places<Space>(bodies_);
    find_shapes();
    find_guides();
    wall_impacts_.find_walls(to_vector(bodies_.id), to_vector(bodies_.mobility));
  }
  archive("velocity_before", start_.velocity);
  archive.expect(start_.velocity.size() == bodies_.count(), "velocity_before");
  if (archive.is_loading()) {
    walls_are_listed_ = false;
    clear_wall_impulses();
  }
  archive("impulses_on_walls_known", impulses_on_walls_known_);
  wall_impacts_.archive(archive, by_number(contacts_.wall_sums().totals_by_place(bodies_.count())));
  archive.part("kept_pairs", kept_pairs_);
  archive.part("seen_pairs", seen_pairs_);
  archive("sees_kept", sees_kept_);
  archive("pairs_taken", pairs_taken_);
  if (archive.is_loading()) {
    pairs_known_ = 0;
    impacts_ = {};
  }
  archive.part("contacts", contacts_, view_of(std::as_const(bodies_)), parameters_);
  gravity_.archive(archive, parameters_);
  if (!archive.is_loading()) return;
  forces_.forget();
  forces_.act(step_, bodies_, parameters_);
}

/// Finds which of the pairs that were made anew are among the contacts' candidates (Slots::look_up).
template <class Space, class Real>
ConstView<std::int64_t> SpaceStepper<Space, Real>::known(ConstView<Pair> pairs) {
  if (pairs_known_ != kept_pairs_.times_made()) contacts_.slots().look_up(pairs, place_before(), known_);
  pairs_known_ = kept_pairs_.times_made();
  return std::as_const(known_).view();
}

/// Passes candidates that were made anew on to the contacts.
template <class Space, class Real>
void SpaceStepper<Space, Real>::give_candidates(ConstView<Pair> pairs) {
  if (pairs_taken_ == kept_pairs_.times_made()) return;
  const timing::Region region("slots");
  contacts_.take_candidates(pairs, known(pairs), view_of(std::as_const(bodies_)), parameters_);
  have_moved_ = false;
  pairs_taken_ = kept_pairs_.times_made();
}

/// Returns which parts of each pair bore load in the last substep. The contacts of this substep must stay
/// until its end, even if new candidates are made.
template <class Space, class Real>
ConstView<LoadedParts> SpaceStepper<Space, Real>::loads_of(ConstView<Pair> pairs) {
  if (pairs_taken_ == kept_pairs_.times_made()) return contacts_.loads();
  contacts_.loads_of(known(pairs), loads_);
  return std::as_const(loads_).view();
}

/// Resolves the impacts in the flight of a substep, from `from` (s) on, and returns whether there were any.
/// Sets the margins for contacts within `foresight` (s) from now on, which is at least the time to the
/// flight's end; they are not set if all bodies are too slow for impacts in the second half. `midpoint`:
/// time of the run at the midpoint of the substep (s).
template <class Space, class Real>
bool SpaceStepper<Space, Real>::resolve_impacts(double h, double from, double foresight, double midpoint) {
  constexpr int most_attempts = 8;
  if (from > 0) {
    const timing::Region region("impacts");
    if (!impacts_.any_may_meet(terms(h, from), parameters_, views())) return false;
  }
  const SearchTime time{.now = midpoint, .substep = h, .foresight = foresight};
  const auto cover = [&] {
    const timing::Region region("broadphase");
    return kept_pairs_.cover(bodies_, time, parameters_, contact_margin_);
  };
  bool covered = cover();
  for (int attempt = 1;; ++attempt) {
    if (!covered) kept_pairs_.make(bodies_, time, parameters_, contact_margin_);
    const ConstView<Pair> pairs = kept_pairs_.pairs();
    const timing::Region region("impacts");
    const Ledger moved = impacts_.resolve({.pairs = pairs,
                                           .loaded = loads_of(pairs),
                                           .terms = terms(h, from),
                                           .one_by_one = parameters_.accurate,
                                           .pairs_made = kept_pairs_.times_made()},
                                          parameters_, views());
    if (impacts_.impacts().size() == 0) return false;
    // A struck body may have left its box, and bodies that it can meet now may be missing from the pairs.
    covered = cover();
    if (covered || attempt == most_attempts) {
      ledger = ledger + moved;
      break;
    }
    kept_pairs_.add_travel(bodies_, time, parameters_, contact_margin_);
    impacts_.undo(views());
  }
  if (!covered) kept_pairs_.make(bodies_, time, parameters_, contact_margin_);
  counters.impacts += impacts_.impacts().size();
  if (impacts_.hit_bound()) ++counters.unfinished_impacts;
  const std::size_t before = struck_.size();
  struck_.resize(before + static_cast<std::size_t>(impacts_.impacts().size()));
  copy_bytes<Host, Space>(struck_.data() + before, impacts_.impacts().data(),
                          (struck_.size() - before) * sizeof(Impact));
  for (std::size_t k = before; sums_impulses_on_walls_ && k < struck_.size(); ++k)
    wall_impacts_.add(struck_[k], [&](BodyNumber wall) { return arm_on_wall(struck_[k], wall); });
  return true;
}

/// Returns the arm of an impact about the centre of a wall; zero if moments are not needed, as without
/// meshes.
template <class Space, class Real>
Vec3 SpaceStepper<Space, Real>::arm_on_wall(const Impact& impact, BodyNumber wall) const {
  if (!geometry_) return Vec3::Zero();
  return bodies_.period.nearest(impact.point - value_at(bodies_.position, place(wall)));
}

template <class Space, class Real>
SteppedBody SpaceStepper<Space, Real>::body(BodyNumber number) const {
  const std::int32_t k = place(number);
  SteppedBody body{.mobility = value_at(bodies_.mobility, k),
                   .inverse_mass = value_at(bodies_.inverse_mass, k),
                   .position = value_at(bodies_.position, k),
                   .orientation = value_at(bodies_.orientation, k),
                   .velocity = value_at(bodies_.velocity, k),
                   .spin = value_at(bodies_.spin, k),
                   .velocity_before = value_at(start_.velocity, k),
                   .acceleration = parameters_.gravity,
                   .contact_impulse = Vec3::Zero(),
                   .contact_moment = Vec3::Zero()};
  if (parameters_.acceleration.size() > 0) body.acceleration += value_at(parameters_.acceleration, k);
  // Gravity has no effect on a body with a servo, whose drive bears its weight.
  if (!servo_axis_.contains(number))
    body.acceleration += gravity_.excess_of_mean(grid_.length(step_ + 1), parameters_);
  if (!wall_impacts_.is_wall(number)) return body;
  if (!impulses_on_walls_known_) {
    body.contact_impulse = body.contact_moment = Vec3::Constant(NAN);
    return body;
  }
  const solver::WallImpulse on = contacts_.wall_sums().total_of(k) + wall_impacts_.of(number);
  body.contact_impulse = on.impulse;
  body.contact_moment = on.moment;
  return body;
}

/// Returns the contents of a region. The volume of a polyhedron is that of its hull, which its size does not
/// give.
template <class Space, class Real>
RegionContents SpaceStepper<Space, Real>::contents_of(const Region& region) const {
  RegionContents contents = scree::contents_of<Space>(region, bodies_);
  if (!geometry_) return contents;
  for (const BodyNumber number : bodies_in(region)) {
    const Hull* hull = geometry_->of_body[index_of(number)].hull;
    if (hull)
      contents.volume += hull->volume - volume_of(Shape::polyhedron, value_at(bodies_.size, place(number)));
  }
  return contents;
}

template <class Space, class Real>
ConstView<Pair> SpaceStepper<Space, Real>::pairs_now() {
  const SearchTime time{.now = grid_.time(step_), .substep = 0, .foresight = 0};
  sees_kept_ = kept_pairs_.cover(bodies_, time, parameters_, contact_margin_);
  if (!sees_kept_ && !seen_pairs_.cover(bodies_, time, parameters_, contact_margin_))
    seen_pairs_.make(bodies_, time, parameters_, contact_margin_);
  return pairs_seen().pairs();
}

template <class Space, class Real>
std::vector<BodyPair> SpaceStepper<Space, Real>::pairs() {
  const ConstView<Pair> found = pairs_now();
  std::vector<Pair> on_host(static_cast<std::size_t>(found.size()));
  copy_bytes<Host, Space>(on_host.data(), found.data(), on_host.size() * sizeof(Pair));
  const std::vector<Shape> shape = to_vector(bodies_.shape);
  const std::vector<BodyNumber> numbers = to_vector(bodies_.id);
  const auto number = [&numbers](std::size_t place) { return static_cast<std::int32_t>(numbers[place]); };
  std::vector<BodyPair> pairs;
  for (const Pair& pair : on_host) {
    const auto i = static_cast<std::size_t>(pair.i), j = static_cast<std::size_t>(pair.j);
    if (shape[i] != Shape::plane && shape[j] != Shape::plane) pairs.push_back({number(i), number(j)});
  }
  std::ranges::sort(pairs);
  return pairs;
}

template <class Space, class Real>
ContactProblem SpaceStepper<Space, Real>::contact_problem() const {
  solver::Inspection<Real> seen = contacts_.inspect(view_of(bodies_));
  BodyTable bodies;
  copy_bodies(bodies, bodies_);
  return problem_of(seen, bodies);
}

template <class Space, class Real>
std::vector<ContactForce> SpaceStepper<Space, Real>::contact_forces() const {
  solver::Inspection<Real> seen = contacts_.inspect(view_of(bodies_));
  BodyTable bodies;
  copy_bodies(bodies, bodies_);
  std::vector<ContactForce> forces = forces_of(seen, bodies);
  for (const Impact& impact : struck_)
    forces.push_back({impact.i, impact.j, impact.impulse / last_substep_, impact.point});
  return forces;
}

template <class Space, class Real>
void SpaceStepper<Space, Real>::measure_contacts(std::int64_t free_bodies, Observation& out) const {
  const solver::ContactTotals& totals = contacts_.totals();
  const auto mean = [](double sum, std::int64_t of) { return of > 0 ? sum / static_cast<double>(of) : 0.0; };
  out.contacts = totals.loaded;
  out.gap_mean = mean(totals.gaps, totals.loaded);
  out.coordination_mean = mean(static_cast<double>(totals.ends), free_bodies);
}

/// Returns whether a scene has features that are known on Host alone: general shapes, and contacts by libccd.
bool needs_host(const Scene& scene) {
  return scene.geometry != nullptr || LibccdContacts(scene.narrowphase).is_needed();
}

}  // namespace

std::unique_ptr<Stepper> make_space_stepper(const Scene& scene, const TimeGrid& grid, const PathTable& paths,
                                            const StepperOptions& options) {
  if (needs_host(scene)) {
    if (scene.precision == Precision::mixed)
      throw InputError(
          "meshes, capsules, cylinders, polyhedra and what asks libccd are stepped on the host, in double "
          "precision: leave out `precision: mixed`");
    return std::make_unique<SpaceStepper<Host, double>>(scene, grid, paths, options);
  }
  return in_chosen_space(options.on_device, [&](auto space) -> std::unique_ptr<Stepper> {
    using Space = decltype(space);
    if (scene.precision == Precision::mixed)
      return std::make_unique<SpaceStepper<Space, float>>(scene, grid, paths, options);
    return std::make_unique<SpaceStepper<Space, double>>(scene, grid, paths, options);
  });
}

}  // namespace scree
