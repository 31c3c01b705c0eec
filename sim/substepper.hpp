// What happens within a step: Moreau's midpoint scheme, one substep after another.
#pragma once

#include "core/array.hpp"
#include "core/bodies.hpp"
#include "narrowphase/narrow_phase.hpp"
#include "sim/applied_forces.hpp"
#include "sim/dynamics/coming_and_going.hpp"
#include "sim/dynamics/contact_set.hpp"
#include "sim/dynamics/correction.hpp"
#include "sim/dynamics/impact_solver.hpp"
#include "sim/dynamics/motion.hpp"
#include "sim/dynamics/prescribed.hpp"
#include "sim/dynamics/response.hpp"
#include "sim/inspection.hpp"
#include "sim/moving_state.hpp"
#include "sim/observation.hpp"
#include "sim/pair_finder.hpp"
#include "sim/scene/scene.hpp"
#include "sim/scene/time_grid.hpp"
#include "sim/stepper.hpp"
#include "sim/turning_gravity.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace scree {

/// Bodies and contacts are on Host; the PCS is made in the space of choice.
class Substepper final : public Stepper {
 public:
  /// The bodies as the scene starts. `origin`: the local origin of the broad phase (m).
  Substepper(const Scene& scene, const TimeGrid& grid, const PathTable& paths, bool on_device,
             const Vec3& origin);

  void start_step(std::int64_t step) override;
  /// In the accurate mode in parts that end where contacts come to stick.
  void substep(double h, double done) override;
  double overlap() const override { return corrector_.overlap(); }
  void undo_step() override;
  void change_bodies(const std::function<void(Bodies<Host>&)>& change) override;
  BodyTable take_out(const std::vector<BodyNumber>& numbers) override;
  void bring_in(const BodyTable& bodies) override;

  void archive(Archive& archive) override;

  void copy_state(BodyTable& out) const override { copy_bodies(out, bodies_); }
  SteppedBody body(BodyNumber number) const override;
  Vec3 gravity() const override { return parameters_.gravity; }
  Energies energies(const Vec3& reference) const override;
  Totals totals(const Vec3& reference) const override;
  double largest_speed() const override { return scree::largest_speed<Host>(bodies_); }
  RegionContents contents_of(const Region& region) const override;
  std::vector<BodyNumber> bodies_beyond(const World& world) const override {
    return scree::bodies_beyond<Host>(world, bodies_);
  }
  std::vector<BodyNumber> bodies_in(const Region& region) const override {
    return scree::bodies_in<Host>(region, bodies_);
  }
  BodyTable bodies_near(const Vec3& low, const Vec3& high) const override {
    return scree::bodies_near<Host>(low, high, bodies_);
  }

  std::vector<BodyPair> pairs() override;
  GridOccupancy grid_occupancy() override;
  std::vector<BodyBox> boxes() const override { return kept_pairs_.boxes(); }
  void measure_overlaps(Observation& out) override;

  ContactProblem contact_problem() const override;
  std::vector<ContactForce> contact_forces() const override;
  void measure_contacts(std::int64_t free_bodies, Observation& out) const override;

  const char* space_name() const override { return kept_pairs_.space_name(); }

 private:
  /// What the first half of a substep changes.
  struct Restart {
    MovingState<Host> state;
    Vec3 gravity;
    Ledger ledger;
    std::int64_t impacts = 0, unfinished_impacts = 0;
    std::vector<Vec3> contact_impulse, contact_moment;

    void save(const Substepper& now);
    void restore(Substepper& now) const;
  };

  ConstView<ShapeData> shapes() const;
  void forget_pairs();
  ContactLaws contact_laws() const;
  ImpactProblem impact_problem(ConstView<Pair> pairs, double h, double from) const;
  double reach_from(double h, double done) const;
  Manifolds fly_and_respond(double h, double done);
  void fly_on(const Manifolds& manifolds, double h, double done);
  void turn_gravity(double midpoint);
  void fly(double time, double dt);
  void resolve_impacts(double h, double from, double reach);
  Manifolds find_contacts(double h, double reach);
  void respond(const Manifolds& manifolds, double h);
  ConstView<Pair> pairs_now();
  const ContactSet& listed_contacts() const;
  void add_impulse_on_driven_bodies(std::int32_t i, std::int32_t j, const Vec3& impulse);
  void add_moment_on_triangle(std::int32_t id, const Vec3& moment);

  TimeGrid grid_;
  std::shared_ptr<const Geometry> geometry_;
  std::int64_t step_ = 0;
  Bodies<Host> bodies_;
  PrescribedPaths<Host> paths_;
  ResponseParameters parameters_;
  Array<PairLaw, Host> laws_;
  std::int64_t materials_;
  AppliedForces<Host> forces_;
  TurningGravity gravity_;
  Array<Guide, Host> guides_;
  KeptPairs<Host> kept_pairs_;
  NarrowPhase narrow_phase_;
  NarrowPhase end_narrow_phase_;  // for the penetration at the end of a step
  ImpactSolver impacts_;
  ResponseSolver response_;
  PositionCorrector corrector_;

  double last_substep_ = 0;  // its length; scales the remembered impulses
  MovingState<Host> start_;  // of the step
  Ledger start_ledger_;
  Vec3 start_gravity_ = Vec3::Zero();
  Restart before_;  // of the last substep, in the accurate mode
  std::vector<Vec3> contact_impulse_;
  std::vector<Vec3> contact_moment_;  // empty where there are no meshes
  Array<double, Host> contact_margin_;
  Array<SolverBody, Host> solver_;
  std::vector<Impact> struck_;   // in the last substep
  bool any_late_ = false;        // of these after the midpoint
  mutable ContactSet contacts_;  // listed one by one when somebody asks
  ImpulseMemory memory_;
};

}  // namespace scree
