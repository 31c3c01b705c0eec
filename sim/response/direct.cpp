#include "sim/response/direct.hpp"

#include "core/tolerances.hpp"
#include "sim/response/anderson.hpp"
#include "sim/response/block_factorization.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace scree {

namespace {

/// Bounds of the penalty r, in units of the normal mass of the row. A larger r needs fewer passes, but more
/// points change their state within a pass, and the rounding errors of the impulses are larger (r times those
/// of the velocities).
constexpr double least_penalty = 1e2;
constexpr double most_penalty = 1e8;
constexpr double penalty_growth = 10;  // greatest factor of r from one pass to the next
/// Once the slips are damped, r grows by at most this factor. After a pass that leads away from the solution
/// it falls by this factor.
constexpr double damped_penalty_growth = 2;
/// After so many passes in a row that do not halve the residual, the slips are damped.
constexpr int most_stalled_passes = 10;
/// After so many such passes a solution with damped slips ends, since five of six that need more fail in the
/// end. long_limits has fewer passes, so that this bound ends the solutions of the accurate mode alone.
constexpr int most_stalled_damped_passes = 60;
/// Slips that change from one pass to the next move the impulses by r times that change. This bounds r: it is
/// the largest such move, relative to the impulses. Larger: so many points change their state that Newton's
/// method takes many more steps. Smaller: islands of boxes need more passes than there are.
constexpr double most_moved = 0.3;

constexpr int most_newton_steps = 20;      // Newton steps in a pass
constexpr int most_shortenings = 12;       // shortenings of a Newton step
constexpr double kept_slope = 0.1;         // share of the slope, reversed, that may be left after a step
constexpr double least_decrement = 1e-12;  // relative Newton decrement at which the minimum is reached

using Vector = Eigen::VectorXd;

/// The state of a contact row within a pass.
struct PassRow {
  ContactRow* row;
  const Contact* contact;
  Eigen::Index i, j;   // first unknown of each body; negative if it is not free
  double closing;      // normal velocity at the start of the pass, less the target (m/s)
  Vec3 slide;          // tangential velocity at the start of the pass (m/s)
  double slip;         // length of `slide` (m/s)
  double slip_offset;  // constant slip of the pass, less `slip` (m/s)
  Vec3 impulse;        // multiplier of the row (N s)
  Vec3 projected;      // next multiplier: the point of the cone nearest to y (see project())
  Mat3 derivative;     // derivative of `projected` by y

  /// Sets `projected` and `derivative` for y = impulse - r (u - (target - mu (slip + slip_offset)) n), where
  /// u has changed by `change` since the start of the pass. The terms are ordered so that the large r
  /// multiplies no difference of large numbers.
  void project(const Vec3& change, double r) {
    const Vec3& n = contact->normal;
    const double mu = contact->friction;
    const double pn = impulse.dot(n);
    const double cn = change.dot(n);
    const Vec3 left = impulse - pn * n - r * (change - cn * n);
    const Vec3 yt = left - r * slide;
    const double length = yt.norm();
    const double without_slip = pn - r * (closing + cn + mu * slip_offset);
    const double yn = without_slip - r * mu * slip;
    projected.setZero();
    derivative.setZero();
    if (length <= mu * yn) {
      projected = yn * n + yt;
      derivative.setIdentity();
      return;
    }
    const double excess =
        length > 0 ? left.dot(left - 2 * r * slide) / (length + r * slip) : 0.0;  // length - r slip
    const double along = (without_slip + mu * excess) / (1 + mu * mu);
    if (along <= 0) return;
    const Vec3 t = length > 0 ? Vec3(yt / length) : Vec3(Vec3::Zero());
    const Vec3 edge = n + mu * t;
    projected = along * edge;
    derivative = edge * edge.transpose() / (1 + mu * mu);
    if (mu > 0 && length > 0) {
      const Vec3 b = n.cross(t);
      derivative += (mu * along / length) * b * b.transpose();
    }
  }
};

class IslandSolver {
 public:
  IslandSolver(const IslandProblem& problem, const DirectLimits& limits)
      : problem_(problem), limits_(limits) {
    load_bodies();
    load_rows();
    lay_out_matrix();
  }

