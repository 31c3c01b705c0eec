// The kernels beside the scalar law, lane by lane, and beside one another, bit by bit.
#include "sim/dynamics/lanes/lanes.hpp"

#include "core/rng.hpp"
#include "sim/dynamics/contact_set.hpp"
#include "sim/dynamics/lanes/batches.hpp"
#include "sim/dynamics/rolling.hpp"
#include "sim/dynamics/rotation.hpp"
#include "sim/dynamics/state.hpp"

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <vector>

namespace scree {
namespace {

constexpr double rounding = 1e-12;  // of velocities of some m/s, and of impulses of some N s

Vec3 random_vector(Random& random, double size) {
  return Vec3(random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size));
}

/// Contacts of all kinds, each between two bodies of its own. Every fifth has a first body that is not free.
struct Problem {
  std::vector<Contact> contacts;
  std::vector<ContactRow> rows;
  std::vector<RowCoupling> couplings;
  std::vector<Vec3> couples;
  std::vector<SolverBody> bodies;
  Coloring coloring;
  lanes::Batches batches;

  explicit Problem(int count, bool smooth = false) {
    for (int c = 0; c < count; ++c) add(c, smooth);
    coloring.color_begin = {0, count};
    coloring.order.resize(static_cast<std::size_t>(count));
    std::iota(coloring.order.begin(), coloring.order.end(), 0);
    lanes::arrange(coloring, contact_view(), static_cast<std::int32_t>(bodies.size()), true, batches);
    lanes::load(contact_view(), row_view(), {couples.data(), size(couples)}, {bodies.data(), size(bodies)},
                lane_bodies().data(), {}, batches);
  }

  template <class T>
  static std::int64_t size(const std::vector<T>& list) {
    return static_cast<std::int64_t>(list.size());
  }
  ConstView<Contact> contact_view() const { return {contacts.data(), size(contacts)}; }
  View<ContactRow> row_view() { return {rows.data(), size(rows)}; }

  void add(int c, bool smooth) {
    Random random(29, static_cast<std::uint64_t>(c));
    Contact contact{};
    contact.i = 2 * c;
    contact.j = 2 * c + 1;
    contact.balls = c % 3 == 0;
    // A ball on a body that turns and is not free, whose arm is not along the normal.
    const bool turning = contact.balls && c % 5 == 0;
    contact.aligned = contact.balls && !turning;
    contact.count = contact.balls ? 1 : 1 + c % Manifold::max_points;
    contact.first_row = size(rows);
    contact.normal = random_vector(random, 1).normalized();
    contact.friction = smooth || c % 7 == 0 ? 0.0 : random.uniform(0, 1.2);
    contact.rolling_reach = c % 4 == 0 ? 0.0 : random.uniform(0, 0.5);
    Random rolling(41, static_cast<std::uint64_t>(c));
    const Vec3 couple = contact.rolling_reach * random_vector(rolling, 0.3);
    couples.push_back(couple - couple.dot(contact.normal) * contact.normal);
    for (int side = 0; side < 2; ++side) {
      const bool fixed = side == 0 && c % 5 == 0;
      SolverBody body{random_vector(random, 2), random_vector(random, 3), random.uniform(0.2, 3), {}};
      if (smooth && contact.balls) body.spin.setZero();
      Mat3 m;
      m << random_vector(random, 1), random_vector(random, 1), random_vector(random, 1);
      body.inverse_inertia = contact.balls ? Mat3(random.uniform(1, 20) * Mat3::Identity())
                                           : Mat3(Mat3::Identity() + m * m.transpose());
      if (fixed) {
        body.inverse_mass = 0;
        body.inverse_inertia.setZero();
      }
      bodies.push_back(body);
    }
    const SolverBody& i = bodies[static_cast<std::size_t>(contact.i)];
    const SolverBody& j = bodies[static_cast<std::size_t>(contact.j)];
    for (int k = 0; k < contact.count; ++k) {
      RowCoupling coupling{Mat3::Zero(), Vec3::Zero()};
      const Vec3 aside = turning ? random_vector(random, 1) : Vec3(Vec3::Zero());
      ContactRow row = contact.balls ? make_ball_row(random.uniform(0.1, 1) * contact.normal + aside,
                                                     -random.uniform(0.1, 1) * contact.normal, 0.0, i, j)
                                     : make_row(contact.normal, random_vector(random, 0.5),
                                                random_vector(random, 0.5), 0.0, i, j, coupling);
      row.target = random.uniform(-0.5, 0.5);
      row.impulse = project_on_cone(random_vector(random, 1), contact.normal, contact.friction);
      rows.push_back(row);
      couplings.push_back(coupling);
    }
    contacts.push_back(contact);
  }

