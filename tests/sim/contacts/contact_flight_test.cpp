// Tests of what impacts mean for contacts and bodies, in any space: after rounds of impacts it is the same as
// after impacts in the order of their times.
#include "sim/contacts/contact_flight.hpp"

#include "core/parallel.hpp"
#include "core/tolerances.hpp"
#include "sim/impacts/impact_rounds.hpp"
#include "tests/core/spaces.hpp"
#include "tests/sim/impacts/event_queue.hpp"
#include "tests/sim/impacts/flight_scenes.hpp"

#include <gtest/gtest.h>

#include <utility>

namespace scree {
namespace {

/// The contact of a pair as one kernel finds it.
struct Seen {
  int points;
  ContactFlight flight;
};

struct SeePair {
  StruckFlights struck;
  ConstView<Pair> pairs;
  ConstView<double> margin;
  View<Seen> seen;

  SCREE_HD void operator()(std::int64_t k) const {
    const auto [i, j] = pairs[k];
    const BodyView& bodies = struck.stage.bodies;
    const double time = struck.time_of(i, j);
    const bool late = time > 0.5 * struck.stage.terms.step;
    Manifold manifolds[max_pair_manifolds];
    seen[k] = {0, {0, false}};
    if (find_pair_contacts(bodies.shape[i], solid(i, late, time), bodies.shape[j], solid(j, late, time),
                           margin[i] + margin[j], manifolds) == 0)
      return;
    Manifold& m = manifolds[0];
    m.i = i;
    m.j = j;
    seen[k] = {m.count,
               flight_of_contact(struck, m, m.points, struck.stage.terms.laws.smaller_size(i, j), false)};
  }

  SCREE_HD Solid solid(std::int32_t body, bool late, double time) const {
    const BodyView& bodies = struck.stage.bodies;
    return late ? struck.at(body, time).solid
                : Solid{bodies.position[body], bodies.orientation[body], bodies.size[body]};
  }
};

struct ShiftBody {
  FlightStage stage;
  ConstView<Vec3> total, led;
  View<Ledger> moved;
  SCREE_HD void operator()(std::int64_t k) const {
    const auto body = static_cast<std::int32_t>(k);
    if (!stage.is_free(body)) {
      moved[k] = {};
      return;
    }
    const Vec3 moment = moment_of_delay(stage.bodies, body, total[k], 1, led[k]);
    moved[k] = shift_after_late_impact(stage, body, total[k], stage.bodies.spin[k]);
    moved[k].angular_correction += moment;
  }
};

/// Gives a body the velocities that a response might give it, and finds how far that moves and turns it at
/// the time of its last impact (m, rad).
struct RespondAndShift {
  StruckFlights struck;
  ConstView<Vec3> kick, turn;
  View<Vec3> moved, turned;
  View<Ledger> ledger;
  SCREE_HD void operator()(std::int64_t k) const {
    const auto body = static_cast<std::int32_t>(k);
    const FlightStage& stage = struck.stage;
    moved[k] = turned[k] = Vec3::Zero();
    ledger[k] = {};
    if (!stage.is_free(body) || !stage.has_late_impact(body)) return;
    const BodyView& bodies = stage.bodies;
    const Solid before = struck.at(body, stage.clock[k]).solid;
    const double energy = rotational_energy_of(k);
    const Vec3 spin = bodies.spin[k];
    bodies.velocity[k] += kick[k];
    bodies.spin[k] += turn[k];
    const double responded = rotational_energy_of(k) - energy;
    ledger[k] = shift_after_late_impact(stage, body, kick[k] / bodies.inverse_mass[k], spin);
    ledger[k].correction += rotational_energy_of(k) - energy - responded;
    const Solid after = struck.at(body, stage.clock[k]).solid;
    moved[k] = after.position - before.position;
    turned[k] = 2 * (after.orientation * before.orientation.conjugate()).vec();
  }
  SCREE_HD double rotational_energy_of(std::int64_t k) const {
    const BodyView& bodies = struck.stage.bodies;
    return rotational_energy(bodies.orientation[k], bodies.spin[k], bodies.inverse_inertia[k]);
  }
};

template <class Space>
class ContactFlights : public test::InSpace<Space> {};
TYPED_TEST_SUITE(ContactFlights, test::Spaces, test::SpaceName);

/// Returns balls and boxes over a plane: in the substep some fall on it and some meet one another. `box`:
/// half edges of the boxes (m).
FlightScene falling_crowd(const Vec3& box = Vec3::Constant(0.04)) {
  FlightScene scene;
  scene.law = {.restitution = 0.5, .friction = 0.3};
  scene.step = 1.0 / 60;
  scene.parameters.gravity = Vec3(0, 0, -9.81);
  scene.parameters.restitution_threshold = {.any = 0, .lossy = 2 * 9.81 * scene.step};
  scene.add_plane(Vec3::UnitZ(), 0);
  for (int k = 0; k < 300; ++k) {
    Random random(21, static_cast<std::uint64_t>(k));
    const Vec3 place(0.11 * (k % 10), 0.11 * (k / 10 % 10), 0.06 + 0.12 * (k / 100));
    scene.add(k % 3 == 0 ? Shape::box : Shape::sphere, k % 3 == 0 ? box : Vec3::Constant(0.05),
              place + vector_in(random, 0.01), vector_in(random, 1.5));
    scene.bodies.spin.back() = vector_in(random, 5);
  }
  return scene;
}

/// The state after the impacts of a flight: what a contact of each pair knows of its flight, and how impulses
/// that it might have shift the bodies.
template <class Space>
struct AfterImpacts {
  std::vector<Seen> seen;
  Ledger shifted;
  BodyTable bodies;

