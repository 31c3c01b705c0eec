// Tests of visits to eight contacts side by side, against the same visits to one after the other: they agree
// bit by bit, for each instruction set that the processor has.
#include "sim/contacts/visit_kernels.hpp"

#include "core/rng.hpp"
#include "sim/contacts/contact_store.hpp"
#include "sim/laws/simd/simd.hpp"
#include "sim/response/padding.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <vector>

namespace scree::solver {
namespace {

constexpr double float_sums = 1e-6;  // for sums of some numbers as floats, in any order
/// One colour of ball contacts and one of point contacts. Each contact is between two bodies of its own, of
/// which some are not free. Their number is such that some lanes are empty, and that contacts side by side
/// differ in their number of points.
template <class Real>
class Problem {
 public:
  using Balls = BallContacts<Real>;
  using Points = PointContacts<Real>;
  using Rolling = RollingFields<Real>;
  static constexpr int balls_found = 29, points_found = 43;
  static constexpr std::int32_t padding_body = 2 * (balls_found + points_found);

  explicit Problem(bool rough, bool rolls) {
    ColorRanges of_balls, of_points;
    of_balls.add(balls_found);
    of_points.add(points_found);
    store_.take_balls(of_balls);
    store_.take_points(of_points);
    ball_rolling_.resize(decltype(Rolling::fields)::size(of_balls.places()));
    point_rolling_.resize(decltype(Rolling::fields)::size(of_points.places()));
    // Memory that no contact has written must not matter.
    for (const auto& [data, size] : memory()) std::memset(data, 0xff, size);
    const auto number_slots = [](View<std::int32_t> slots, std::int32_t found) {
      for (std::int32_t c = 0; c < slots.size(); ++c) slots[c] = c < found ? c : Slot::empty;
    };
    number_slots(store_.balls().slot, balls_found);
    number_slots(store_.points().slot, points_found);
    Random random(7, 0);
    const auto number = [&](double low, double high) { return static_cast<Real>(random.uniform(low, high)); };
    const auto vector = [&](double size) {
      return V3<Real>{number(-size, size), number(-size, size), number(-size, size)};
    };
    const auto unit = [&] {
      const V3<Real> a = vector(1);
      return a / std::sqrt(dot(a, a));
    };
    for (std::int32_t k = 0; k < padding_body; ++k) {
      const bool free = k % 5 != 0;
      BodyRecord<Real> body;
      body.velocity = vector(2);
      body.inverse_mass = free ? number(0.2, 3) : 0;
      body.spin = vector(3);
      body.inverse_inertia = free ? number(1, 20) : 0;
      bodies.push_back(body);
    }
    bodies.push_back({});
    const auto put_rolling = [&](const Rolling& rolling, std::int64_t c, const V3<Real>& n) {
      const V3<Real> couple = vector(0.1);
      rolling.fields.at(Rolling::reach, c) = rolls && c % 3 != 0 ? number(0, 0.5) : 0;
      rolling.fields.set(Rolling::couple, c, rolls && c % 3 != 0 ? couple - dot(couple, n) * n : V3<Real>{});
      rolling.fields.set(Rolling::last, c, V3<Real>{});
    };
    const auto friction = [&](std::int64_t c) { return rough && c % 7 != 0 ? number(0, 1.2) : Real{}; };
    const Balls b = balls();
    for (std::int64_t c = 0; c < balls_found; ++c) {
      b.ends[c] = {static_cast<std::int32_t>(2 * c), static_cast<std::int32_t>(2 * c + 1)};
      const V3<Real> n = unit();
      b.fields.set(Balls::normal, c, n);
      b.fields.at(Balls::arm_i, c) = number(0.1, 1);
      b.fields.at(Balls::arm_j, c) = -number(0.1, 1);
      b.fields.at(Balls::friction, c) = friction(c);
      b.fields.at(Balls::target, c) = number(-0.5, 0.5);
      b.fields.at(Balls::normal_mass, c) = number(0.2, 2);
      b.fields.at(Balls::tangent_mass, c) = number(0.1, 1);
      b.fields.set(Balls::impulse, c, number(0, 1) * n);
      b.fields.set(Balls::last, c, number(0, 1) * n);
      put_gap([&](int field) -> Real& { return b.gaps.at(field, c); }, number(-0.1, 0.02), number(0, 0.1));
      b.gaps.at(Balls::cap, c) = static_cast<Real>(0.03);
      put_rolling(ball_rolling(), c, n);
    }
    const Points p = points();
    for (std::int64_t c = 0; c < points_found; ++c) {
      const auto first = static_cast<std::int32_t>(2 * (balls_found + c));
      p.ends[c] = {first, first + 1};
      p.points[c] = static_cast<std::int32_t>(1 + (c * c) % Manifold::max_points);
      const V3<Real> n = unit();
      p.fields.set(Points::normal, c, n);
      p.fields.at(Points::friction, c) = friction(c);
      p.fields.at(Points::cap, c) = static_cast<Real>(0.03);
      for (const int first_of : {int{Points::inertia_i}, int{Points::inertia_j}}) {
        const bool free =
            bodies[static_cast<std::size_t>(first + (first_of == Points::inertia_j ? 1 : 0))].inverse_mass >
            0;
        for (int e = 0; e < 6; ++e)
          p.fields.at(first_of + e, c) = !free ? Real{} : e < 3 ? number(1, 3) : number(-0.2, 0.2);
      }
      for (int k = 0; k < p.points[c]; ++k) {
        const auto at = [&](int field) -> Real& {
          return p.point_fields.at(Points::at_point(k, Points::arm_i) + field, c);
        };
        for (int field = 0; field < Points::point_count; ++field) at(field) = number(-0.5, 0.5);
        at(Points::normal_mass) = number(0.2, 2);
        at(Points::tangent_mass) = number(0.1, 1);
        for (int e = 0; e < 3; ++e) at(Points::stick + e) = number(1, 2);
        p.point_fields.set(Points::at_point(k, Points::impulse), c, number(0, 1) * n);
        put_gap([&](int field) -> Real& { return p.gaps.at(Points::at_point(k, Points::gap) + field, c); },
                number(-0.1, 0.02), number(0, 0.1));
      }
      put_rolling(point_rolling(), c, n);
    }
    for (std::int64_t block = 0; block < b.slot.size() / simd::width; ++block)
      PadBalls<Real>{b, ball_rolling(), true, padding_body}(block);
    for (std::int64_t block = 0; block < p.slot.size() / simd::width; ++block)
      PadPoints<Real>{p, point_rolling(), true, padding_body}(block);
    for (std::int32_t k = 0; k <= padding_body; ++k) {
      CentreRecord<Real> centre, turn;
      centre.velocity = turn.velocity = {};
      centre.inverse_mass = bodies[static_cast<std::size_t>(k)].inverse_mass;
      turn.inverse_mass = bodies[static_cast<std::size_t>(k)].inverse_inertia;
      centres.push_back(centre);
      turns.push_back(turn);
    }
    last = bodies;
  }