  bool is_cheap() const { return matrix_.cost() <= limits_.products; }

  DirectOutcome solve(double tolerance) {
    const ImpulseChange before = natural_residual(problem_);
    std::vector<Vec3> start;
    for (const PassRow& row : rows_) start.push_back(row.impulse);
    const ImpulseChange after = approach(before, tolerance);
    if (after.within(tolerance)) return DirectOutcome::solved;
    if (!(after.step * before.size < before.step * after.size)) {
      for (std::size_t k = 0; k < rows_.size(); ++k) rows_[k].impulse = start[k];
      store();
    }
    return DirectOutcome::failed;
  }

 private:
  Eigen::Index unknown_of(std::int32_t body) const {
    return problem_.solver[body].is_free() ? 6 * problem_.islands.place(body) : -1;
  }

  void load_bodies() {
    const auto bodies = problem_.islands.bodies(problem_.island);
    change_.resize(6 * bodies.size());
    for (std::int64_t k = 0; k < bodies.size(); ++k) {
      inertia_.push_back(problem_.solver[bodies[k]].inverse_inertia.inverse());
      for (const Guide& guide : problem_.guides) {
        if (guide.body != bodies[k]) continue;
        guides_.push_back({6 * k, guide});
        inertia_.back().setIdentity();  // any value will do, since nothing turns the body
      }
    }
  }

  /// The unknowns of a body in a guide. There are six, as for other bodies; five of them stay 0.
  struct GuidedUnknowns {
    Eigen::Index first;
    Guide guide;

    void hold(Vector& v) const {
      Vec3 along = v.segment<3>(first);
      guide.hold(along);
      v.segment<3>(first) = along;
      v.segment<3>(first + 3).setZero();
    }
  };

  const Guide* guide_at(Eigen::Index unknown) const {
    for (const GuidedUnknowns& guided : guides_)
      if (guided.first == unknown) return &guided.guide;
    return nullptr;
  }

  void load_rows() {
    for (const std::int32_t c : problem_.islands.contacts(problem_.island)) {
      const Contact& contact = problem_.contacts[c];
      for (int k = 0; k < contact.count; ++k) {
        ContactRow& row = problem_.rows[contact.first_row + k];
        rows_.push_back({.row = &row,
                         .contact = &contact,
                         .i = unknown_of(contact.i),
                         .j = unknown_of(contact.j),
                         .closing = 0,
                         .slide = Vec3::Zero(),
                         .slip = 0,
                         .slip_offset = 0,
                         .impulse = row.impulse,
                         .projected = Vec3::Zero(),
                         .derivative = Mat3::Zero()});
      }
    }
    start_pass();
    set_slips(present_slips());
  }

  /// Starts a pass from the present velocities. Its constant slips are to be set after it.
  void start_pass() {
    change_.setZero();
    for (PassRow& row : rows_) {
      const Vec3& n = row.contact->normal;
      const Vec3 u =
          row.row->relative_velocity(problem_.solver[row.contact->i], problem_.solver[row.contact->j]);
      const double un = u.dot(n);
      row.closing = un - row.row->target;
      row.slide = u - un * n;
      row.slip = row.slide.norm();
    }
  }

  /// Sets the constant slips of the pass.
  void set_slips(const Vector& slips) {
    slips_ = slips;
    Eigen::Index k = 0;
    for (PassRow& row : rows_) row.slip_offset = slips_[k++] - row.slip;
  }

  Vector present_slips() const {
    Vector slips(static_cast<Eigen::Index>(rows_.size()));
    Eigen::Index k = 0;
    for (const PassRow& row : rows_) slips[k++] = row.slip;
    return slips;
  }

  /// Returns the weights of rows whose product with the squares of slips compares as ImpulseChange::size (J).
  /// Points that do not press have none.
  Vector slip_weights() const {
    Vector weights(slips_.size());
    Eigen::Index k = 0;
    for (const PassRow& row : rows_) {
      const double mu = row.impulse.isZero(0) ? 0 : row.contact->friction;
      weights[k++] = mu * mu * row.row->normal_mass;
    }
    return weights;
  }