  AfterImpacts(const FlightStage& stage, const FlightScene& scene, const std::vector<Pair>& pairs,
               const Bodies<Space>& all) {
    Array<Pair, Space> list;
    Array<double, Space> margin;
    copy(list, pairs);
    copy(margin, std::vector<double>(scene.bodies.position.size(), 0.02));
    Array<Seen, Space> found(list.size());
    parallel::for_each<Space>("test.see", list.size(),
                              SeePair{{stage}, list.view(), margin.view(), found.view()});
    seen = to_vector(found);
    std::vector<Vec3> total(scene.bodies.position.size(), Vec3::Zero());
    std::vector<Vec3> led = total;
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      Random random(22, k);
      for (int p = 0; p < seen[k].points; ++p) {
        const Vec3 impulse = vector_in(random, 0.3);
        for (const auto& [body, sign] : {std::pair(pairs[k].i, -1.0), std::pair(pairs[k].j, 1.0)}) {
          total[static_cast<std::size_t>(body)] += sign * impulse;
          led[static_cast<std::size_t>(body)] += sign * seen[k].flight.delay * impulse;
        }
      }
    }
    Array<Vec3, Space> totals, leds;
    copy(totals, total);
    copy(leds, led);
    Array<Ledger, Space> moved(totals.size());
    parallel::for_each<Space>("test.shift", totals.size(),
                              ShiftBody{stage, totals.view(), leds.view(), moved.view()});
    for (const Ledger& each : to_vector(moved)) shifted = shifted + each;
    copy_bodies(bodies, all);
  }
};

TYPED_TEST(ContactFlights, AsAfterTheImpactsInTheOrderOfTheirTimes) {
  const FlightScene scene = falling_crowd();
  const std::vector<Pair> pairs = scene.pairs(0.1);

  World<Host> host(scene);
  test::EventQueue queue;
  queue.resolve({pairs.data(), static_cast<std::int64_t>(pairs.size())}, host.terms(0), scene.parameters,
                view_of(host.bodies));
  const AfterImpacts<Host> expected(queue.stage(host.terms(0), scene.parameters, view_of(host.bodies)), scene,
                                    pairs, host.bodies);

  World<TypeParam> world(scene);
  Array<Pair, TypeParam> list;
  copy(list, pairs);
  ImpactRounds<TypeParam> rounds;
  rounds.resolve({std::as_const(list).view(), {}, world.terms(0)}, scene.parameters, view_of(world.bodies));
  ASSERT_TRUE(rounds.any_late_impact());
  const AfterImpacts<TypeParam> got(rounds.stage(world.terms(0), scene.parameters, view_of(world.bodies)),
                                    scene, pairs, world.bodies);

  int contacts = 0, flying = 0, late = 0;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    ASSERT_EQ(got.seen[k].points, expected.seen[k].points) << k;
    if (got.seen[k].points == 0) continue;
    EXPECT_NEAR(got.seen[k].flight.delay, expected.seen[k].flight.delay, 1e-12 * scene.step);
    EXPECT_EQ(got.seen[k].flight.flying, expected.seen[k].flight.flying) << pairs[k].i << " " << pairs[k].j;
    ++contacts;
    flying += got.seen[k].flight.flying ? 1 : 0;
    late += got.seen[k].flight.delay > 0 ? 1 : 0;
  }
  EXPECT_GT(flying, 20);
  EXPECT_GT(late, 20);
  EXPECT_GT(contacts - flying, 20);
  EXPECT_NEAR(got.shifted.correction, expected.shifted.correction, 1e-12);
  EXPECT_LE((got.shifted.angular_correction - expected.shifted.angular_correction).norm(), 1e-12);
  EXPECT_GT(expected.shifted.angular_correction.norm(), 1e-4);
  for (std::size_t k = 0; k < got.bodies.position.size(); ++k)
    ASSERT_LE((got.bodies.position[k] - expected.bodies.position[k]).norm(), 1e-12) << k;
}