  Balls balls() { return store_.balls(); }
  Points points() { return store_.points(); }
  Rolling ball_rolling() { return {decltype(Rolling::fields)(ball_rolling_.data())}; }
  Rolling point_rolling() { return {decltype(Rolling::fields)(point_rolling_.data())}; }

  /// Returns all numbers of the contacts that were found, followed by those of the bodies.
  std::vector<Real> numbers() {
    std::vector<Real> all;
    const Balls b = balls();
    for (std::int64_t c = 0; c < balls_found; ++c) {
      for (int field = 0; field < Balls::count; ++field) all.push_back(b.fields.at(field, c));
      for (int field = 0; field < Balls::gap_count; ++field) all.push_back(b.gaps.at(field, c));
      for (int field = 0; field < Rolling::count; ++field) all.push_back(ball_rolling().fields.at(field, c));
    }
    const Points p = points();
    for (std::int64_t c = 0; c < points_found; ++c) {
      for (int k = 0; k < p.points[c]; ++k) {
        for (int e = 0; e < 3; ++e) {
          all.push_back(p.point_fields.at(Points::at_point(k, Points::impulse) + e, c));
          all.push_back(p.point_fields.at(Points::at_point(k, Points::last) + e, c));
        }
        all.push_back(p.gaps.at(Points::at_point(k, Points::pushed), c));
        all.push_back(p.gaps.at(Points::at_point(k, Points::pushed_before), c));
      }
      for (int field = 0; field < Rolling::count; ++field) all.push_back(point_rolling().fields.at(field, c));
    }
    for (const auto& body : bodies)
      for (const V3<Real>& v : {body.velocity, body.spin}) all.insert(all.end(), {v.x, v.y, v.z});
    for (const auto* list : {&centres, &turns})
      for (const auto& centre : *list)
        all.insert(all.end(), {centre.velocity.x, centre.velocity.y, centre.velocity.z});
    return all;
  }

