// Tests of visits to one contact, against the scalar reference: the rows of sim/laws/contact_row.hpp, swept
// one after the other, and the couples of rolling.hpp.
#include "core/rng.hpp"
#include "sim/contacts/contact_store.hpp"
#include "sim/contacts/rolling_visits.hpp"
#include "sim/contacts/sweeps.hpp"
#include "sim/laws/rolling.hpp"
#include "sim/laws/rotation.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace scree::solver {
namespace {

constexpr double rounding = 1e-12;  // for velocities of some m/s and impulses of some N s

Vec3 vector_in(Random& random, double size) {
  const double x = random.uniform(-size, size), y = random.uniform(-size, size);
  return {x, y, random.uniform(-size, size)};
}

/// A contact between two bodies; in every fifth one the first body is not free.
struct Reference {
  SolverBody i, j;
  Vec3 normal;
  double friction, rolling_reach;
  std::vector<ContactRow> rows;
  std::vector<RowCoupling> couplings;
  Vec3 couple;

  Reference(std::uint64_t item, bool balls) {
    Random random(29, item);
    const auto body = [&](bool free) {
      const Vec3 diagonal(random.uniform(1, 2), random.uniform(1, 2), random.uniform(1, 2));
      const Vec3 turn = vector_in(random, 2);
      const Mat3 inertia =
          balls ? Mat3(diagonal.x() * Mat3::Identity()) : world_inverse_inertia(rotation_of(turn), diagonal);
      const double inverse_mass = random.uniform(0.3, 3);
      const Vec3 velocity = vector_in(random, 2), spin = vector_in(random, 3);
      return SolverBody{velocity, free || !balls ? spin : Vec3(Vec3::Zero()), free ? inverse_mass : 0.0,
                        free ? inertia : Mat3(Mat3::Zero())};
    };
    i = body(item % 5 != 0);
    j = body(true);
    normal = vector_in(random, 1).normalized();
    friction = item % 3 == 0 ? 0.0 : random.uniform(0, 1);
    rolling_reach = random.uniform(0, 0.3);
    const auto count = balls ? 1 : 1 + item % Manifold::max_points;
    for (std::size_t k = 0; k < count; ++k) {
      const double arm = random.uniform(0.2, 1), other = random.uniform(0.2, 1);
      RowCoupling& coupling = couplings.emplace_back();
      ContactRow& row =
          rows.emplace_back(balls ? make_ball_row(arm * normal, -other * normal, 0, i, j)
                                  : make_row(normal, arm * normal + vector_in(random, 0.5),
                                             vector_in(random, 0.5) - other * normal, 0, i, j, coupling));
      if (balls) {
        // W is diagonal, so that nothing is coupled.
        const Mat3 along = normal * normal.transpose();
        coupling.stick = row.normal_mass * along + row.tangent_mass * (Mat3::Identity() - along);
        coupling.normal = normal / row.normal_mass;
      }
      row.target = random.uniform(-1, 0);
      row.impulse = project_on_cone(random.uniform(0, 2) * normal + vector_in(random, 1), normal, friction);
    }
    couple = vector_in(random, 0.2);
    couple -= couple.dot(normal) * normal;
  }
};

BodyRecord<double> record_of(const SolverBody& body) {
  BodyRecord<double> record;
  record.velocity = v3<double>(body.velocity);
  record.inverse_mass = body.inverse_mass;
  record.spin = v3<double>(body.spin);
  record.inverse_inertia = body.inverse_inertia(0, 0);
  return record;
}

void expect_moves(const BodyRecord<double>& record, const SolverBody& body, std::uint64_t item) {
  EXPECT_LT((vec3(record.velocity) - body.velocity).norm(), rounding) << item;
  EXPECT_LT((vec3(record.spin) - body.spin).norm(), rounding) << item;
}

/// A store with one contact of each kind, its rolling couple and its two bodies.
template <class Contacts>
struct Stored {
  ContactStore<Host, double> store;
  std::vector<double> rolling_data = std::vector<double>(
      static_cast<std::size_t>(decltype(RollingFields<double>::fields)::size(simd::width)));
  RollingFields<double> rolling{decltype(RollingFields<double>::fields)(rolling_data.data())};
  std::vector<BodyRecord<double>> bodies;

  explicit Stored(const Reference& of) {
    ColorRanges one;
    one.add(1);
    store.take_balls(one);
    store.take_points(one);
    bodies = {record_of(of.i), record_of(of.j)};
    rolling.fields.at(RollingFields<double>::reach, 0) = of.rolling_reach;
    rolling.fields.set(RollingFields<double>::couple, 0, v3<double>(of.couple));
    rolling.fields.set(RollingFields<double>::last, 0, v3<double>(of.couple));
  }
};

struct StoredBalls : Stored<BallContacts<double>> {
  using C = BallContacts<double>;
  C contacts = store.balls();

  explicit StoredBalls(const Reference& of) : Stored(of) {
    const ContactRow& row = of.rows[0];
    contacts.ends[0] = {0, 1};
    const auto& f = contacts.fields;
    f.set(C::normal, 0, v3<double>(of.normal));
    f.at(C::arm_i, 0) = row.arm_i.dot(of.normal);
    f.at(C::arm_j, 0) = row.arm_j.dot(of.normal);
    f.at(C::friction, 0) = of.friction;
    f.at(C::target, 0) = row.target;
    f.at(C::normal_mass, 0) = row.normal_mass;
    f.at(C::tangent_mass, 0) = row.tangent_mass;
    f.set(C::impulse, 0, v3<double>(row.impulse));
    f.set(C::last, 0, v3<double>(row.impulse));
  }
};

struct StoredPoints : Stored<PointContacts<double>> {
  using C = PointContacts<double>;
  C contacts = store.points();

