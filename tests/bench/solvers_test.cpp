// Tests of contact problems that are taken out of simulations, against dense matrices in long double; of the
// residual, against known solutions; and of the solvers, against the laws of contact.
#include "bench/solvers/local_problem.hpp"
#include "bench/solvers/problem_file.hpp"
#include "bench/solvers/residual.hpp"
#include "bench/solvers/solver.hpp"
#include "core/error.hpp"
#include "core/rng.hpp"
#include "core/tolerances.hpp"
#include "sim/step/simulation.hpp"

#include <Eigen/Core>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace scree::bench {
namespace {

using Real = long double;
using RealVec = Eigen::Matrix<Real, 3, 1>;
using RealVector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;
using RealMatrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;

/// Returns the contact problem of a scene after one step on one thread.
ContactProblem problem_of(const std::string& text) {
  Simulation simulation(parse_scene("format: 1\nrender: false\n" + text, "test.yaml"),
                        {SpaceChoice::host, 1});
  simulation.step();
  return simulation.contact_problem();
}

const char* const ball = R"(
gravity: [0, 0, -9.81]
time: {end: 1, step: 0.01}
materials: {stone: {density: 1000, friction: 0.5}}
bodies:
  - {plane: {normal: [0, 0, 1]}, material: stone}
  - {sphere: {radius: 0.5}, mass: 3, at: [0, 0, 0.5], material: stone}
)";

/// Boxes across a sliding one, and balls on them, one of which pushes on a moving wall.
const char* const heap = R"(
gravity: [0.3, 0.2, -9.81]
time: {end: 1, step: 0.005}
materials: {stone: {density: 1000, friction: 0.4}}
bodies:
  - {plane: {normal: [0, 0, 1]}, material: stone}
  - {box: {size: [2, 1, 0.5]}, at: [0, 0, 0.25], velocity: [1, 0.5, 0], material: stone}
  - {box: {size: [0.4, 1, 0.3]}, at: [-0.7, 0.1, 0.65], rotate: {axis: [0, 0, 1], degrees: 20}, material: stone}
  - {box: {size: [0.5, 1, 0.3]}, at: [0.6, 0, 0.65], rotate: {axis: [0, 0, 1], degrees: -5}, material: stone}
  - {box: {size: [2.5, 0.3, 0.2]}, mass: 2000, at: [0, 0, 0.9], material: stone}
  - {sphere: {radius: 0.2}, at: [0.2, 0, 1.2], material: stone}
  - {sphere: {radius: 0.2}, at: [0.6, 0, 1.2], spin: [0, 3, 0], material: stone}
  - {box: {size: [0.2, 1, 1]}, at: [0.9, 0, 1.5], motion: {velocity: [-0.1, 0, 0]}, material: stone}
)";

/// Returns the matrix J that gives the relative velocity of each point, in the frame of its contact, from the
/// velocities and spins of all bodies.
RealMatrix jacobian_of(const ContactProblem& scene) {
  RealMatrix j = RealMatrix::Zero(3 * std::ssize(scene.points), 6 * std::ssize(scene.bodies));
  for (const ContactProblem::Contact& c : scene.contacts) {
    const Mat3 frame = frame_of(c);
    for (std::int64_t p = c.first_point; p < c.first_point + c.count; ++p) {
      const ContactProblem::Point& point = scene.points[static_cast<std::size_t>(p)];
      for (int d = 0; d < 3; ++d) {
        const RealVec axis = frame.col(d).cast<Real>();
        j.block<1, 3>(3 * p + d, 6 * c.i) = -axis.transpose();
        j.block<1, 3>(3 * p + d, 6 * c.i + 3) = -point.arm_i.cast<Real>().cross(axis).transpose();
        j.block<1, 3>(3 * p + d, 6 * c.j) = axis.transpose();
        j.block<1, 3>(3 * p + d, 6 * c.j + 3) = point.arm_j.cast<Real>().cross(axis).transpose();
      }
    }
  }
  return j;
}

RealMatrix inverse_masses_of(const ContactProblem& scene) {
  RealMatrix m = RealMatrix::Zero(6 * std::ssize(scene.bodies), 6 * std::ssize(scene.bodies));
  for (std::int64_t k = 0; k < std::ssize(scene.bodies); ++k) {
    const ContactProblem::Body& body = scene.bodies[static_cast<std::size_t>(k)];
    m.block<3, 3>(6 * k, 6 * k).diagonal().setConstant(body.inverse_mass);
    m.block<3, 3>(6 * k + 3, 6 * k + 3) = body.inverse_inertia.cast<Real>();
  }
  return m;
}

