// What impacts mean for contacts and bodies: found pair by pair and body by body in a space, as the host's
// stages find it contact by contact.
#include "sim/dynamics/contact_flight.hpp"

#include "core/parallel.hpp"
#include "core/tolerances.hpp"
#include "sim/dynamics/impact_rounds.hpp"
#include "sim/dynamics/impact_solver.hpp"
#include "tests/core/spaces.hpp"
#include "tests/sim/dynamics/flight_scenes.hpp"

#include <gtest/gtest.h>

#include <utility>

namespace scree {
namespace {

/// The contact of a pair, as one kernel finds it.
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
    const Vec3 moment = moment_of_lead(stage.bodies, body, total[k], 1, led[k]);
    moved[k] = shift_late(stage, body, total[k]);
    moved[k].angular_correction += moment;
  }
};

template <class Space>
class ContactFlights : public test::InSpace<Space> {};
TYPED_TEST_SUITE(ContactFlights, test::Spaces, test::SpaceName);

/// Balls and boxes over a plane, some of which fall on it in the substep and some of which meet.
FlightScene falling_crowd() {
  FlightScene scene;
  scene.law = {.restitution = 0.5, .friction = 0.3};
  scene.step = 1.0 / 60;
  scene.parameters.gravity = Vec3(0, 0, -9.81);
  scene.parameters.restitution_threshold = {.any = 0, .lossy = 2 * 9.81 * scene.step};
  scene.add_plane(Vec3::UnitZ(), 0);
  for (int k = 0; k < 300; ++k) {
    Random random(21, static_cast<std::uint64_t>(k));
    const Vec3 place(0.11 * (k % 10), 0.11 * (k / 10 % 10), 0.06 + 0.12 * (k / 100));
    scene.add(k % 3 == 0 ? Shape::box : Shape::sphere, Vec3::Constant(k % 3 == 0 ? 0.04 : 0.05),
              place + vector_in(random, 0.01), vector_in(random, 1.5));
    scene.bodies.spin.back() = vector_in(random, 5);
  }
  return scene;
}

TYPED_TEST(ContactFlights, AsTheHostsStages) {
  const FlightScene scene = falling_crowd();
  const std::vector<Pair> pairs = scene.pairs(0.1);
  const ConstView<Pair> candidates{pairs.data(), static_cast<std::int64_t>(pairs.size())};
  const std::vector<double> margins(scene.bodies.position.size(), 0.02);

  // The host's stages.
  World<Host> host(scene);
  const ImpulseMemory memory;
  const ImpactProblem problem{.pairs = candidates, .memory = memory, .terms = host.terms(0)};
  ImpactSolver solver;
  const BodyView bodies = view_of(host.bodies);
  solver.resolve(problem, scene.parameters, bodies);
  NarrowPhase narrow_phase(NarrowPhaseSettings{});
  const Manifolds manifolds = narrow_phase.find(view_of(std::as_const(host.bodies)), candidates,
                                                {margins.data(), static_cast<std::int64_t>(margins.size())},
                                                solver.late_bodies(problem, scene.parameters, bodies));
  ContactSet set;
  prepare_contacts(manifolds, problem.terms.laws, memory, 1, scene.parameters, set);
  BallPairs balls;
  solver.mark_flights(problem, scene.parameters, manifolds, bodies, set, balls);

  // All at once, pair by pair.
  World<TypeParam> world(scene);
  Array<Pair, TypeParam> list;
  Array<double, TypeParam> margin;
  copy(list, pairs);
  copy(margin, margins);
  ImpactRounds<TypeParam> rounds;
  rounds.resolve({std::as_const(list).view(), {}, world.terms(0)}, scene.parameters, view_of(world.bodies));
  ASSERT_TRUE(rounds.any_is_late());
  const FlightStage stage = rounds.stage(world.terms(0), scene.parameters, view_of(world.bodies));
  Array<Seen, TypeParam> seen(list.size());
  parallel::for_each<TypeParam>("test.see", list.size(),
                                SeePair{{stage}, list.view(), margin.view(), seen.view()});

  const std::vector<Seen> all = to_vector(seen);
  std::int64_t c = 0;
  int flying = 0;
  int late = 0;
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (all[k].points == 0) continue;
    ASSERT_LT(c, set.contacts.size());
    const Contact& contact = set.contacts.view()[c++];
    ASSERT_EQ(contact.i, pairs[k].i);
    ASSERT_EQ(contact.j, pairs[k].j);
    EXPECT_EQ(all[k].points, contact.count);
    EXPECT_NEAR(all[k].flight.lead, contact.lead, 1e-12 * scene.step);
    EXPECT_EQ(all[k].flight.flying, contact.flying) << contact.i << " " << contact.j;
    flying += contact.flying ? 1 : 0;
    late += contact.lead > 0 ? 1 : 0;
  }
  EXPECT_EQ(c, set.contacts.size());
  EXPECT_GT(flying, 20);
  EXPECT_GT(late, 20);
  EXPECT_GT(c - flying, 20);

  // What the response might give: the shift of the bodies, contact by contact and body by body.
  std::vector<Vec3> total(scene.bodies.position.size(), Vec3::Zero());
  std::vector<Vec3> led = total;
  for (std::int64_t k = 0; k < set.contacts.size(); ++k) {
    const Contact& contact = set.contacts.view()[k];
    Random random(22, static_cast<std::uint64_t>(k));
    for (int p = 0; p < contact.count; ++p) {
      const Vec3 impulse = vector_in(random, 0.3);
      set.rows.view()[contact.first_row + p].impulse = impulse;
      for (const auto& [body, sign] : {std::pair(contact.i, -1.0), std::pair(contact.j, 1.0)}) {
        total[static_cast<std::size_t>(body)] += sign * impulse;
        led[static_cast<std::size_t>(body)] += sign * contact.lead * impulse;
      }
    }
  }
  const Ledger expected = solver.shift_late(problem, scene.parameters, bodies, set);
  Array<Vec3, TypeParam> totals, leds;
  copy(totals, total);
  copy(leds, led);
  Array<Ledger, TypeParam> moved(totals.size());
  parallel::for_each<TypeParam>("test.shift", totals.size(),
                                ShiftBody{stage, totals.view(), leds.view(), moved.view()});
  Ledger got;
  for (const Ledger& each : to_vector(moved)) got = got + each;
  EXPECT_NEAR(got.correction, expected.correction, 1e-12);
  EXPECT_LE((got.angular_correction - expected.angular_correction).norm(), 1e-12);
  EXPECT_GT(expected.angular_correction.norm(), 1e-4);
  BodyTable here, there;
  copy_bodies(here, world.bodies);
  copy_bodies(there, host.bodies);
  for (std::size_t k = 0; k < here.position.size(); ++k)
    ASSERT_LE((here.position[k] - there.position[k]).norm(), 1e-12) << k;
}

}  // namespace
}  // namespace scree
