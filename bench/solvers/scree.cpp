// scree's own solvers on a captured problem: the code that simulations run, from no impulses at all.
#include "bench/solvers/solver.hpp"
#include "sim/dynamics/direct.hpp"
#include "sim/dynamics/response.hpp"

#include <cmath>
#include <utility>

namespace scree::bench {

namespace {

/// The problem in the arrays of the response, with coloured contacts and prepared rows.
class Replay {
 public:
  explicit Replay(const ContactProblem& scene) : scene_(scene) {
    const auto bodies = static_cast<std::int64_t>(scene.bodies.size());
    solver_.resize(bodies);
    velocity_.resize(bodies);
    spin_.resize(bodies);
    load_contacts();
    reset();
  }

  /// Takes all impulses away.
  void reset() {
    for (std::int64_t k = 0; k < solver_.size(); ++k) {
      const ContactProblem::Body& body = scene_.bodies[static_cast<std::size_t>(k)];
      solver_.view()[k] = {body.velocity, body.spin, body.inverse_mass, body.inverse_inertia};
      velocity_.view()[k] = body.velocity;
      spin_.view()[k] = body.spin;
    }
    for (ContactRow& row : set_.rows.view()) row.impulse.setZero();
  }

  /// Of the step's length only positions would know.
  SolveStage stage() {
    return {.manifolds = {},
            .bodies = {},
            .solver = solver_.view(),
            .contacts = set_.contacts.view(),
            .rows = set_.rows.view(),
            .change = {},
            .free_velocity = velocity_.view(),
            .free_spin = spin_.view(),
            .step = 0};
  }
  ContactSet& set() { return set_; }

  PointVectors impulses() const {
    PointVectors impulses(frames_.size());
    for (std::size_t k = 0; k < frames_.size(); ++k)
      impulses[k] = frames_[k].transpose() * set_.rows.view()[static_cast<std::int64_t>(k)].impulse;
    return impulses;
  }

 private:
  void load_contacts() {
    std::vector<Mobility> mobility;
    for (const ContactProblem::Body& body : scene_.bodies)
      mobility.push_back(body.inverse_mass > 0 ? Mobility::free : Mobility::fixed);
    std::vector<ManifoldHeader> headers;
    set_.contacts.resize(static_cast<std::int64_t>(scene_.contacts.size()));
    set_.rows.resize(static_cast<std::int64_t>(scene_.points.size()));
    for (const ContactProblem::Contact& c : scene_.contacts) {
      set_.contacts.view()[std::ssize(headers)] = contact_of(c);
      load_rows(c);
      ManifoldHeader& header = headers.emplace_back();
      header.i = c.i;
      header.j = c.j;
    }
    color_contacts(BallPairs(), {headers.data(), std::ssize(headers)},
                   {mobility.data(), std::ssize(mobility)}, set_.coloring);
  }

  Contact contact_of(const ContactProblem::Contact& c) const {
    const ContactProblem::Body& i = scene_.bodies[static_cast<std::size_t>(c.i)];
    const ContactProblem::Body& j = scene_.bodies[static_cast<std::size_t>(c.j)];
    const auto turns_as_ball = [](const ContactProblem::Body& body) {
      return body.inverse_mass > 0 || body.spin.isZero(0);
    };
    Contact contact{};
    contact.i = c.i;
    contact.j = c.j;
    contact.first_row = c.first_point;
    contact.count = c.count;
    contact.balls = c.balls;
    contact.aligned = c.balls && turns_as_ball(i) && turns_as_ball(j);
    contact.free_ends = static_cast<std::int8_t>((i.inverse_mass > 0) + (j.inverse_mass > 0));
    contact.normal = c.normal;
    contact.friction = c.friction;
    return contact;
  }