RealMatrix dense(const BlockMatrix& matrix) {
  const auto size = 3 * static_cast<Eigen::Index>(matrix.size());
  RealMatrix all = RealMatrix::Zero(size, size);
  for (std::size_t row = 0; row < matrix.size(); ++row) {
    for (const BlockMatrix::Block* b = matrix.begin(row); b != matrix.end(row); ++b)
      all.block<3, 3>(3 * static_cast<Eigen::Index>(row), 3 * b->column) = b->value.cast<Real>();
  }
  return all;
}

double natural_of(const Problem& problem, const PointVectors& impulses) {
  return ResidualMeter(problem)(impulses).natural;
}

TEST(ContactProblem, IsEmptyBeforeTheFirstStep) {
  const Simulation simulation(parse_scene(std::string("format: 1\nrender: false\n") + ball, "test.yaml"),
                              {SpaceChoice::host, 1});
  EXPECT_TRUE(simulation.contact_problem().points.empty());
}

TEST(ContactProblem, HasTheMassesOfTheScene) {
  const ContactProblem scene = problem_of(ball);
  ASSERT_EQ(scene.bodies.size(), 2u);
  EXPECT_EQ(scene.bodies[0].inverse_mass, 0);
  EXPECT_EQ(scene.bodies[1].inverse_mass, 1.0 / 3);
  EXPECT_NEAR(scene.bodies[1].inverse_inertia(0, 0), 1 / (0.4 * 3 * 0.25), 1e-14);
  EXPECT_NEAR(scene.bodies[1].velocity.z(), -9.81 * 0.01, 1e-15);
}

TEST(ContactProblem, DelassusIsSymmetricAndThatOfDenseMatrices) {
  const ContactProblem scene = problem_of(heap);
  ASSERT_GE(scene.points.size(), 15u);
  const RealMatrix w = dense(assemble(scene).delassus);
  EXPECT_EQ((w - w.transpose()).norm(), 0);
  const RealMatrix j = jacobian_of(scene);
  const RealMatrix expected = j * inverse_masses_of(scene) * j.transpose();
  EXPECT_LT((w - expected).cwiseAbs().maxCoeff(), 1e-15 * expected.cwiseAbs().maxCoeff());
}

TEST(ContactProblem, FreeVelocityIsThatOfTheBodiesLessTheTargets) {
  const ContactProblem scene = problem_of(heap);
  const Problem problem = assemble(scene);
  RealVector v(6 * std::ssize(scene.bodies));
  for (std::int64_t k = 0; k < std::ssize(scene.bodies); ++k) {
    v.segment<3>(6 * k) = scene.bodies[static_cast<std::size_t>(k)].velocity.cast<Real>();
    v.segment<3>(6 * k + 3) = scene.bodies[static_cast<std::size_t>(k)].spin.cast<Real>();
  }
  const RealVector u = jacobian_of(scene) * v;
  for (std::size_t k = 0; k < problem.size(); ++k) {
    RealVec q = u.segment<3>(3 * static_cast<Eigen::Index>(k));
    q.x() -= scene.points[k].target;
    EXPECT_LT((problem.free_velocity[k].cast<Real>() - q).norm(), 1e-15) << k;
  }
}

TEST(Residual, OfABallAtRestIsRounding) {
  const ContactProblem scene = problem_of(ball);
  const Problem problem = assemble(scene);
  ASSERT_EQ(problem.size(), 1u);
  const Residual exact = ResidualMeter(problem)({Vec3(3 * 9.81 * 0.01, 0, 0)});  // m g h carries the ball
  EXPECT_LT(exact.natural, 1e-15);
  EXPECT_LT(exact.signorini, 1e-15);
  EXPECT_LE(exact.cone, 0);
  EXPECT_LT(natural_of(problem, impulses_of(scene)), 1e-15);
  EXPECT_NEAR(natural_of(problem, {Vec3::Zero()}), 1, 1e-15);
}

TEST(Residual, IsWhatTheAccurateModeBringsDown) {
  const ContactProblem scene = problem_of(std::string(heap) + "response: {mode: accurate}\n");
  EXPECT_LT(natural_of(assemble(scene), impulses_of(scene)), 1e-9);
}