  explicit StoredPoints(const Reference& of) : Stored(of) {
    const auto put = [](const auto& fields, int first, const Mat3& m) {
      const double elements[] = {m(0, 0), m(1, 1), m(2, 2), m(0, 1), m(0, 2), m(1, 2)};
      for (int e = 0; e < 6; ++e) fields.at(first + e, 0) = elements[e];
    };
    contacts.ends[0] = {0, 1};
    contacts.points[0] = static_cast<std::int32_t>(of.rows.size());
    contacts.fields.set(C::normal, 0, v3<double>(of.normal));
    contacts.fields.at(C::friction, 0) = of.friction;
    put(contacts.fields, C::inertia_i, of.i.inverse_inertia);
    put(contacts.fields, C::inertia_j, of.j.inverse_inertia);
    for (int k = 0; k < contacts.points[0]; ++k) {
      const ContactRow& row = of.rows[static_cast<std::size_t>(k)];
      const auto& f = contacts.point_fields;
      const auto at = [k](auto field) { return C::at_point(k, field); };
      f.set(at(C::arm_i), 0, v3<double>(row.arm_i));
      f.set(at(C::arm_j), 0, v3<double>(row.arm_j));
      put(f, at(C::stick), of.couplings[static_cast<std::size_t>(k)].stick);
      f.set(at(C::coupling), 0, v3<double>(of.couplings[static_cast<std::size_t>(k)].normal));
      f.at(at(C::target), 0) = row.target;
      f.at(at(C::normal_mass), 0) = row.normal_mass;
      f.at(at(C::tangent_mass), 0) = row.tangent_mass;
      f.set(at(C::impulse), 0, v3<double>(row.impulse));
      f.set(at(C::last), 0, v3<double>(row.impulse));
    }
  }
};

TEST(Visits, SweepBallsAsTheScalarReference) {
  for (std::uint64_t item = 0; item < 500; ++item) {
    Reference of(item, true);
    StoredBalls stored(of);
    const auto change =
        SweepBalls<double>{stored.contacts, stored.bodies.data(), true}.visit<Scalar<double>>(0, 0);
    const Vec3 before = of.rows[0].impulse;
    sweep_rows(of.rows.data(), of.couplings.data(), 1, of.normal, of.friction, of.i, of.j);
    const Vec3 impulse = vec3(stored.contacts.fields.vector(BallContacts<double>::impulse, 0));
    EXPECT_LT((impulse - of.rows[0].impulse).norm(), rounding) << item;
    EXPECT_NEAR(change.step, (of.rows[0].impulse - before).squaredNorm() / of.rows[0].normal_mass, 1e-9)
        << item;
    expect_moves(stored.bodies[0], of.i, item);
    expect_moves(stored.bodies[1], of.j, item);
  }
}

TEST(Visits, SweepPointsAsTheScalarReference) {
  for (std::uint64_t item = 0; item < 500; ++item) {
    constexpr int block_sweeps = 3;
    Reference of(item, false);
    StoredPoints stored(of);
    SweepPoints<double>{stored.contacts, stored.bodies.data(), block_sweeps}.visit<Scalar<double>>(0, 0);
    const int count = static_cast<int>(of.rows.size());
    for (int sweep = 0; sweep < block_sweeps; ++sweep)
      sweep_rows(of.rows.data(), of.couplings.data(), count, of.normal, of.friction, of.i, of.j);
    for (int k = 0; k < count; ++k) {
      using C = PointContacts<double>;
      const Vec3 impulse = vec3(stored.contacts.point_fields.vector(C::at_point(k, C::impulse), 0));
      EXPECT_LT((impulse - of.rows[static_cast<std::size_t>(k)].impulse).norm(), rounding) << item;
    }
    expect_moves(stored.bodies[0], of.i, item);
    expect_moves(stored.bodies[1], of.j, item);
  }
}

/// Expects a visit to give the couple that rolling_couple() gives, and to turn the bodies by it.
template <class Contacts, class Turn, class StoredContact>
void expect_rolls(bool balls) {
  for (std::uint64_t item = 0; item < 300; ++item) {
    Reference of(item, balls);
    StoredContact stored(of);
    Roll<double, Contacts, Turn>{stored.contacts, stored.rolling, stored.bodies.data(), true}
        .template visit<Scalar<double>>(0, 0);
    double pn = 0;
    for (const ContactRow& row : of.rows) pn += row.impulse.dot(of.normal);
    const double mass = rolling_mass(of.i, of.j, of.normal);
    const Vec3 couple =
        rolling_couple(of.couple, of.normal, of.rolling_reach * pn, mass, of.j.spin - of.i.spin);
    turn(couple - of.couple, of.i, of.j);
    EXPECT_LT((vec3(stored.rolling.fields.vector(RollingFields<double>::couple, 0)) - couple).norm(),
              rounding);
    expect_moves(stored.bodies[0], of.i, item);
    expect_moves(stored.bodies[1], of.j, item);
  }
}

TEST(Visits, RollAsTheScalarReference) {
  expect_rolls<BallContacts<double>, TurnBalls, StoredBalls>(true);
  expect_rolls<PointContacts<double>, TurnPoints, StoredPoints>(false);
}

}  // namespace
}  // namespace scree::solver