  /// Returns the slips at which the passes so far, of which the last one led to `image`, seem to end.
  Vector extrapolated_slips(const Vector& image) {
    return acceleration_.next(slips_, image, slip_weights()).cwiseMax(0);
  }

  void lay_out_matrix() {
    std::vector<std::pair<std::int32_t, std::int32_t>> entries;
    for (const PassRow& row : rows_) {
      if (row.i >= 0 && row.j >= 0) entries.emplace_back(block_of(row.i), block_of(row.j));
    }
    matrix_.lay_out(block_of(change_.size()), entries);
  }

  /// Returns the number of the block that an unknown begins.
  static std::int32_t block_of(Eigen::Index unknown) {
    return static_cast<std::int32_t>(unknown / BlockFactorization::size);
  }

  Vec3 change_at(const PassRow& row, const Vector& change) const {
    Vec3 u = Vec3::Zero();
    if (row.j >= 0) u += change.segment<3>(row.j) + change.segment<3>(row.j + 3).cross(row.row->arm_j);
    if (row.i >= 0) u -= change.segment<3>(row.i) + change.segment<3>(row.i + 3).cross(row.row->arm_i);
    return u;
  }

  /// Returns the gradient of the function to minimise, and sets the projections of the rows.
  Vector gradient(const Vector& change) {
    Vector g(change.size());
    const auto bodies = problem_.islands.bodies(problem_.island);
    for (std::int64_t k = 0; k < bodies.size(); ++k) {
      g.segment<3>(6 * k) = change.segment<3>(6 * k) / problem_.solver[bodies[k]].inverse_mass;
      g.segment<3>(6 * k + 3) = inertia_[static_cast<std::size_t>(k)] * change.segment<3>(6 * k + 3);
    }
    for (PassRow& row : rows_) {
      row.project(change_at(row, change), penalty_ * row.row->normal_mass);
      const Vec3 p = row.projected - row.impulse;
      if (row.i >= 0) {
        g.segment<3>(row.i) += p;
        g.segment<3>(row.i + 3) += row.row->arm_i.cross(p);
      }
      if (row.j >= 0) {
        g.segment<3>(row.j) -= p;
        g.segment<3>(row.j + 3) -= row.row->arm_j.cross(p);
      }
    }
    for (const GuidedUnknowns& guided : guides_) guided.hold(g);
    return g;
  }

  using Jacobian = Eigen::Matrix<double, 3, 6>;
  Jacobian jacobian(const Vec3& arm, Eigen::Index unknown) const {
    Jacobian j;
    if (const Guide* guide = guide_at(unknown)) {
      j << guide->axis * guide->axis.transpose(), Mat3::Zero();
      return j;
    }
    j << Mat3::Identity(), Mat3::Zero();
    j.col(3) = Vec3::UnitX().cross(arm);
    j.col(4) = Vec3::UnitY().cross(arm);
    j.col(5) = Vec3::UnitZ().cross(arm);
    return j;
  }

  /// Factorizes the Hessian, with the derivatives of the rows that gradient() has set. Returns whether it
  /// could be done.
  bool factorize() {
    matrix_.clear();
    const auto bodies = problem_.islands.bodies(problem_.island);
    for (std::int64_t k = 0; k < bodies.size(); ++k) {
      BlockFactorization::Block mass = BlockFactorization::Block::Zero();
      mass.topLeftCorner<3, 3>() = Mat3::Identity() / problem_.solver[bodies[k]].inverse_mass;
      mass.bottomRightCorner<3, 3>() = inertia_[static_cast<std::size_t>(k)];
      matrix_.add(static_cast<std::int32_t>(k), static_cast<std::int32_t>(k), mass);
    }
    for (const PassRow& row : rows_) {
      const Mat3 a = penalty_ * row.row->normal_mass * row.derivative;
      if (a.isZero(0)) continue;
      const Jacobian ji = jacobian(row.row->arm_i, row.i);
      const Jacobian jj = jacobian(row.row->arm_j, row.j);
      const std::int32_t i = block_of(row.i), j = block_of(row.j);
      if (row.i >= 0) matrix_.add(i, i, ji.transpose() * a * ji);
      if (row.j >= 0) matrix_.add(j, j, jj.transpose() * a * jj);
      if (row.i >= 0 && row.j >= 0) matrix_.add(i, j, -ji.transpose() * a * jj);
    }
    ++factorizations_;
    return matrix_.factorize();
  }