TEST(Residual, ProjectsOnTheNearestPointOfTheCone) {
  for (std::uint64_t item = 0; item < 1000; ++item) {
    Random random(41, item);
    const double mu = item % 5 == 0 ? 0.0 : random.uniform(0, 2);
    const Vec3 x(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    const Vec3 p = project_on_friction_cone(x, mu);
    const Vec3 back = p - x;
    // The projection is in the cone; the difference to x is in the dual cone and orthogonal to it.
    EXPECT_LE(std::hypot(p.y(), p.z()), mu * p.x() + 1e-15);
    EXPECT_LE(mu * std::hypot(back.y(), back.z()), back.x() + 1e-15);
    EXPECT_NEAR(p.dot(back), 0, 1e-15);
  }
}

TEST(LocalProblem, ObeysTheLawsOfContact) {
  int slipping = 0;
  for (std::uint64_t item = 0; item < 2000; ++item) {
    Random random(43, item);
    Mat3 root;
    for (double& entry : root.reshaped()) entry = random.uniform(-1, 1);
    const Mat3 w = root * root.transpose() + 0.01 * Mat3::Identity();
    const Vec3 q(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    const double mu = item % 7 == 0 ? 0.0 : random.uniform(0, 1.5);
    const Vec3 r = LocalProblem(w, mu).solve(q);
    const Vec3 u = w * r + q;
    const double rt = std::hypot(r.y(), r.z());
    EXPECT_GE(r.x(), 0) << item;
    EXPECT_LE(rt, mu * r.x() * (1 + 1e-14)) << item;
    EXPECT_GE(u.x(), -1e-11) << item;
    EXPECT_NEAR(r.x() * u.x(), 0, 1e-10) << item;
    if (r.x() == 0 || u.tail<2>().norm() < 1e-9) continue;
    ++slipping;
    EXPECT_NEAR(r.tail<2>().dot(u.tail<2>()), -mu * r.x() * u.tail<2>().norm(), 1e-9 * (1 + r.squaredNorm()))
        << item;
  }
  EXPECT_GT(slipping, 500);
}

TEST(ProblemFile, ReadsBackTheSameBits) {
  const auto file = std::filesystem::temp_directory_path() / "scree_solvers_test.mtx";
  const ContactProblem scene = problem_of(heap);
  const ProblemFile written{scene, assemble(scene)};
  write_problem(file, written);
  const ProblemFile read = read_problem(file);
  std::filesystem::remove(file);
  EXPECT_EQ(dense(read.problem.delassus), dense(written.problem.delassus));
  EXPECT_EQ(read.problem.delassus.count(), written.problem.delassus.count());
  EXPECT_EQ(read.problem.free_velocity, written.problem.free_velocity);
  EXPECT_EQ(read.problem.friction, written.problem.friction);
  // The scene that the problem came from is read back, too.
  const Problem again = assemble(read.scene);
  EXPECT_EQ(dense(again.delassus), dense(written.problem.delassus));
  EXPECT_EQ(again.free_velocity, written.problem.free_velocity);
  EXPECT_EQ(impulses_of(read.scene), impulses_of(scene));
}

TEST(ProblemFile, NamesTheLineThatIsWrong) {
  const auto file = std::filesystem::temp_directory_path() / "scree_solvers_broken.mtx";
  std::ofstream(file) << "%%MatrixMarket matrix coordinate real symmetric\n% W\n3 3 6\n1 1 x\n";
  try {
    read_problem(file);
    ADD_FAILURE() << "read";
  } catch (const InputError& error) {
    EXPECT_NE(std::strstr(error.what(), ".mtx:4: expected a number"), nullptr) << error.what();
  }
  std::filesystem::remove(file);
}

/// The solutions may differ, because with friction there may be several.
TEST(Solvers, AllFindASolution) {
  const ContactProblem scene = problem_of(heap);
  const Problem problem = assemble(scene);
  for (const std::string& name : solver_names()) {
    const auto solver = make_solver(name, scene, problem);
    const PointVectors r = solver->solve(solver->budget() == Solver::Budget::iterations ? 20000 : 1e-12);
    // Solvers of first order converge slowly in the last digits.
    EXPECT_LT(natural_of(problem, r), 1e-6) << name;
  }
  EXPECT_THROW(make_solver("oracle", scene, problem), InputError);
}

/// The solver visits the contacts in another order than the run; the impulses of both solve the problem.
TEST(Solvers, TheResponseSolvesWhatARunHasSolved) {
  const ContactProblem scene = problem_of(std::string(heap) + "response: {warm_start: false}\n");
  const Problem problem = assemble(scene);
  const PointVectors replayed =
      make_solver("scree-default", scene, problem)->solve(tolerance::response_change);
  EXPECT_LT(natural_of(problem, replayed), 1e-8);
  EXPECT_LT(natural_of(problem, impulses_of(scene)), 1e-8);
}

}  // namespace
}  // namespace scree::bench
