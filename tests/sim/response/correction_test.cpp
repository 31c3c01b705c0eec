// Tests of the position correction of contacts (CorrectionPhases), in either space.
#include "core/parallel.hpp"
#include "sim/response/sweep_loop.hpp"
#include "tests/core/spaces.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace scree::solver {
namespace {

template <class Space>
class CorrectionTest : public test::InSpace<Space> {};
TYPED_TEST_SUITE(CorrectionTest, test::Spaces, test::SpaceName);

constexpr int never = 1000000;

/// A column of balls of equal mass on a fixed one. Each overlaps the one below it by `depth`.
struct Column {
  static constexpr int balls = 60;
  static constexpr double depth = 0.01, cap = 0.2;
  using Contacts = BallContacts<double>;

  ContactStore<Host, double> store;

  Column() {
    ColorRanges colors;  // contacts of even and of odd numbers
    colors.add(balls / 2);
    colors.add(balls / 2);
    store.take_balls(colors);
    const Contacts contacts = store.balls();
    for (std::int64_t place = 0; place < colors.places(); ++place) leave_empty(contacts, place);
    for (std::int32_t k = 0; k < balls; ++k) {
      const std::int64_t place = colors.begin[static_cast<std::size_t>(k % 2)] + k / 2;
      contacts.slot[place] = k;
      contacts.ends[place] = {k, k + 1};
      contacts.fields.at(Contacts::normal + 2, place) = 1;
      contacts.fields.at(Contacts::normal_mass, place) = k == 0 ? 1 : 0.5;
      contacts.gaps.at(Contacts::predicted_gap, place) = -depth;
      contacts.gaps.at(Contacts::cap, place) = cap;
    }
  }

  /// Returns by how much each ball has to rise until nothing overlaps (m).
  static double rise(int ball) { return ball * depth; }

 private:
  static void leave_empty(const Contacts& contacts, std::int64_t place) {
    contacts.slot[place] = Slot::empty;
    contacts.ends[place] = {0, 0};
    contacts.flags[place] = 0;
    for (int field = 0; field < Contacts::count; ++field) contacts.fields.at(field, place) = 0;
    for (int field = 0; field < Contacts::gap_count; ++field) contacts.gaps.at(field, place) = 0;
    contacts.fields.at(Contacts::normal_mass, place) = 1;
    contacts.gaps.at(Contacts::predicted_gap, place) = contacts.gaps.at(Contacts::cap, place) = 1;
  }
};

struct Corrected {
  int sweeps;
  std::vector<CentreRecord<double>> bodies;
};

/// Corrects the column until its deepest overlap is at most `deepest`. Sweeps from number
/// `first_with_momentum` on have momentum.
template <class Space>
Corrected correct(Column& column, double deepest, int first_with_momentum) {
  ContactStore<Space, double> store;
  store.copy_from(column.store);
  std::vector<CentreRecord<double>> bodies(Column::balls + 1);
  for (CentreRecord<double>& body : bodies) body.inverse_mass = 1;
  bodies[0].inverse_mass = 0;
  Array<CentreRecord<double>, Space> displacement, last;
  copy(displacement, bodies);
  copy(last, bodies);
  const CorrectionState done = parallel::run_in_phases<Space>(
      "test",
      CorrectionPhases<double, true>{.ball_colors = ColorPhases(store.ball_colors(), visit_width<Space>),
                                     .point_colors = ColorPhases({}, visit_width<Space>),
                                     .balls = store.balls(),
                                     .points = store.points(),
                                     .displacements = {displacement.data(), last.data()},
                                     .turns = {nullptr, nullptr},
                                     .body_count = displacement.size(),
                                     .shifted_hubs = {},
                                     .turned_hubs = {},
                                     .guides = {},
                                     .share = 0.8,
                                     .first_with_momentum = first_with_momentum,
                                     .least = 1,
                                     .usual = never,
                                     .most = 20000,
                                     .deepest = static_cast<float>(deepest / Column::cap),
                                     .mean = 1,
                                     .too_deep = 0},
      CorrectionState{});
  return {done.sweeps, to_vector(displacement)};
}

/// A push travels by one contact in a sweep, and long waves of overlap decay in a number of sweeps that grows
/// with the square of their length. With momentum the number grows with the length.
TYPED_TEST(CorrectionTest, MomentumCarriesAPushThroughAColumn) {
  Column column;
  const double deepest = 0.01 * Column::depth;
  const Corrected plain = correct<TypeParam>(column, deepest, never);
  const Corrected fast = correct<TypeParam>(column, deepest, 1);
  EXPECT_LT(20 * fast.sweeps, plain.sweeps);
  for (int k = 0; k <= Column::balls; ++k) {
    EXPECT_NEAR(fast.bodies[static_cast<std::size_t>(k)].velocity.z, Column::rise(k), 0.01 * Column::rise(k))
        << k;
  }
}

/// Returns after how many sweeps the correction of a heap ends, in which the deepest overlap falls by the
/// factor `falls` in a sweep, and the mean is `mean` of what is allowed.
int sweeps_of_heap(double falls, double mean) {
  const CorrectionPhases<float, true> phases{.ball_colors = ColorPhases({}, 1),
                                             .point_colors = ColorPhases({}, 1),
                                             .balls = {},
                                             .points = {},
                                             .displacements = {nullptr, nullptr},
                                             .turns = {nullptr, nullptr},
                                             .body_count = 0,
                                             .shifted_hubs = {},
                                             .turned_hubs = {},
                                             .guides = {},
                                             .share = 0.8f,
                                             .first_with_momentum = 2,
                                             .least = 2,
                                             .usual = 12,
                                             .most = 60,
                                             .deepest = 0.01f,
                                             .mean = 1e-4f,
                                             .too_deep = 0.06f};
  constexpr double contacts = 1e5;
  CorrectionState state;
  double deepest = 0.3;
  while (!state.corrected && state.sweeps < phases.most) {
    state = phases.judge(state, {static_cast<float>(deepest), mean * 1e-4 * contacts, contacts});
    deepest *= falls;
  }
  return state.sweeps;
}

TEST(CorrectionTest, OneWedgedContactDoesNotMakeAHeapTakeAllSweeps) {
  EXPECT_EQ(sweeps_of_heap(0.999, 0.5), 12);
  EXPECT_EQ(sweeps_of_heap(1, 0.5), 12);
  // What still falls goes on until it is no longer too deep, and so does a heap whose mean is too large.
  EXPECT_EQ(sweeps_of_heap(0.95, 0.5), 33);
  EXPECT_EQ(sweeps_of_heap(0.999, 2), 60);
}

}  // namespace
}  // namespace scree::solver