  /// Makes passes of the multipliers, each with the penalty that the one before it allows. Leaves the
  /// impulses of the last pass in the problem, and returns the residual that is left.
  ImpulseChange approach(ImpulseChange residual, double tolerance) {
    const double accuracy = residual.step > 0 ? std::sqrt(residual.size / residual.step) : most_penalty;
    penalty_ = std::clamp(accuracy, least_penalty, most_penalty);
    for (int pass = 0; pass < limits_.passes && can_go_on(); ++pass) {
      if (!minimise()) {
        penalty_ /= penalty_growth;
        change_.setZero();
        continue;
      }
      for (PassRow& row : rows_) row.impulse = row.projected;
      store();
      const ImpulseChange last = residual;
      residual = natural_residual(problem_);
      if (residual.within(tolerance::direct_share * tolerance)) break;
      const bool is_nearer = residual.step * last.size <= last.step * residual.size;
      damp_if_stalled(residual);
      if (stalled_passes_ > most_stalled_damped_passes) break;
      start_pass();
      prepare_pass(is_nearer);
    }
    return residual;
  }

  /// Judges whether the iteration of the slips still converges. In packings that hold each other by friction
  /// it may amplify some change of the slips and turn it round; each slip then moves half the way, by which
  /// such changes decay.
  void damp_if_stalled(const ImpulseChange& residual) {
    constexpr double quarter = 0.25;  // of the squares
    if (residual.step < quarter * least_residual_ * residual.size) {
      least_residual_ = residual.step / residual.size;
      stalled_passes_ = 0;
    } else if (++stalled_passes_ > most_stalled_passes && !damped_) {
      damped_ = true;
      acceleration_.forget();
    }
  }

  /// Sets the slips and the penalty of the pass that start_pass() has started. `is_nearer`: the pass before
  /// it has led nearer to the solution.
  void prepare_pass(bool is_nearer) {
    const Vector old_slips = slips_;
    const Vector half_way = 0.5 * (slips_ + present_slips());
    if (!is_nearer) acceleration_.forget();
    if (damped_) {
      set_slips(extrapolated_slips(half_way));
      penalty_ *= is_nearer ? damped_penalty_growth : 1 / damped_penalty_growth;
    } else if (is_nearer) {
      set_slips(extrapolated_slips(present_slips()));
      penalty_ *= penalty_growth;
    } else {
      // The slips may oscillate about their solution.
      set_slips(half_way);
    }
    const double moved = (slips_ - old_slips).cwiseAbs2().dot(slip_weights());
    const double bound = moved > 0 ? most_moved * std::sqrt(size() / moved) : most_penalty;
    penalty_ = std::min(penalty_, std::clamp(bound, least_penalty, most_penalty));
  }

  bool can_go_on() const { return factorizations_ * matrix_.cost() <= limits_.products_in_all; }

  /// Minimises the function by Newton's method. Since it is convex, a step goes too far where the slope along
  /// it has changed sign; it is then shortened until little of that slope is left. Returns false if the
  /// minimum is not reached.
  bool minimise() {
    Vector g = gradient(change_);
    for (int step = 0; step < most_newton_steps && can_go_on(); ++step) {
      if (!factorize()) return false;
      const Vector direction = matrix_.solve(-g);
      const double slope = g.dot(direction);
      if (!(slope < 0)) return true;
      double length = 1;
      Vector next = change_ + direction;
      g = gradient(next);
      for (int shortening = 0; shortening < most_shortenings; ++shortening) {
        const double end_slope = g.dot(direction);
        if (end_slope <= -kept_slope * slope) break;
        length *= std::clamp(slope / (slope - end_slope), 0.1, 0.9);
        next = change_ + length * direction;
        g = gradient(next);
      }
      change_ = next;
      if (-slope <= least_decrement * least_decrement * size()) return true;
    }
    return false;
  }

