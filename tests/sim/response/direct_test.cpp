// Tests of the direct solver, against the laws of contact, evaluated from the impulses alone in long double,
// and against all active sets of a problem without friction, tried one by one.
#include "sim/response/direct.hpp"

#include "core/rng.hpp"
#include "sim/laws/rotation.hpp"

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <vector>

namespace scree {
namespace {

using Real = long double;
using RealVec = Eigen::Matrix<Real, 3, 1>;
using RealVector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;
using RealMatrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;

constexpr double tolerance = 1e-10;

/// Contacts between some bodies, of which the first one is not free.
struct Scene {
  std::vector<SolverBody> bodies;
  std::vector<Contact> contacts;
  std::vector<ContactRow> rows;
  std::vector<Vec3> velocity, spin;
  Islands islands;

  void add_contact(std::int32_t i, std::int32_t j, const Vec3& normal, double friction, double target,
                   const std::vector<Vec3>& arms_i, const std::vector<Vec3>& arms_j) {
    Contact contact{};
    contact.i = i;
    contact.j = j;
    contact.count = static_cast<std::int32_t>(arms_i.size());
    contact.first_row = static_cast<std::int64_t>(rows.size());
    contact.normal = normal;
    contact.friction = friction;
    contacts.push_back(contact);
    for (std::size_t k = 0; k < arms_i.size(); ++k) {
      RowCoupling coupling;
      rows.push_back(make_row(normal, arms_i[k], arms_j[k], 0.0, bodies[at(i)], bodies[at(j)], coupling));
      rows.back().target = target;
    }
  }

  DirectOutcome solve(const DirectLimits& limits = quick_limits) {
    for (const SolverBody& b : bodies) {
      velocity.push_back(b.velocity);
      spin.push_back(b.spin);
    }
    islands.find(contact_view(), {bodies.data(), size(bodies)});
    DirectOutcome worst = DirectOutcome::solved;
    for (std::int64_t k = 0; k < islands.count(); ++k) {
      const DirectOutcome outcome = solve_directly({.contacts = contact_view(),
                                                    .rows = {rows.data(), size(rows)},
                                                    .solver = {bodies.data(), size(bodies)},
                                                    .velocity = {velocity.data(), size(velocity)},
                                                    .spin = {spin.data(), size(spin)},
                                                    .islands = islands,
                                                    .island = k},
                                                   tolerance, limits);
      if (outcome != DirectOutcome::solved) worst = outcome;
    }
    return worst;
  }