  std::vector<lanes::Body> lane_bodies() const {
    std::vector<lanes::Body> all;
    for (const SolverBody& b : bodies)
      all.push_back({b.velocity, b.inverse_mass, b.spin, b.inverse_inertia(0, 0)});
    all.push_back({Vec3::Zero(), 0, Vec3::Zero(), 0});
    return all;
  }

  lanes::Change sweep(const lanes::SweepKernels& kernels, std::vector<lanes::Body>& all, double beta) {
    lanes::Change total{0, 0};
    const auto add_up = [&total](const lanes::Change& change) {
      total.step += change.step;
      total.size += change.size;
    };
    for (lanes::BallBatch& batch : batches.balls.view()) add_up(kernels.balls(batch, all.data(), beta));
    for (std::int64_t b = 0; b < batches.points.size(); b += lanes::abreast) {
      lanes::Change change[lanes::abreast];
      const auto count = static_cast<int>(std::min<std::int64_t>(lanes::abreast, batches.points.size() - b));
      kernels.points(&batches.points.view()[b], count, batches.rows.data(), all.data(), beta, 2, change);
      for (int k = 0; k < count; ++k) add_up(change[k]);
    }
    return total;
  }

  /// A visit to the couples of all contacts.
  lanes::Change roll(const lanes::Kernels& kernels, std::vector<lanes::Body>& all, double beta) {
    lanes::Change total{0, 0};
    for (std::int64_t b = 0; b < batches.balls.size(); ++b)
      total = total +
              kernels.roll_balls(batches.balls.view()[b], batches.ball_rolling.view()[b], all.data(), beta);
    for (std::int64_t b = 0; b < batches.points.size(); ++b) {
      const lanes::PointBatch& batch = batches.points.view()[b];
      total = total + kernels.roll_points(batch, &batches.rows.view()[batch.first_row],
                                          batches.point_rolling.view()[b], all.data(), beta);
    }
    return total;
  }
  void push_couples(const lanes::Kernels& kernels, std::vector<lanes::Body>& all) const {
    for (std::int64_t b = 0; b < batches.balls.size(); ++b)
      kernels.push_rolling_balls(batches.balls.view()[b], batches.ball_rolling.view()[b], all.data());
    for (std::int64_t b = 0; b < batches.points.size(); ++b)
      kernels.push_rolling_points(batches.points.view()[b], batches.point_rolling.view()[b], all.data());
  }