  /// Returns the size of the impulses that gradient() has found, as ImpulseChange::size (J).
  double size() const {
    double sum = 0;
    for (const PassRow& row : rows_) sum += row.projected.squaredNorm() / row.row->normal_mass;
    return sum;
  }

  void store() {
    for (const PassRow& row : rows_) row.row->impulse = row.impulse;
    for (const std::int32_t body : problem_.islands.bodies(problem_.island)) {
      problem_.solver[body].velocity = problem_.velocity[body];
      problem_.solver[body].spin = problem_.spin[body];
    }
    for (const std::int32_t c : problem_.islands.contacts(problem_.island)) {
      const Contact& contact = problem_.contacts[c];
      for (int k = 0; k < contact.count; ++k) {
        const ContactRow& row = problem_.rows[contact.first_row + k];
        row.push(row.impulse, problem_.solver[contact.i], problem_.solver[contact.j]);
      }
    }
    for (const GuidedUnknowns& guided : guides_)
      guided.guide.hold(problem_.solver[guided.guide.body].velocity);
  }

  const IslandProblem& problem_;
  const DirectLimits& limits_;
  std::vector<PassRow> rows_;
  std::vector<Mat3> inertia_;           // inertia of each body, world frame
  std::vector<GuidedUnknowns> guides_;  // unknowns of bodies in guides
  Vector slips_;                        // constant slip of each row in a pass (m/s)
  AndersonAcceleration acceleration_;   // of the slips, from pass to pass
  Vector change_;                       // change of the velocities in a pass
  BlockFactorization matrix_;           // Hessian; a block of unknowns for each body
  double penalty_ = 0;                  // r divided by the normal mass
  int factorizations_ = 0;
  double least_residual_ = HUGE_VAL;  // least relative residual so far, squared, as it was last halved
  int stalled_passes_ = 0;            // passes since then
  bool damped_ = false;               // whether slips move half the way
};

}  // namespace

ImpulseChange natural_residual(const IslandProblem& problem) {
  ImpulseChange residual;
  for (const std::int32_t c : problem.islands.contacts(problem.island)) {
    const Contact& contact = problem.contacts[c];
    residual = residual + natural_residual(contact, &problem.rows[contact.first_row],
                                           problem.solver[contact.i], problem.solver[contact.j]);
  }
  return residual;
}

DirectOutcome solve_directly(const IslandProblem& problem, double tolerance, const DirectLimits& limits) {
  IslandSolver solver(problem, limits);
  return solver.is_cheap() ? solver.solve(tolerance) : DirectOutcome::not_tried;
}

namespace {

/// Returns whether no more than two solutions, and one for each `solved_per_failure` that succeeded, have
/// failed, so that further ones are worth their time.
bool mostly_succeed(std::int64_t solved, std::int64_t failed, std::int64_t solved_per_failure) {
  constexpr std::int64_t failures_to_start = 2;
  return failed <= failures_to_start + solved / solved_per_failure;
}

}  // namespace

bool pays_long_solution(const Counters& counters) {
  constexpr std::int64_t solved_per_failure = 20;
  return mostly_succeed(counters.long_direct, counters.long_direct_failed, solved_per_failure);
}

int sweeps_before_direct(int most, bool moves, const Counters& counters) {
  constexpr int many_sweeps = 200;
  constexpr std::int64_t solved_per_failure = 4;
  // A few sweeps are left to come after it.
  if (moves) return std::min(most, std::clamp(most - few_sweeps, few_sweeps, many_sweeps));
  const int sweeps = mostly_succeed(counters.direct, counters.direct_failed, solved_per_failure)
                         ? few_sweeps
                         : std::clamp(most / 2, few_sweeps, many_sweeps);
  return std::min(most, sweeps);
}

}  // namespace scree