  std::vector<BodyRecord<Real>> bodies, last;
  std::vector<CentreRecord<Real>> centres, turns;

 private:
  template <class At>
  static void put_gap(const At& at, Real predicted_gap, Real pushed) {
    at(Balls::gap) = at(Balls::predicted_gap) = predicted_gap;
    at(Balls::pushed) = pushed;
    at(Balls::pushed_before) = 0;
  }
  std::vector<std::pair<void*, std::size_t>> memory() {
    const auto bytes = [](std::int64_t reals) { return static_cast<std::size_t>(reals) * sizeof(Real); };
    const Balls b = balls();
    const Points p = points();
    return {{&b.fields.at(0, 0), bytes(decltype(b.fields)::size(b.slot.size()))},
            {&b.gaps.at(0, 0), bytes(decltype(b.gaps)::size(b.slot.size()))},
            {&p.fields.at(0, 0), bytes(decltype(p.fields)::size(p.slot.size()))},
            {&p.point_fields.at(0, 0), bytes(decltype(p.point_fields)::size(p.slot.size()))},
            {&p.gaps.at(0, 0), bytes(decltype(p.gaps)::size(p.slot.size()))},
            {ball_rolling_.data(), bytes(ball_rolling_.size())},
            {point_rolling_.data(), bytes(point_rolling_.size())}};
  }