  void load_rows(const ContactProblem::Contact& c) {
    const auto solver_body = [&](std::int32_t k) {
      const ContactProblem::Body& body = scene_.bodies[static_cast<std::size_t>(k)];
      return SolverBody{body.velocity, body.spin, body.inverse_mass, body.inverse_inertia};
    };
    for (std::int64_t p = c.first_point; p < c.first_point + c.count; ++p) {
      const ContactProblem::Point& point = scene_.points[static_cast<std::size_t>(p)];
      const SolverBody i = solver_body(c.i);
      const SolverBody j = solver_body(c.j);
      frames_.push_back(frame_of(c));
      ContactRow& row = set_.rows.view()[p];
      RowCoupling coupling;  // the sweeps make their own
      row = c.balls ? make_ball_row(point.arm_i, point.arm_j, 0, i, j)
                    : make_row(c.normal, point.arm_i, point.arm_j, 0, i, j, coupling);
      row.target = point.target;
    }
  }

  const ContactProblem& scene_;
  Array<SolverBody, Host> solver_;
  Array<Vec3, Host> velocity_, spin_;
  ContactSet set_;
  std::vector<Mat3> frames_;  // of each point
};

class SweepsAlone : public Solver {
 public:
  SweepsAlone(const ContactProblem& scene, int block_sweeps) : replay_(scene), block_sweeps_(block_sweeps) {}

  Budget budget() const override { return Budget::iterations; }

  PointVectors solve(double budget) override {
    replay_.reset();
    const int count = static_cast<int>(budget);
    const SweepPlan plan{.least = count,
                         .most = count,
                         .block_sweeps = block_sweeps_,
                         .tolerance = 0,
                         .direct = false,
                         .smooth = false};
    std::int64_t done = 0;
    sweeps_.load(replay_.stage(), replay_.set().coloring, replay_.set().batches);
    sweeps_.set_velocities();
    sweeps_.run(plan, count, done);
    return replay_.impulses();
  }

 private:
  Replay replay_;
  Sweeps sweeps_;
  int block_sweeps_;
};

/// Island by island, with the bounds of the accurate mode; an island too large for them is left without
/// impulses.
class DirectAlone : public Solver {
 public:
  explicit DirectAlone(const ContactProblem& scene) : replay_(scene) {}

  Budget budget() const override { return Budget::tolerance; }

  PointVectors solve(double budget) override {
    replay_.reset();
    const SolveStage stage = replay_.stage();
    islands_.find(stage.contacts, stage.solver);
    for (std::int64_t island = 0; island < islands_.count(); ++island) {
      solve_directly({.contacts = stage.contacts,
                      .rows = stage.rows,
                      .solver = stage.solver,
                      .velocity = stage.free_velocity,
                      .spin = stage.free_spin,
                      .islands = islands_,
                      .island = island},
                     budget, thorough_limits);
    }
    return replay_.impulses();
  }

 private:
  Replay replay_;
  Islands islands_;
};

class Response : public Solver {
 public:
  Response(const ContactProblem& scene, bool accurate) : replay_(scene), accurate_(accurate) {}

  Budget budget() const override { return Budget::tolerance; }

  PointVectors solve(double budget) override {
    replay_.reset();
    ResponseParameters parameters;
    parameters.accurate = accurate_;
    parameters.tolerance = budget;
    Counters counters;
    response_.find_impulses(replay_.stage(), parameters, replay_.set(), counters);
    return replay_.impulses();
  }

 private:
  Replay replay_;
  ResponseSolver response_;
  bool accurate_;
};

}  // namespace

std::unique_ptr<Solver> make_scree_sweeps(const ContactProblem& scene, int block_sweeps) {
  return std::make_unique<SweepsAlone>(scene, block_sweeps);
}
std::unique_ptr<Solver> make_scree_direct(const ContactProblem& scene) {
  return std::make_unique<DirectAlone>(scene);
}
std::unique_ptr<Solver> make_scree_response(const ContactProblem& scene, bool accurate) {
  return std::make_unique<Response>(scene, accurate);
}

}  // namespace scree::bench