  static std::size_t at(std::int32_t k) { return static_cast<std::size_t>(k); }
  template <class T>
  static std::int64_t size(const std::vector<T>& list) {
    return static_cast<std::int64_t>(list.size());
  }
  ConstView<Contact> contact_view() const { return {contacts.data(), size(contacts)}; }
};

Vec3 random_vector(Random& random, double size) {
  return Vec3(random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size));
}

SolverBody fixed_body() { return {Vec3::Zero(), Vec3::Zero(), 0.0, Mat3::Zero()}; }

SolverBody random_body(Random& random) {
  const Vec3 inverse_inertia(random.uniform(1, 20), random.uniform(1, 20), random.uniform(1, 20));
  return {random_vector(random, 2), random_vector(random, 3), std::pow(10.0, random.uniform(-2, 1)),
          world_inverse_inertia(rotation_of(random_vector(random, 3)), inverse_inertia)};
}

/// Returns a chain of bodies from the ground up: each touches the one below it and the ground, at one point
/// each.
Scene random_scene(std::uint64_t item, double largest_friction) {
  Random random(23, item);
  Scene scene;
  scene.bodies.push_back(fixed_body());
  const int count = 1 + static_cast<int>(random.uniform(0, 4));
  for (int k = 0; k < count; ++k) scene.bodies.push_back(random_body(random));
  // Normals point upwards, so that there is a way out. A contact may have some room left to close.
  const auto touch = [&](std::int32_t i, std::int32_t j) {
    const Vec3 normal = (random_vector(random, 1) + Vec3(0, 0, 1.2)).normalized();
    scene.add_contact(i, j, normal, random.uniform(0, largest_friction),
                      std::min(random.uniform(-0.5, 0.5), 0.0), {random_vector(random, 0.5)},
                      {random_vector(random, 0.5)});
  };
  for (std::int32_t k = 1; k <= count; ++k) {
    touch(k - 1, k);
    touch(0, k);
  }
  return scene;
}

/// Returns the relative velocities at the rows that their impulses give from the start, in long double.
std::vector<RealVec> velocities(const Scene& scene) {
  std::vector<RealVec> v, w;
  for (std::size_t k = 0; k < scene.bodies.size(); ++k) {
    v.push_back(scene.velocity[k].cast<Real>());
    w.push_back(scene.spin[k].cast<Real>());
  }
  const auto for_each_row = [&](auto f) {
    for (const Contact& c : scene.contacts) {
      for (int k = 0; k < c.count; ++k) f(c, static_cast<std::size_t>(c.first_row + k));
    }
  };
  for_each_row([&](const Contact& c, std::size_t r) {
    const ContactRow& row = scene.rows[r];
    const RealVec p = row.impulse.cast<Real>();
    const auto push = [&](std::int32_t body, const Vec3& arm, const RealVec& impulse) {
      const SolverBody& b = scene.bodies[Scene::at(body)];
      v[Scene::at(body)] += Real(b.inverse_mass) * impulse;
      w[Scene::at(body)] += b.inverse_inertia.cast<Real>() * arm.cast<Real>().cross(impulse);
    };
    push(c.i, row.arm_i, -p);
    push(c.j, row.arm_j, p);
  });
  std::vector<RealVec> u(scene.rows.size());
  for_each_row([&](const Contact& c, std::size_t r) {
    const ContactRow& row = scene.rows[r];
    u[r] = v[Scene::at(c.j)] + w[Scene::at(c.j)].cross(row.arm_j.cast<Real>()) - v[Scene::at(c.i)] -
           w[Scene::at(c.i)].cross(row.arm_i.cast<Real>());
  });
  return u;
}

/// Returns how far the impulses are from Signorini's and Coulomb's laws (m/s; impulses are divided by their
/// row's mass).
double violation(const Scene& scene) {
  const std::vector<RealVec> u = velocities(scene);
  Real worst = 0;
  for (const Contact& c : scene.contacts) {
    const RealVec n = c.normal.cast<Real>();
    for (int k = 0; k < c.count; ++k) {
      const auto r = static_cast<std::size_t>(c.first_row + k);
      const ContactRow& row = scene.rows[r];
      const RealVec p = row.impulse.cast<Real>() / Real(row.normal_mass);
      const Real pn = p.dot(n);
      const Real un = u[r].dot(n) - Real(row.target);
      const RealVec pt = p - pn * n;
      const RealVec ut = u[r] - u[r].dot(n) * n;
      worst = std::max({worst, -pn, -un, std::min(pn, un), pt.norm() - Real(c.friction) * pn});
      // Where a contact slips, friction is at its limit and against the slip.
      if (pn > 0)
        worst = std::max(worst, std::min(ut.norm(), (pt + Real(c.friction) * pn * ut.normalized()).norm()));
    }
  }
  return static_cast<double>(worst);
}

/// Returns how many of the problems are solved, and expects these to obey the laws.
int number_solved(int problems, double largest_friction) {
  int solved = 0;
  for (int item = 0; item < problems; ++item) {
    Scene scene = random_scene(static_cast<std::uint64_t>(item), largest_friction);
    if (scene.solve() != DirectOutcome::solved) continue;
    ++solved;
    // The tolerance is for velocities of some m/s, at mass ratios of 1e3.
    EXPECT_LT(violation(scene), 1e-7) << "item " << item;
  }
  return solved;
}

TEST(NaturalResidual, IsWhatTheMapChangesAndNextToNothingAtASolution) {
  for (std::uint64_t item = 0; item < 200; ++item) {
    Scene scene = random_scene(item, 0.5);
    Random random(31, item);
    const ImpulseChange at_random = [&] {
      Scene other = scene;
      for (ContactRow& row : other.rows) row.impulse = random_vector(random, 1);
      ImpulseChange residual;
      Real step = 0;
      Real size = 0;
      for (const Contact& c : other.contacts) {
        const SolverBody& i = other.bodies[Scene::at(c.i)];
        const SolverBody& j = other.bodies[Scene::at(c.j)];
        const auto first = static_cast<std::size_t>(c.first_row);
        residual = residual + natural_residual(c, &other.rows[first], i, j);
        // The map steps by the row's masses along -u, then takes the nearest impulse in the cone for its
        // normal part.
        for (std::size_t r = first; r < first + static_cast<std::size_t>(c.count); ++r) {
          const ContactRow& row = other.rows[r];
          const RealVec n = c.normal.cast<Real>();
          const RealVec p = row.impulse.cast<Real>();
          const RealVec u =
              (j.velocity + j.spin.cross(row.arm_j) - i.velocity - i.spin.cross(row.arm_i)).cast<Real>();
          const Real pn = std::max<Real>(0, p.dot(n) - (u.dot(n) - Real(row.target)) * Real(row.normal_mass));
          RealVec pt = (p - p.dot(n) * n) - Real(row.tangent_mass) * (u - u.dot(n) * n);
          const Real most = Real(c.friction) * pn;
          if (pt.norm() > most) pt *= most / pt.norm();
          step += (pn * n + pt - p).squaredNorm() / Real(row.normal_mass);
          size += p.squaredNorm() / Real(row.normal_mass);
        }
      }
      EXPECT_NEAR(residual.step, static_cast<double>(step), 1e-12 * residual.step) << item;
      EXPECT_NEAR(residual.size, static_cast<double>(size), 1e-12 * residual.size) << item;
      return residual;
    }();
    EXPECT_FALSE(at_random.within(0.01));
    if (scene.solve() != DirectOutcome::solved) continue;
    ImpulseChange left;
    for (const Contact& c : scene.contacts) {
      left = left + natural_residual(c, &scene.rows[static_cast<std::size_t>(c.first_row)],
                                     scene.bodies[Scene::at(c.i)], scene.bodies[Scene::at(c.j)]);
    }
    EXPECT_TRUE(left.within(tolerance)) << item;
  }
}

TEST(Direct, ObeysTheLawsOfContact) {
  EXPECT_GT(number_solved(1000, 0.2), 990);
  // Where friction couples strongly with the normals, slips need more passes than the solver makes.
  EXPECT_GT(number_solved(1000, 1.2), 850);
}

TEST(Direct, FindsTheActiveSetThatAllOthersFail) {
  for (std::uint64_t item = 0; item < 100; ++item) {
    Scene scene = random_scene(item, 0.0);
    ASSERT_EQ(scene.solve(), DirectOutcome::solved) << "item " << item;
    // The velocities without impulses, and W column by column, from unit impulses.
    const auto rows = static_cast<Eigen::Index>(scene.rows.size());
    Scene probe = scene;
    const auto normal_velocities = [&] {
      const std::vector<RealVec> u = velocities(probe);
      RealVector un(rows);
      for (Eigen::Index r = 0; r < rows; ++r) {
        const auto k = static_cast<std::size_t>(r);
        un[r] = u[k].dot(probe.contacts[k].normal.cast<Real>()) - Real(probe.rows[k].target);
      }
      return un;
    };
    for (ContactRow& row : probe.rows) row.impulse.setZero();
    const RealVector free = normal_velocities();
    RealMatrix w(rows, rows);
    for (Eigen::Index r = 0; r < rows; ++r) {
      const auto k = static_cast<std::size_t>(r);
      probe.rows[k].impulse = probe.contacts[k].normal;
      w.col(r) = normal_velocities() - free;
      probe.rows[k].impulse.setZero();
    }
    std::optional<RealVector> velocities_of_solution;
    for (int set = 0; set < (1 << rows) && !velocities_of_solution; ++set) {
      std::vector<Eigen::Index> active;
      for (Eigen::Index r = 0; r < rows; ++r) {
        if (set >> r & 1) active.push_back(r);
      }
      RealVector p = RealVector::Zero(rows);
      if (!active.empty()) p(active) = RealMatrix(w(active, active)).fullPivLu().solve(-free(active));
      const RealVector u = free + w * p;
      if (p.minCoeff() >= -1e-12L && u.minCoeff() >= -1e-12L) velocities_of_solution = u;
    }
    ASSERT_TRUE(velocities_of_solution) << "item " << item;
    probe = scene;
    EXPECT_LT((normal_velocities() - *velocities_of_solution).norm(), 1e-7L) << "item " << item;
  }
}

/// Returns unit cubes on one another, each of a given mass, that gravity has pulled down for a while.
Scene stack(const std::vector<double>& masses, double friction) {
  Scene scene;
  scene.bodies.push_back(fixed_body());
  for (const double mass : masses) {
    scene.bodies.push_back({Vec3(0, 0, -0.04), Vec3::Zero(), 1 / mass, 6 / mass * Mat3::Identity()});
  }
  for (std::int32_t k = 1; k < static_cast<std::int32_t>(scene.bodies.size()); ++k) {
    std::vector<Vec3> top, bottom;
    for (const double x : {-0.5, 0.5}) {
      for (const double y : {-0.5, 0.5}) {
        top.emplace_back(x, y, k == 1 ? 0.0 : 0.5);
        bottom.emplace_back(x, y, -0.5);
      }
    }
    scene.add_contact(k - 1, k, Vec3::UnitZ(), friction, 0.0, top, bottom);
  }
  return scene;
}

TEST(Direct, CarriesStacksWhateverTheirMasses) {
  for (const auto& masses :
       {std::vector<double>{1, 1e4}, {1, 1e3, 1, 1e3, 1}, std::vector<double>(100, 700.0)}) {
    Scene scene = stack(masses, 0.5);
    EXPECT_EQ(scene.solve(), DirectOutcome::solved);
    double above = 0;
    for (std::size_t k = scene.contacts.size(); k-- > 0;) {
      above += masses[k];
      Vec3 sum = Vec3::Zero();
      for (int p = 0; p < 4; ++p)
        sum += scene.rows[static_cast<std::size_t>(scene.contacts[k].first_row + p)].impulse;
      EXPECT_LT((sum - Vec3(0, 0, 0.04 * above)).norm(), 1e-7 * 0.04 * above);
    }
  }
}

TEST(Direct, LeavesWhatIsTooLargeAsItWas) {
  Scene scene = stack(std::vector<double>(1000, 1.0), 0.5);
  EXPECT_EQ(scene.solve(), DirectOutcome::not_tried);
  for (const ContactRow& row : scene.rows) EXPECT_TRUE(row.impulse.isZero(0));
}

/// Returns a bed of balls of random sizes in a lattice, pressed by a heavy lid. What they are stacked on
/// holds them by friction, and smooth walls hold them from all sides.
Scene pressed_bed(std::uint64_t item) {
  Random random(47, item);
  Scene scene;
  const auto side = static_cast<std::int32_t>(random.uniform(2, 5));
  const std::int32_t layers = 3;
  const double friction = random.uniform(0.2, 0.8);
  const auto body = [&](double mass, double inertia) {
    scene.bodies.push_back({Vec3(0, 0, -1) + random_vector(random, 0.05), random_vector(random, 0.05),
                            1 / mass, Mat3(Mat3::Identity() / inertia)});
  };
  scene.bodies.push_back({Vec3::Zero(), Vec3::Zero(), 0, Mat3::Zero()});
  std::vector<Vec3> centre{Vec3::Zero()};
  std::vector<double> radius{0};
  for (std::int32_t z = 0; z < layers; ++z) {
    for (std::int32_t y = 0; y < side; ++y) {
      for (std::int32_t x = 0; x < side; ++x) {
        const double r = random.uniform(0.9, 1.1);
        body(r * r * r, 0.4 * r * r * r * r * r);
        centre.push_back(2 * Vec3(x, y, z) + random_vector(random, 0.2));
        radius.push_back(r);
      }
    }
  }
  const auto touch = [&](std::int32_t i, const Vec3& arm, std::int32_t j, const Vec3& normal, double mu) {
    scene.add_contact(i, j, normal, mu, 0, {arm}, {-radius[Scene::at(j)] * normal});
  };
  const std::int32_t balls = side * side * layers;
  for (std::int32_t j = 1; j <= balls; ++j) {
    const std::int32_t x = (j - 1) % side, y = (j - 1) / side % side, z = (j - 1) / side / side;
    const auto touch_next = [&](std::int32_t i) {
      const Vec3 normal = (centre[Scene::at(j)] - centre[Scene::at(i)]).normalized();
      touch(i, radius[Scene::at(i)] * normal, j, normal, friction);
    };
    if (x > 0) touch_next(j - 1);
    if (y > 0) touch_next(j - side);
    if (z > 0) touch_next(j - side * side);
    if (x == 0) touch(0, Vec3::Zero(), j, Vec3::UnitX(), 0);
    if (y == 0) touch(0, Vec3::Zero(), j, Vec3::UnitY(), 0);
    if (z == 0) touch(0, Vec3::Zero(), j, Vec3::UnitZ(), friction);
    if (x == side - 1) touch(0, Vec3::Zero(), j, -Vec3::UnitX(), 0);
    if (y == side - 1) touch(0, Vec3::Zero(), j, -Vec3::UnitY(), 0);
  }
  const std::int32_t lid = balls + 1;
  body(100, 100.0 * side * side);
  for (std::int32_t j = balls - side * side + 1; j <= balls; ++j) {
    const Vec3& c = centre[Scene::at(j)];
    scene.add_contact(j, lid, Vec3::UnitZ(), friction, 0, {radius[Scene::at(j)] * Vec3::UnitZ()},
                      {Vec3(c.x() - side + 1, c.y() - side + 1, -0.5)});
  }
  return scene;
}

/// Some of their contacts stick and others slide, and each hangs on all others.
TEST(Direct, SolvesBedsThatFrictionHolds) {
  int solved = 0;
  constexpr int beds = 40;
  for (std::uint64_t item = 0; item < beds; ++item) {
    Scene scene = pressed_bed(item);
    if (scene.solve(thorough_limits) != DirectOutcome::solved) continue;
    ++solved;
    EXPECT_LT(violation(scene), 1e-7) << "item " << item;
  }
  EXPECT_EQ(solved, beds);
}

TEST(Direct, ComesAfterManySweepsWhereBodiesMoveOrSolutionsFail) {
  Counters counters;
  EXPECT_EQ(sweeps_before_direct(1000, false, counters), few_sweeps);
  EXPECT_EQ(sweeps_before_direct(1000, true, counters), 200);
  EXPECT_EQ(sweeps_before_direct(60, true, counters), 50);
  EXPECT_EQ(sweeps_before_direct(12, true, counters), few_sweeps);
  EXPECT_EQ(sweeps_before_direct(5, false, counters), 5);
  counters.direct_failed = 3;
  EXPECT_EQ(sweeps_before_direct(1000, false, counters), 200);
  EXPECT_EQ(sweeps_before_direct(60, false, counters), 30);
}

TEST(Direct, IsLongWhereItsSolutionsLast) {
  Counters counters;
  EXPECT_TRUE(pays_long_solution(counters));
  counters.long_direct_failed = 3;
  EXPECT_FALSE(pays_long_solution(counters));
}

TEST(Islands, AreWhatFreeBodiesConnect) {
  Scene scene;
  scene.bodies.push_back(fixed_body());
  Random random(5, 0);
  for (int k = 0; k < 6; ++k) scene.bodies.push_back(random_body(random));
  const auto touch = [&](std::int32_t i, std::int32_t j) {
    scene.add_contact(i, j, Vec3::UnitZ(), 0, 0, {Vec3::UnitX()}, {Vec3::UnitY()});
  };
  touch(5, 6);
  touch(0, 3);
  touch(2, 5);
  touch(0, 5);
  touch(1, 3);
  Islands islands;
  islands.find(scene.contact_view(), {scene.bodies.data(), Scene::size(scene.bodies)});
  const auto list = [](ConstView<std::int32_t> view) {
    return std::vector<std::int32_t>(view.begin(), view.end());
  };
  ASSERT_EQ(islands.count(), 2);
  EXPECT_EQ(list(islands.bodies(0)), (std::vector<std::int32_t>{1, 3}));
  EXPECT_EQ(list(islands.contacts(0)), (std::vector<std::int32_t>{1, 4}));
  EXPECT_EQ(list(islands.bodies(1)), (std::vector<std::int32_t>{2, 5, 6}));
  EXPECT_EQ(list(islands.contacts(1)), (std::vector<std::int32_t>{0, 2, 3}));
  EXPECT_EQ(islands.place(5), 1);
}

}  // namespace
}  // namespace scree