  void take_impulses_back() {
    std::vector<ImpulseChange> change(contacts.size());
    lanes::store_impulses(batches, row_view(), {change.data(), size(change)});
    lanes::store_couples(batches, {couples.data(), size(couples)});
  }
};

constexpr int odd_count = 213;  // leaves lanes without contact in every kind

TEST(Lanes, SweepAsTheScalarLawDoes) {
  for (const auto& [name, kernels] : lanes::supported_kernels()) {
    Problem p(odd_count);
    Problem scalar(odd_count);
    std::vector<lanes::Body> bodies = p.lane_bodies();
    const lanes::Change change = p.sweep(kernels->rough, bodies, 0.0);
    p.take_impulses_back();
    ImpulseChange expected;
    for (const Contact& c : scalar.contacts) {
      SolverBody& i = scalar.bodies[static_cast<std::size_t>(c.i)];
      SolverBody& j = scalar.bodies[static_cast<std::size_t>(c.j)];
      ContactRow* rows = &scalar.rows[static_cast<std::size_t>(c.first_row)];
      Vec3 last[Manifold::max_points];
      for (int k = 0; k < c.count; ++k) last[k] = rows[k].impulse;
      if (c.balls) {
        rows[0].impulse = natural_map(rows[0], c.normal, c.friction, rows[0].relative_velocity(i, j));
        rows[0].push(rows[0].impulse - last[0], i, j);
      } else {
        for (int sweep = 0; sweep < (c.count > 1 ? 2 : 1); ++sweep) {
          sweep_rows(rows, &scalar.couplings[static_cast<std::size_t>(c.first_row)], c.count, c.normal,
                     c.friction, i, j);
        }
      }
      for (int k = 0; k < c.count; ++k) {
        expected.add(rows[k], rows[k].impulse - last[k]);
        const auto r = static_cast<std::size_t>(c.first_row + k);
        ASSERT_LT((p.rows[r].impulse - rows[k].impulse).norm(), rounding) << name << ", row " << r;
      }
      for (const std::int32_t b : {c.i, c.j}) {
        const auto at = static_cast<std::size_t>(b);
        ASSERT_LT((bodies[at].velocity - scalar.bodies[at].velocity).norm(), rounding) << name << b;
        ASSERT_LT((bodies[at].spin - scalar.bodies[at].spin).norm(), rounding) << name << b;
      }
    }
    EXPECT_NEAR(change.step, expected.step, rounding * expected.step) << name;
    EXPECT_NEAR(change.size, expected.size, rounding * expected.size) << name;
  }
}

TEST(Lanes, RollAsTheScalarLawDoes) {
  for (const auto& [name, kernels] : lanes::supported_kernels()) {
    Problem p(odd_count);
    const std::vector<Vec3> last = p.couples;
    std::vector<lanes::Body> bodies = p.lane_bodies();
    const lanes::Change change = p.roll(*kernels, bodies, 0.0);
    p.take_impulses_back();
    ImpulseChange expected;
    int at_most = 0, inside = 0;
    for (std::size_t k = 0; k < p.contacts.size(); ++k) {
      const Contact& c = p.contacts[k];
      SolverBody i = p.bodies[static_cast<std::size_t>(c.i)];
      SolverBody j = p.bodies[static_cast<std::size_t>(c.j)];
      double pn = 0;
      for (int r = 0; r < c.count; ++r)
        pn += p.rows[static_cast<std::size_t>(c.first_row + r)].impulse.dot(c.normal);
      const double most = c.rolling_reach * pn;
      const double mass = rolling_mass(i, j, c.normal);
      const Vec3 couple = rolling_couple(last[k], c.normal, most, mass, j.spin - i.spin);
      turn(couple - last[k], i, j);
      expected =
          expected + ImpulseChange{(couple - last[k]).squaredNorm() / mass, couple.squaredNorm() / mass};
      (couple.norm() > (1 - rounding) * most ? at_most : inside) += most > 0;
      ASSERT_LT((p.couples[k] - couple).norm(), rounding) << name << k;
      ASSERT_LT((bodies[static_cast<std::size_t>(c.i)].spin - i.spin).norm(), 10 * rounding) << name << k;
      ASSERT_LT((bodies[static_cast<std::size_t>(c.j)].spin - j.spin).norm(), 10 * rounding) << name << k;
    }
    EXPECT_GT(at_most, 10);
    EXPECT_GT(inside, 10);
    EXPECT_NEAR(change.step, expected.step, rounding * expected.step) << name;
    EXPECT_NEAR(change.size, expected.size, rounding * expected.size) << name;
  }
}

TEST(Lanes, BooksAndPushesWhatCouplesMove) {
  for (const auto& [name, kernels] : lanes::supported_kernels()) {
    Problem p(odd_count);
    const std::vector<lanes::Body> before = p.lane_bodies();
    std::vector<lanes::Body> after = before;
    p.push_couples(*kernels, after);
    const auto check = [&, &name = name](const lanes::Members& members, const lanes::Ends& ends,
                                         const lanes::Rolling& rolling) {
      lanes::Losses losses{};
      lanes::Lane square{};
      // As if nothing had turned yet, and with all of it.
      kernels->book_rolling(ends, rolling, before.data(), losses);
      kernels->square_of_rolling(ends, rolling, before.data(), after.data(), square);
      Ledger all;
      for (int l = 0; l < lanes::width; ++l) {
        if (members.contact[l] < 0) continue;
        const Contact& c = p.contacts[static_cast<std::size_t>(members.contact[l])];
        const Vec3& couple = p.couples[static_cast<std::size_t>(members.contact[l])];
        const SolverBody& i = p.bodies[static_cast<std::size_t>(c.i)];
        const SolverBody& j = p.bodies[static_cast<std::size_t>(c.j)];
        const Ledger ledger = account_couple(couple, j.spin - i.spin, i, j);
        SolverBody turned_i = i, turned_j = j;
        turn(couple, turned_i, turned_j);
        const Vec3 turned = turned_j.spin - turned_i.spin - (j.spin - i.spin);
        ASSERT_NEAR(losses.of.at[l], ledger.friction, 10 * rounding) << name;
        ASSERT_NEAR(square.at[l], 0.5 * couple.dot(turned), 10 * rounding) << name;
        ASSERT_LT((after[static_cast<std::size_t>(c.i)].spin - turned_i.spin).norm(), 10 * rounding) << name;
        ASSERT_LT((after[static_cast<std::size_t>(c.j)].spin - turned_j.spin).norm(), 10 * rounding) << name;
        all = all + ledger;
      }
      ASSERT_NEAR(losses.books.friction, all.friction, 100 * rounding) << name;
      ASSERT_NEAR(losses.books.work, all.work, 100 * rounding) << name;
    };
    for (std::int64_t b = 0; b < p.batches.balls.size(); ++b)
      check(p.batches.ball_members.view()[b], p.batches.balls.view()[b].ends,
            p.batches.ball_rolling.view()[b]);
    for (std::int64_t b = 0; b < p.batches.points.size(); ++b)
      check(p.batches.point_members.view()[b], p.batches.points.view()[b].ends,
            p.batches.point_rolling.view()[b]);
  }
}

TEST(Lanes, MakesTheMassesOfPoints) {
  Problem p(odd_count);
  const std::vector<ContactRow> expected = p.rows;
  for (const Contact& c : p.contacts) {
    for (int k = 0; k < c.count && !c.aligned; ++k) {
      ContactRow& row = p.rows[static_cast<std::size_t>(c.first_row + k)];
      row.normal_mass = row.tangent_mass = 0;
    }
  }
  lanes::store_masses(p.batches, p.row_view());
  for (std::size_t r = 0; r < expected.size(); ++r) {
    ASSERT_NEAR(p.rows[r].normal_mass, expected[r].normal_mass, rounding) << r;
    ASSERT_NEAR(p.rows[r].tangent_mass, expected[r].tangent_mass, rounding) << r;
  }
}

TEST(Lanes, PushesGiveTheBodiesWhatTheImpulsesAre) {
  for (const auto& [name, kernels] : lanes::supported_kernels()) {
    Problem p(odd_count);
    std::vector<lanes::Body> bodies = p.lane_bodies();
    for (const lanes::BallBatch& batch : p.batches.balls.view()) kernels->push_balls(batch, bodies.data());
    for (const lanes::PointBatch& batch : p.batches.points.view())
      kernels->push_points(batch, &p.batches.rows.view()[batch.first_row], bodies.data());
    for (const Contact& c : p.contacts) {
      SolverBody i = p.bodies[static_cast<std::size_t>(c.i)];
      SolverBody j = p.bodies[static_cast<std::size_t>(c.j)];
      for (int k = 0; k < c.count; ++k) {
        const ContactRow& row = p.rows[static_cast<std::size_t>(c.first_row + k)];
        row.push(row.impulse, i, j);
      }
      ASSERT_LT((bodies[static_cast<std::size_t>(c.i)].velocity - i.velocity).norm(), rounding) << name;
      ASSERT_LT((bodies[static_cast<std::size_t>(c.j)].velocity - j.velocity).norm(), rounding) << name;
      ASSERT_LT((bodies[static_cast<std::size_t>(c.i)].spin - i.spin).norm(), 10 * rounding) << name;
      ASSERT_LT((bodies[static_cast<std::size_t>(c.j)].spin - j.spin).norm(), 10 * rounding) << name;
    }
  }
}

TEST(Lanes, BooksWhatTheImpulsesMove) {
  for (const auto& [name, kernels] : lanes::supported_kernels()) {
    Problem p(odd_count);
    const std::vector<lanes::Body> before = p.lane_bodies();
    std::vector<lanes::Body> after = before;
    std::vector<lanes::Body> mean = before;
    p.sweep(kernels->rough, after, 0.0);
    p.take_impulses_back();
    for (std::size_t b = 0; b < mean.size(); ++b) {
      mean[b].velocity = 0.5 * (before[b].velocity + after[b].velocity);
      mean[b].spin = 0.5 * (before[b].spin + after[b].spin);
    }
    const auto check = [&, &name = name](const lanes::Members& members, const lanes::Losses& losses,
                                         const lanes::Lane& square) {
      Ledger all;
      for (int l = 0; l < lanes::width; ++l) {
        if (members.contact[l] < 0) continue;
        const Contact& c = p.contacts[static_cast<std::size_t>(members.contact[l])];
        const auto velocity_in = [&](const std::vector<lanes::Body>& bodies, const ContactRow& row) {
          const lanes::Body& i = bodies[static_cast<std::size_t>(c.i)];
          const lanes::Body& j = bodies[static_cast<std::size_t>(c.j)];
          return row.relative_velocity(i.velocity, i.spin, j.velocity, j.spin);
        };
        const auto solved = [&](std::int32_t b) {
          SolverBody body = p.bodies[static_cast<std::size_t>(b)];
          body.velocity = after[static_cast<std::size_t>(b)].velocity;
          body.spin = after[static_cast<std::size_t>(b)].spin;
          return body;
        };
        Ledger ledger;
        double moved = 0;
        for (int k = 0; k < c.count; ++k) {
          const ContactRow& row = p.rows[static_cast<std::size_t>(c.first_row + k)];
          ledger = ledger + account(row, c.normal, velocity_in(before, row), solved(c.i), solved(c.j));
          moved += 0.5 * row.impulse.dot(velocity_in(after, row) - velocity_in(before, row));
        }
        ASSERT_NEAR(losses.of.at[l], ledger.restitution + ledger.friction, 10 * rounding) << name;
        ASSERT_NEAR(square.at[l], moved, 10 * rounding) << name;
        all = all + ledger;
      }
      ASSERT_NEAR(losses.books.restitution, all.restitution, 100 * rounding) << name;
      ASSERT_NEAR(losses.books.friction, all.friction, 100 * rounding) << name;
      ASSERT_NEAR(losses.books.work, all.work, 100 * rounding) << name;
    };
    lanes::Losses losses;
    lanes::Lane square;
    for (std::int64_t b = 0; b < p.batches.balls.size(); ++b) {
      kernels->book_balls(p.batches.balls.view()[b], mean.data(), losses);
      kernels->square_of_balls(p.batches.balls.view()[b], before.data(), after.data(), square);
      check(p.batches.ball_members.view()[b], losses, square);
    }
    for (std::int64_t b = 0; b < p.batches.points.size(); ++b) {
      const lanes::PointBatch& batch = p.batches.points.view()[b];
      const lanes::PointRow* rows = &p.batches.rows.view()[batch.first_row];
      kernels->book_points(batch, rows, mean.data(), losses);
      kernels->square_of_points(batch, rows, before.data(), after.data(), square);
      check(p.batches.point_members.view()[b], losses, square);
    }
  }
}

/// One overlapping point between two free bodies is parted by its share, and their common centre stays.
TEST(Lanes, PartsByTheShareAndKeepsTheCentre) {
  constexpr double share = 0.5;
  for (const auto& [name, kernels] : lanes::supported_kernels()) {
    Problem p(odd_count);
    std::vector<lanes::Body> moved = p.lane_bodies();
    for (lanes::Body& b : moved) b.velocity = b.spin = Vec3::Zero();
    std::vector<Mat3> factors;  // Cholesky's, of the inverse inertias
    std::vector<lanes::InertiaRoot> roots;
    for (const SolverBody& b : p.bodies) {
      const Mat3 l = b.is_free() ? Mat3(b.inverse_inertia.llt().matrixL()) : Mat3(Mat3::Zero());
      factors.push_back(l);
      roots.push_back({l(0, 0), l(1, 0), l(1, 1), l(2, 0), l(2, 1), l(2, 2)});
    }
    roots.push_back({});
    lanes::Lane gap;
    lanes::Lane cap;
    for (int l = 0; l < lanes::width; ++l) {
      gap.at[l] = l % 2 == 0 ? -0.01 : 0.01;
      cap.at[l] = 0.004;
    }
    const double cap_units = 0.01 / 0.004;
    for (const lanes::BallBatch& batch : p.batches.balls.view()) {
      lanes::BallParting parting{};
      parting.ends = batch.ends;
      parting.normal = batch.normal;
      parting.normal_mass = batch.normal_mass;
      parting.flown = gap;
      parting.cap = cap;
      EXPECT_NEAR(kernels->part_balls(parting, share, moved.data()), cap_units, rounding) << name;
    }
    // Nobody moves, so the first points keep their gaps and the others are far.
    for (lanes::PointBatch& batch : p.batches.points.view()) {
      batch.cap = cap;
      lanes::PointParting* points = &p.batches.point_partings.view()[batch.first_row];
      for (int k = 0; k < batch.count; ++k) {
        points[k].gap = gap;
        for (double& far : points[k].gap.at) far = k == 0 ? far : 0.1;
      }
      EXPECT_NEAR(kernels->fly_points(batch, &p.batches.rows.view()[batch.first_row], points, moved.data(),
                                      roots.data(), 1.0),
                  0.01, rounding)
          << name;
    }
    for (std::int64_t b = 0; b < p.batches.points.size(); b += lanes::abreast) {
      double deepest[lanes::abreast];
      const auto count =
          static_cast<int>(std::min<std::int64_t>(lanes::abreast, p.batches.points.size() - b));
      kernels->part_points(&p.batches.points.view()[b], count, p.batches.point_partings.data(), share,
                           moved.data(), deepest);
      for (int k = 0; k < count; ++k) EXPECT_NEAR(deepest[k], cap_units, rounding) << name;
    }
    for (std::size_t b = 0; b < factors.size(); ++b) {
      const bool of_points = !p.contacts[b / 2].aligned;
      if (of_points) moved[b].spin = (factors[b] * moved[b].spin).eval();
    }
    const auto check = [&, &name = name](const lanes::Members& members) {
      for (int l = 0; l < lanes::width; ++l) {
        if (members.contact[l] < 0) continue;
        const Contact& c = p.contacts[static_cast<std::size_t>(members.contact[l])];
        const ContactRow& row = p.rows[static_cast<std::size_t>(c.first_row)];
        const lanes::Body& i = moved[static_cast<std::size_t>(c.i)];
        const lanes::Body& j = moved[static_cast<std::size_t>(c.j)];
        const double parted = c.normal.dot(row.relative_velocity(i.velocity, i.spin, j.velocity, j.spin));
        ASSERT_NEAR(parted, l % 2 == 0 ? 0.004 : 0.0, rounding) << name;
        if (i.inverse_mass > 0) {
          ASSERT_LT((i.velocity / i.inverse_mass + j.velocity / j.inverse_mass).norm(), rounding) << name;
        } else {
          ASSERT_TRUE(i.velocity.isZero(0) && i.spin.isZero(0)) << name;
        }
      }
    };
    for (const lanes::Members& members : p.batches.ball_members.view()) check(members);
    for (const lanes::Members& members : p.batches.point_members.view()) check(members);
  }
}

TEST(Lanes, EveryInstructionSetGivesTheSameBits) {
  std::vector<lanes::Body> first;
  for (const auto& [name, kernels] : lanes::supported_kernels()) {
    Problem p(odd_count);
    std::vector<lanes::Body> bodies = p.lane_bodies();
    std::vector<lanes::Body> last = bodies;
    for (int sweep = 0; sweep < 5; ++sweep) {
      const double beta = 0.15 * sweep;
      kernels->accelerate(bodies.data(), last.data(), std::ssize(bodies), beta);
      p.sweep(kernels->rough, bodies, beta);
      p.roll(*kernels, bodies, beta);
    }
    if (first.empty()) {
      first = bodies;
      continue;
    }
    EXPECT_EQ(std::memcmp(first.data(), bodies.data(), bodies.size() * sizeof(lanes::Body)), 0) << name;
  }
}

/// Where nothing rubs, the kernels without tangents do what the others do: to the bit.
TEST(Lanes, SmoothKernelsDoWhatRoughOnesDoWithoutFriction) {
  for (const auto& [name, kernels] : lanes::supported_kernels()) {
    Problem rough(odd_count, true);
    Problem smooth(odd_count, true);
    std::vector<lanes::Body> a = rough.lane_bodies();
    std::vector<lanes::Body> b = smooth.lane_bodies();
    for (int sweep = 0; sweep < 3; ++sweep) {
      const double beta = 0.2 * sweep;
      const lanes::Change change_a = rough.sweep(kernels->rough, a, beta);
      const lanes::Change change_b = smooth.sweep(kernels->smooth, b, beta);
      EXPECT_EQ(change_a.step, change_b.step) << name;
      EXPECT_EQ(change_a.size, change_b.size) << name;
    }
    for (std::size_t k = 0; k < a.size(); ++k) {
      ASSERT_EQ(a[k].velocity, b[k].velocity) << name << k;
      ASSERT_EQ(a[k].spin, b[k].spin) << name << k;
    }
  }
}

/// Contacts that share a body, in the serial colour, come one after the other.
TEST(Lanes, TheSerialColourSharesNoBatch) {
  Problem p(odd_count);
  p.coloring.last_is_serial = true;
  lanes::arrange(p.coloring, p.contact_view(), static_cast<std::int32_t>(p.bodies.size()), false, p.batches);
  std::int64_t alone = 0;
  const auto count = [&alone](const lanes::Members& members) {
    alone += members.contact[0] >= 0 ? 1 : 0;
    for (int l = 1; l < lanes::width; ++l) EXPECT_LT(members.contact[l], 0);
  };
  for (const lanes::Members& members : p.batches.ball_members.view()) count(members);
  for (const lanes::Members& members : p.batches.point_members.view()) count(members);
  EXPECT_EQ(alone, odd_count);
}

/// Boxes of all proportions, slow and fast, two of them beyond one step of the splitting.
TEST(Lanes, TurnsAsOneBodyAloneDoes) {
  constexpr int far[] = {2, 5};
  for (const bool fourth_order : {false, true}) {
    lanes::Tops first{};
    for (const auto& [name, kernels] : lanes::supported_kernels()) {
      for (std::uint64_t item = 0; item < 500; ++item) {
        Random random(31, item);
        lanes::Tops tops{};
        Quat orientation[lanes::width];
        Vec3 spin[lanes::width];
        Vec3 inverse_inertia[lanes::width];
        const double dt = random.uniform(-0.01, 0.01);
        for (int l = 0; l < lanes::width; ++l) {
          const Vec3 axis = random_vector(random, 1);
          orientation[l] = Quat(random.uniform(-1, 1), axis.x(), axis.y(), axis.z()).normalized();
          const double x = random.uniform(1, 2);
          inverse_inertia[l] = {x, x * random.uniform(0.5, 1), x * random.uniform(0.3, 0.5)};
          const bool is_far = std::ranges::find(far, l) != std::end(far);
          const double turn = is_far ? 3 : std::pow(10.0, random.uniform(-8, -1));
          spin[l] = (turn / std::abs(dt)) * random_vector(random, 1).normalized();
          const auto put = [l](lanes::LaneVec& lanes, const Vec3& value) {
            lanes.x.at[l] = value.x();
            lanes.y.at[l] = value.y();
            lanes.z.at[l] = value.z();
          };
          tops.w.at[l] = orientation[l].w();
          put(tops.v, orientation[l].vec());
          put(tops.spin, spin[l]);
          put(tops.inverse_inertia, inverse_inertia[l]);
        }
        kernels->turn(tops, dt, fourth_order);
        ASSERT_EQ(tops.far, 1 << far[0] | 1 << far[1]) << name << item;
        for (int l = 0; l < lanes::width; ++l) {
          const auto take = [l](const lanes::LaneVec& lanes) {
            return Vec3(lanes.x.at[l], lanes.y.at[l], lanes.z.at[l]);
          };
          if ((tops.far >> l & 1) == 0)
            rotate_freely(orientation[l], spin[l], inverse_inertia[l], dt,
                          fourth_order ? RotationOrder::fourth : RotationOrder::second);
          const double speed = spin[l].norm();
          ASSERT_LT((take(tops.spin) - spin[l]).norm(), rounding * speed) << name << item;
          ASSERT_LT((take(tops.v) - orientation[l].vec()).norm(), rounding) << name << item;
          ASSERT_NEAR(tops.w.at[l], orientation[l].w(), rounding) << name << item;
          ASSERT_LT(std::abs(tops.drift.at[l]), rounding * speed * speed / inverse_inertia[l].z());
        }
        if (item > 0) continue;
        if (name == lanes::supported_kernels().front().name) first = tops;
        EXPECT_EQ(std::memcmp(&first.spin, &tops.spin, sizeof tops.spin), 0) << name;
        EXPECT_EQ(std::memcmp(&first.v, &tops.v, sizeof tops.v), 0) << name;
      }
    }
  }
}

}  // namespace
}  // namespace scree
