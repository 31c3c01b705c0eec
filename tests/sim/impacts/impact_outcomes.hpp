// The outcomes of impacts: in rounds, in any space, and in the order of their times.
#pragma once

#include "sim/impacts/impact_rounds.hpp"
#include "tests/sim/impacts/event_queue.hpp"
#include "tests/sim/impacts/flight_scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace scree {

struct Outcome {
  BodyTable bodies;
  Ledger moved;
  std::vector<Impact> impacts;
  std::int64_t rounds = 0;
  bool late = false;
};

inline Outcome in_time_order(const FlightScene& scene, const std::vector<Pair>& pairs) {
  World<Host> world(scene);
  test::EventQueue queue;
  Outcome outcome;
  outcome.moved = queue.resolve({pairs.data(), static_cast<std::int64_t>(pairs.size())}, world.terms(0),
                                scene.parameters, view_of(world.bodies));
  outcome.impacts = queue.impacts();
  outcome.late = queue.any_late_impact(world.terms(0));
  copy_bodies(outcome.bodies, world.bodies);
  return outcome;
}

template <class Space>
std::vector<Impact> impacts_of(const ImpactRounds<Space>& rounds) {
  std::vector<Impact> impacts(static_cast<std::size_t>(rounds.impacts().size()));
  copy_bytes<Host, Space>(impacts.data(), rounds.impacts().data(), impacts.size() * sizeof(Impact));
  return impacts;
}

/// Resolves the impacts of a scene in rounds. The pairs are in another order than in the queue. `one_by_one`
/// means strictly in the order of times.
template <class Space>
Outcome in_rounds(const FlightScene& scene, std::vector<Pair> pairs, bool one_by_one = false) {
  World<Space> world(scene);
  std::reverse(pairs.begin(), pairs.end());
  Array<Pair, Space> candidates;
  copy(candidates, pairs);
  ImpactRounds<Space> rounds;
  Outcome outcome;
  outcome.moved = rounds.resolve({std::as_const(candidates).view(), {}, world.terms(0), one_by_one},
                                 scene.parameters, view_of(world.bodies));
  outcome.impacts = impacts_of(rounds);
  outcome.rounds = rounds.rounds();
  outcome.late = rounds.any_late_impact();
  copy_bodies(outcome.bodies, world.bodies);
  return outcome;
}

/// Returns the impacts of each body, in their order.
inline std::vector<std::vector<Impact>> by_body(const Outcome& outcome) {
  std::vector<std::vector<Impact>> of_body(static_cast<std::size_t>(outcome.bodies.count()));
  for (const Impact& impact : outcome.impacts) {
    for (const std::int32_t body : {impact.i, impact.j})
      if (outcome.bodies.mobility[static_cast<std::size_t>(body)] == Mobility::free)
        of_body[static_cast<std::size_t>(body)].push_back(impact);
  }
  return of_body;
}

inline void expect_same(const Outcome& rounds, const Outcome& order, double tolerance) {
  ASSERT_EQ(rounds.impacts.size(), order.impacts.size());
  const auto got = by_body(rounds);
  const auto expected = by_body(order);
  for (std::size_t k = 0; k < got.size(); ++k) {
    ASSERT_EQ(got[k].size(), expected[k].size()) << "body " << k;
    for (std::size_t n = 0; n < got[k].size(); ++n) {
      ASSERT_EQ(got[k][n].i, expected[k][n].i) << "impact " << n << " of body " << k;
      ASSERT_EQ(got[k][n].j, expected[k][n].j) << "impact " << n << " of body " << k;
      ASSERT_LE((got[k][n].impulse - expected[k][n].impulse).norm(), tolerance);
      ASSERT_LE((got[k][n].point - expected[k][n].point).norm(), tolerance);
    }
    ASSERT_LE((rounds.bodies.position[k] - order.bodies.position[k]).norm(), tolerance) << "body " << k;
    ASSERT_LE((rounds.bodies.velocity[k] - order.bodies.velocity[k]).norm(), tolerance) << "body " << k;
    ASSERT_LE((rounds.bodies.spin[k] - order.bodies.spin[k]).norm(), tolerance) << "body " << k;
    ASSERT_LE(rounds.bodies.orientation[k].angularDistance(order.bodies.orientation[k]), 1e-7) << k;
  }
  const double energy = 1 + order.moved.restitution + order.moved.friction;
  EXPECT_NEAR(rounds.moved.restitution, order.moved.restitution, tolerance * energy);
  EXPECT_NEAR(rounds.moved.friction, order.moved.friction, tolerance * energy);
  EXPECT_NEAR(rounds.moved.integration, order.moved.integration, tolerance * energy);
  EXPECT_EQ(rounds.late, order.late);
}

}  // namespace scree