  ContactStore<Host, Real> store_;
  Array<Real, Host> ball_rolling_, point_rolling_;
};

/// Makes all visits to all contacts of a problem, each by `over(visit, found, more...)`, which returns the
/// sum of the results.
template <class Real, class Over>
std::vector<double> visit_all(Problem<Real>& problem, const Over& over) {
  constexpr Real beta = static_cast<Real>(0.7), share = static_cast<Real>(0.4), none = 0;
  BodyRecord<Real>* const bodies = problem.bodies.data();
  const auto balls = problem.balls();
  const auto points = problem.points();
  const auto ball_rolling = problem.ball_rolling(), point_rolling = problem.point_rolling();
  constexpr int b = Problem<Real>::balls_found, p = Problem<Real>::points_found;
  std::vector<double> sums;
  const auto sum = [&](const SweepChange& change) { sums.insert(sums.end(), {change.step, change.size}); };
  over(PushBalls<Real>{balls, bodies}, b);
  over(PushPoints<Real>{points, bodies}, p);
  over(PushRollingBalls<Real>{balls, ball_rolling, bodies}, b);
  over(PushRollingPoints<Real>{points, point_rolling, bodies}, p);
  for (const bool momentum : {true, false}) {
    sum(over(SweepBalls<Real>{balls, bodies, momentum}, b, momentum ? beta : none));
    sum(over(RollBalls<Real>{balls, ball_rolling, bodies, momentum}, b, momentum ? beta : none));
  }
  for (const int block_sweeps : {1, 4}) {
    sum(over(SweepPoints<Real>{points, bodies, block_sweeps}, p, beta));
    sum(over(RollPoints<Real>{points, point_rolling, bodies, true}, p, beta));
  }
  CentreRecord<Real>* const centres = problem.centres.data();
  CentreRecord<Real>* const turns = problem.turns.data();
  for (const bool momentum : {false, true, true}) {
    for (const Overlaps& overlaps :
         {over(CorrectBalls<Real>{balls, centres, share, momentum}, b, momentum ? beta : none),
          over(CorrectPoints<Real>{points, centres, turns, share, momentum}, p, momentum ? beta : none)})
      sums.insert(sums.end(), {overlaps.deepest, overlaps.sum, overlaps.count});
  }
  return sums;
}

/// Visits one contact after the other.
template <class Real>
struct OneByOne {
  template <class Visit, class... More>
  auto operator()(const Visit& visit, int found, More... more) const {
    using A = Scalar<Real>;
    using Result = decltype(visit.template visit<A>(0, more...));
    if constexpr (std::is_void_v<Result>) {
      for (int c = 0; c < found; ++c) visit.template visit<A>(c, more...);
    } else if constexpr (std::is_same_v<Result, Real>) {
      Overlaps sum;
      for (int c = 0; c < found; ++c)
        sum = sum + Overlaps::of_gap(static_cast<float>(visit.template visit<A>(c, more...)));
      return sum;
    } else {
      Result sum;
      for (int c = 0; c < found; ++c) sum = sum + visit.template visit<A>(c, more...);
      return sum;
    }
  }
};

template <class Real>
struct BySet {
  const VisitKernels<Real>& kernels;
  template <class Visit, class... More>
  auto operator()(const Visit& visit, int found, More... more) const {
    return kernels(visit, Blocks{0, (found + simd::width - 1) / simd::width}, more...);
  }
};

class VisitKernelsTest : public testing::TestWithParam<std::tuple<std::string, bool, bool>> {
 protected:
  template <class Real>
  const VisitKernels<Real>& kernels() const {
    return contact_kernels(std::get<0>(GetParam()).c_str()).template visits<Real>();
  }
  template <class Real>
  Problem<Real> problem() const {
    return Problem<Real>(std::get<1>(GetParam()), std::get<2>(GetParam()));
  }
  template <class Real>
  void expect_that_several_are_each() const {
    Problem<Real> each = problem<Real>(), several = problem<Real>();
    const std::vector<double> sums = visit_all(each, OneByOne<Real>{});
    const std::vector<double> sums_of_several = visit_all(several, BySet<Real>{kernels<Real>()});
    const std::vector<Real> expected = each.numbers(), found = several.numbers();
    ASSERT_EQ(expected.size(), found.size());
    for (std::size_t k = 0; k < expected.size(); ++k) ASSERT_EQ(expected[k], found[k]) << k;
    // The sums are added up in another order.
    ASSERT_EQ(sums.size(), sums_of_several.size());
    for (std::size_t k = 0; k < sums.size(); ++k)
      EXPECT_NEAR(sums[k], sums_of_several[k], float_sums * (1 + sums[k])) << k;
  }
  template <class Real>
  void expect_that_bodies_go_on() const {
    Problem<Real> each = problem<Real>(), several = problem<Real>();
    for (const Real beta : {static_cast<Real>(0.6), static_cast<Real>(0.6), Real{}}) {
      for (Problem<Real>* p : {&each, &several})
        for (BodyRecord<Real>& body : p->bodies) body.velocity.x += 1;
      const Accelerate<Real> one{each.bodies.data(), each.last.data()};
      for (std::int64_t k = 0; k <= Problem<Real>::padding_body; ++k) one.visit(k, beta);
      kernels<Real>().accelerate({several.bodies.data(), several.last.data()}, 0,
                                 Problem<Real>::padding_body + 1, beta);
      EXPECT_EQ(each.numbers(), several.numbers());
    }
  }
};

TEST_P(VisitKernelsTest, VisitsToSeveralAreVisitsToEach) {
  expect_that_several_are_each<double>();
  expect_that_several_are_each<float>();
}

TEST_P(VisitKernelsTest, BodiesGoOnByWhatTheLastSweepChanged) {
  expect_that_bodies_go_on<double>();
  expect_that_bodies_go_on<float>();
}

std::vector<std::string> instruction_sets() {
  std::vector<std::string> names;
  for (const simd::NamedKernels& set : simd::supported_kernels()) names.emplace_back(set.name);
  return names;
}
INSTANTIATE_TEST_SUITE_P(Sets, VisitKernelsTest,
                         testing::Combine(testing::ValuesIn(instruction_sets()), testing::Bool(),
                                          testing::Bool()),
                         [](const auto& test) {
                           return std::get<0>(test.param) + (std::get<1>(test.param) ? "_rough" : "_smooth") +
                                  (std::get<2>(test.param) ? "_rolling" : "");
                         });

}  // namespace
}  // namespace scree::solver