/// Until its late impact a body has flown without the response, so the response must change neither its place
/// nor its orientation there. A box of unequal edges precesses meanwhile, which the turn takes into account
/// to second order.
TYPED_TEST(ContactFlights, TheResponseLeavesABodyThatWasStruckLateWhereItsImpactWas) {
  FlightScene scene = falling_crowd({0.04, 0.03, 0.02});
  scene.parameters.gravity = Vec3::Zero();
  const std::vector<Pair> pairs = scene.pairs(0.1);
  World<TypeParam> world(scene);
  Array<Pair, TypeParam> list;
  copy(list, pairs);
  ImpactRounds<TypeParam> rounds;
  rounds.resolve({std::as_const(list).view(), {}, world.terms(0)}, scene.parameters, view_of(world.bodies));

  const auto count = static_cast<std::int64_t>(scene.bodies.position.size());
  std::vector<Vec3> kicks, turns;
  for (std::int64_t k = 0; k < count; ++k) {
    Random random(23, static_cast<std::uint64_t>(k));
    kicks.push_back(vector_in(random, 1));
    turns.push_back(vector_in(random, 20));
  }
  Array<Vec3, TypeParam> kick, turn, moved(count), turned(count);
  copy(kick, kicks);
  copy(turn, turns);
  Array<Ledger, TypeParam> ledgers(count);
  parallel::for_each<TypeParam>(
      "test.respond", count,
      RespondAndShift{{rounds.stage(world.terms(0), scene.parameters, view_of(world.bodies))},
                      std::as_const(kick).view(),
                      std::as_const(turn).view(),
                      moved.view(),
                      turned.view(),
                      ledgers.view()});
  const std::vector<Vec3> by = to_vector(moved), angle = to_vector(turned);
  const std::vector<Ledger> ledger = to_vector(ledgers);
  int late = 0;
  for (std::size_t k = 0; k < by.size(); ++k) {
    EXPECT_LE(by[k].norm(), 1e-12) << k;
    const bool precesses = scene.bodies.shape[k] == Shape::box;
    EXPECT_LE(angle[k].norm(), precesses ? 0.02 : 1e-12) << k;
    EXPECT_NEAR(ledger[k].correction, 0, 1e-12) << k;
    late += ledger[k].angular_correction.isZero(0) ? 0 : 1;
  }
  EXPECT_GT(late, 20);
}

}  // namespace
}  // namespace scree
