// Tests of steps that fail, with a stepper that fails on demand.
#include "sim/step/guarded_steps.hpp"

#include "sim/step/step_failure.hpp"
#include "tests/sim/step/simulations.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <limits>
#include <new>
#include <optional>
#include <string>
#include <vector>

namespace scree {
namespace {

constexpr double mass = 2;

/// A stepper with one ball that moves as `on_substep` says, and that counts the calls made to it.
class FakeStepper final : public Stepper {
 public:
  BodyTable bodies;
  std::function<void(double h, FakeStepper&)> on_substep = [](double, FakeStepper&) {};
  int starts = 0, undone = 0;
  bool heap = false;
  double deepest = 0;
  mutable int looks = 0;

  explicit FakeStepper(const Scene& scene) : bodies(scene.bodies) {}

  void start_step(std::int64_t) override {
    ++starts;
    start_ = bodies;
    start_ledger_ = ledger;
  }
  void substep(double h, double) override { on_substep(h, *this); }
  double overlap() const override { return deepest; }
  bool has_heap() const override { return heap; }
  OverlapsLeft overlaps_left() const override {
    ++looks;
    return {};
  }
  void undo_step() override {
    ++undone;
    bodies = start_;
    ledger = start_ledger_;
  }
  void copy_state(BodyTable& out) const override { out = bodies; }
  Vec3 gravity() const override { return Vec3::Zero(); }
  Energies energies(const Vec3& reference) const override {
    Bodies<Host> copied;
    copy_bodies(copied, bodies);
    return energies_of<Host>(copied, Vec3::Zero(), reference);
  }
  std::vector<BodyNumber> bodies_beyond(const World& world) const override {
    return bodies.position[0].x() > world.to.x() ? std::vector<BodyNumber>{BodyNumber{0}}
                                                 : std::vector<BodyNumber>{};
  }

  void change_bodies(const std::function<void(Bodies<Host>&)>&) override {}
  BodyTable take_out(const std::vector<BodyNumber>&) override { return {}; }
  void bring_in(const BodyTable&) override {}
  void archive(Archive&) override {}
  SteppedBody body(BodyNumber) const override { return {}; }
  Totals totals(const Vec3&) const override { return {}; }
  double largest_speed() const override { return 0; }
  std::vector<BodyNumber> bodies_in(const Region&) const override { return {}; }
  BodyTable bodies_near(const Vec3&, const Vec3&) const override { return {}; }
  RegionContents contents_of(const Region&) const override { return {}; }
  std::vector<BodyPair> pairs() override { return {}; }
  GridOccupancy grid_occupancy() override { return {}; }
  std::vector<BodyBox> boxes() const override { return {}; }
  void measure_overlaps(Observation&) override {}
  ContactProblem contact_problem() const override { return {}; }
  std::vector<ContactForce> contact_forces() const override { return {}; }
  void measure_contacts(std::int64_t, Observation&) const override {}
  const char* space_name() const override { return "fake"; }

 private:
  BodyTable start_;
  Ledger start_ledger_;
};

class GuardedStepsTest : public testing::Test {
 protected:
  static constexpr double length = 0.1;  // length of a step (s)

  const Scene scene_ = scene_of(
      "time: {end: 1, step: 0.1}\nmaterials: {stone: {}}\nworld: {from: [-1, -1, -1], to: [1, 1, 1]}\n"
      "bodies:\n  - {sphere: {radius: 0.1}, name: ball, mass: 2, velocity: [3, 0, 0], material: stone}\n");
  FakeStepper stepper_{scene_};
  GuardedSteps steps_{scene_, Vec3::Zero()};

  void SetUp() override { steps_.start(stepper_, 0); }
  void take() { steps_.take(0, 0, length, {}, stepper_); }

  void expect_given_up(const std::string& why) {
    const BodyTable before = stepper_.bodies;
    const double scale = steps_.baseline().scale();
    try {
      take();
      FAIL() << "it went on";
    } catch (const StepFailure& failure) {
      EXPECT_NE(std::string(failure.what()).find(why), std::string::npos) << failure.what();
      EXPECT_EQ(failure.bodies(), std::vector<std::int32_t>{0});
    }
    EXPECT_EQ(stepper_.starts, 2);
    EXPECT_EQ(stepper_.undone, 2);
    EXPECT_EQ(hash_of(stepper_.bodies), hash_of(before));
    EXPECT_EQ(steps_.baseline().scale(), scale);
    EXPECT_EQ(stepper_.counters.redone, 0) << "of a step that was not taken";
  }
};

TEST_F(GuardedStepsTest, AGoodStepIsTakenOnce) {
  take();
  EXPECT_EQ(stepper_.starts, 1);
  EXPECT_EQ(stepper_.counters.substeps, 1);
  EXPECT_EQ(stepper_.counters.redone, 0);
}

/// A heap corrects deep overlaps and leaves none: its overlaps are measured at every eighth step, but neither
/// in the accurate mode, which follows what is corrected, nor where the scene sets the number of substeps.
TEST_F(GuardedStepsTest, OverlapsOfAHeapAreMeasuredWhereTheyChooseSubsteps) {
  const auto substeps_of = [this](ResponseMode mode, std::optional<int> substeps, int& looks) {
    Scene scene = scene_;
    scene.response.mode = mode;
    scene.time.substeps = substeps;
    FakeStepper stepper(scene);
    stepper.heap = true;
    stepper.deepest = 2 * tolerance::substep_overlap;
    GuardedSteps steps(scene, Vec3::Zero());
    steps.start(stepper, 0);
    for (int k = 0; k < 16; ++k) steps.take(k, length * k, length, {}, stepper);
    looks = stepper.looks;
    return stepper.counters.substeps;
  };
  int looks = 0;
  EXPECT_EQ(substeps_of(ResponseMode::standard, std::nullopt, looks), 16);
  EXPECT_EQ(looks, 2);
  EXPECT_EQ(substeps_of(ResponseMode::accurate, std::nullopt, looks), 1 + 2 + 14 * 4);
  EXPECT_EQ(looks, 0);
  EXPECT_EQ(substeps_of(ResponseMode::standard, 3, looks), 16 * 3);
  EXPECT_EQ(looks, 0);
}

TEST_F(GuardedStepsTest, AStepThatFailsIsTakenAgainInSmallerSubsteps) {
  stepper_.on_substep = [](double h, FakeStepper& s) {
    s.bodies.position[0].y() += h > 0.05 ? std::numeric_limits<double>::quiet_NaN() : h;
  };
  take();
  EXPECT_EQ(stepper_.undone, 1);
  EXPECT_EQ(stepper_.counters.redone, 1);
  EXPECT_EQ(stepper_.counters.substeps, tolerance::redo_substeps);
  EXPECT_NEAR(stepper_.bodies.position[0].y(), length, 1e-15);
}

TEST_F(GuardedStepsTest, WhateverIsNotFiniteFailsAndIsNamed) {
  for (int field = 0; field < 4; ++field) {
    stepper_.starts = stepper_.undone = 0;
    stepper_.on_substep = [field](double, FakeStepper& s) {
      constexpr double bad = std::numeric_limits<double>::infinity();
      if (field == 0) s.bodies.position[0].z() = bad;
      if (field == 1) s.bodies.orientation[0].x() = -bad;
      if (field == 2) s.bodies.velocity[0].y() = bad - bad;
      if (field == 3) s.bodies.spin[0].x() = bad - bad;
    };
    expect_given_up(
        "ball (body 0): no longer finite: its position or velocity is no finite number any more; ");
  }
}

TEST_F(GuardedStepsTest, EnergyThatTheLedgerDoesNotExplainFails) {
  // Each substep adds 1e-5 of the kinetic energy, which is 9 J.
  stepper_.on_substep = [](double, FakeStepper& s) { s.bodies.velocity[0] *= 1 + 0.5e-5; };
  expect_given_up(
      "the energy changed by 4e-05 of its scale without a known cause; the bodies named have the "
      "most kinetic energy");
  stepper_.on_substep = [](double, FakeStepper& s) {
    const double before = s.bodies.velocity[0].squaredNorm();
    s.bodies.velocity[0] *= 2;
    s.ledger.work += 0.5 * mass * (s.bodies.velocity[0].squaredNorm() - before);
  };
  EXPECT_NO_THROW(take());
}

TEST_F(GuardedStepsTest, ABodyThatLeavesTheWorldStopsTheRun) {
  stepper_.on_substep = [](double h, FakeStepper& s) { s.bodies.position[0].x() += 20 * h; };
  expect_given_up("ball (body 0): outside of the world; enlarge world, or set world.leaving=remove");
}

TEST_F(GuardedStepsTest, WhateverTheStepperThrowsIsAFailedStep) {
  stepper_.on_substep = [](double, FakeStepper& s) {
    s.bodies.position[0].x() = 1e39;  // more than a float holds
    throw RunError("bounds are not finite");
  };
  expect_given_up("bounds are not finite");
}

TEST_F(GuardedStepsTest, OutOfMemoryPassesAndTheStateIsThatBeforeTheStep) {
  const std::uint64_t before = hash_of(stepper_.bodies);
  stepper_.on_substep = [](double, FakeStepper& s) {
    s.bodies.velocity[0] *= 2;
    throw std::bad_alloc();
  };
  EXPECT_THROW(take(), std::bad_alloc);
  EXPECT_EQ(stepper_.starts, 1);
  EXPECT_EQ(stepper_.undone, 1);
  EXPECT_EQ(hash_of(stepper_.bodies), before);
}

}  // namespace
}  // namespace scree
