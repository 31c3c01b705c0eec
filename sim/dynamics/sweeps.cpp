#include "sim/dynamics/sweeps.hpp"

#include "core/parallel_loops.hpp"
#include "sim/dynamics/lanes/colored.hpp"

#include <algorithm>
#include <utility>

namespace scree {

namespace {

// Of batches where nothing rolls, `rolling` is empty.

struct PushBalls {
  ConstView<lanes::BallBatch> batches;
  ConstView<lanes::Rolling> rolling;
  View<lanes::Body> bodies;
  void operator()(std::int64_t b) const {
    lanes::kernels().push_balls(batches[b], bodies.data());
    if (rolling.size() > 0) lanes::kernels().push_rolling_balls(batches[b], rolling[b], bodies.data());
  }
};

struct PushPoints {
  ConstView<lanes::PointBatch> batches;
  ConstView<lanes::PointRow> rows;
  ConstView<lanes::Rolling> rolling;
  View<lanes::Body> bodies;
  void operator()(std::int64_t first, int count) const {
    for (std::int64_t b = first; b < first + count; ++b) {
      lanes::kernels().push_points(batches[b], &rows[batches[b].first_row], bodies.data());
      if (rolling.size() > 0) lanes::kernels().push_rolling_points(batches[b], rolling[b], bodies.data());
    }
  }
};

struct SweepBalls {
  decltype(lanes::SweepKernels::balls) kernel;
  View<lanes::BallBatch> batches;
  View<lanes::Rolling> rolling;
  View<lanes::Body> bodies;
  double beta;
  lanes::Change* change;
  void operator()(std::int64_t b) const {
    change[b] = kernel(batches[b], bodies.data(), beta);
    if (rolling.size() > 0)
      change[b] = change[b] + lanes::kernels().roll_balls(batches[b], rolling[b], bodies.data(), beta);
  }
};

struct SweepPoints {
  decltype(lanes::SweepKernels::points) kernel;
  ConstView<lanes::PointBatch> batches;
  View<lanes::PointRow> rows;
  View<lanes::Rolling> rolling;
  View<lanes::Body> bodies;
  double beta;
  int block_sweeps;
  lanes::Change* change;
  void operator()(std::int64_t first, int count) const {
    kernel(&batches[first], count, rows.data(), bodies.data(), beta, block_sweeps, change + first);
    if (rolling.size() == 0) return;
    for (std::int64_t b = first; b < first + count; ++b) {
      change[b] = change[b] + lanes::kernels().roll_points(batches[b], &rows[batches[b].first_row],
                                                           rolling[b], bodies.data(), beta);
    }
  }
};

struct LoadChange {
  ConstView<lanes::Change> change;
  SCREE_HD ImpulseChange operator()(std::int64_t b) const { return {change[b].step, change[b].size}; }
};

/// Velocities are linear in the impulses: what beta does to these it does to them.
struct Accelerate {
  static constexpr std::int64_t chunk = 128;
  View<lanes::Body> bodies;
  lanes::Body* last;
  double beta;
  void operator()(std::int64_t c) const {
    const std::int64_t first = c * chunk;
    lanes::kernels().accelerate(bodies.data() + first, last + first, std::min(chunk, bodies.size() - first),
                                beta);
  }
};

}  // namespace

/// Bodies without contacts.
struct Sweeps::Release {
  SolveStage stage;
  View<lanes::Body> free;
  void operator()(std::int64_t k) const {
    if (k == stage.solver.size()) {
      free[k] = {Vec3::Zero(), 0, Vec3::Zero(), 0};
      return;
    }
    free[k] = {stage.free_velocity[k], stage.solver[k].inverse_mass, stage.free_spin[k],
               stage.solver[k].inverse_inertia(0, 0)};
  }
};

struct Sweeps::StoreVelocities {
  SolveStage stage;
  ConstView<lanes::Body> bodies;
  void operator()(std::int64_t k) const {
    stage.solver[k].velocity = bodies[k].velocity;
    stage.solver[k].spin = bodies[k].spin;
  }
};

void Sweeps::load(const SolveStage& stage, const Coloring& coloring, lanes::Batches& batches) {
  stage_ = stage;
  batches_ = &batches;
  const auto nobody = static_cast<std::int32_t>(stage.solver.size());
  free_.resize(nobody + 1);
  parallel::for_each<Host>("response.release", free_.size(), Release{stage, free_.view()});
  lanes::arrange(coloring, stage.contacts, nobody, stage.rolls, batches);
  if (stage.balls != nullptr) stage.balls->put_into(stage.warm_start, batches);
  lanes::load(stage.contacts, stage.rows, stage.couples, stage.solver, free_.data(), stage.pairs, batches);
  change_.resize(batches.balls.size() + batches.points.size());
}

void Sweeps::take_impulses() { lanes::take_impulses(stage_->rows, *batches_); }

void Sweeps::set_velocities() {
  copy(bodies_, free_);
  lanes::for_each_color("response.push", *batches_,
                        PushBalls{batches_->balls.view(), batches_->ball_rolling.view(), bodies_.view()},
                        PushPoints{batches_->points.view(), batches_->rows.view(),
                                   batches_->point_rolling.view(), bodies_.view()});
  hold_to_guides();
}

/// The contacts take a body in a guide for a free one: what they agree on then is what holds for it.
void Sweeps::hold_to_guides() {
  for (const Guide& guide : stage_->guides) guide.hold(bodies_.view()[guide.body].velocity);
}

void Sweeps::store_velocities() const {
  parallel::for_each<Host>("response.velocities", stage_->solver.size(),
                           StoreVelocities{*stage_, bodies_.view()});
}

namespace {

/// Halfway between before the kick and now.
struct LoadMean {
  SolveStage stage;
  ConstView<lanes::Body> bodies;
  View<lanes::Body> mean;
  void operator()(std::int64_t k) const {
    mean[k] = bodies[k];
    if (k == stage.solver.size() || !stage.solver[k].is_free()) return;
    mean[k].velocity = 0.5 * (mean[k].velocity + stage.bodies.velocity[k]);
    mean[k].spin = 0.5 * (mean[k].spin + stage.bodies.spin[k]);
  }
};

struct BookBalls {
  ConstView<lanes::BallBatch> batches;
  ConstView<lanes::Rolling> rolling;
  const lanes::Body* mean;
  lanes::Losses* losses;
  void operator()(std::int64_t b) const {
    lanes::kernels().book_balls(batches[b], mean, losses[b]);
    if (rolling.size() > 0) lanes::kernels().book_rolling(batches[b].ends, rolling[b], mean, losses[b]);
  }
};
struct BookPoints {
  ConstView<lanes::PointBatch> batches;
  ConstView<lanes::PointRow> rows;
  ConstView<lanes::Rolling> rolling;
  const lanes::Body* mean;
  lanes::Losses* losses;
  void operator()(std::int64_t b) const {
    lanes::kernels().book_points(batches[b], &rows[batches[b].first_row], mean, losses[b]);
    if (rolling.size() > 0) lanes::kernels().book_rolling(batches[b].ends, rolling[b], mean, losses[b]);
  }
};

struct LoadBooks {
  ConstView<lanes::Losses> losses;
  SCREE_HD lanes::Books operator()(std::int64_t b) const { return losses[b].books; }
};

}  // namespace

lanes::Books Sweeps::book(Array<lanes::Losses, Host>& losses) {
  losses.resize(batches_->balls.size() + batches_->points.size());
  last_.resize(bodies_.size());
  parallel::for_each<Host>("response.mean", bodies_.size(),
                           LoadMean{*stage_, std::as_const(bodies_).view(), last_.view()});
  lanes::for_each_batch(
      "response.books", *batches_,
      BookBalls{batches_->balls.view(), batches_->ball_rolling.view(), last_.data(), losses.data()},
      BookPoints{batches_->points.view(), batches_->rows.view(), batches_->point_rolling.view(), last_.data(),
                 losses.data() + batches_->balls.size()});
  return parallel::sum<lanes::Books, Host>("response.books", losses.size(),
                                           LoadBooks{std::as_const(losses).view()});
}

lanes::Lane Sweeps::square_of(std::int64_t batch) const {
  lanes::Lane square;
  const std::int64_t balls = batches_->balls.size();
  if (batch < balls) {
    const lanes::BallBatch& of = batches_->balls.view()[batch];
    lanes::kernels().square_of_balls(of, free_.data(), bodies_.data(), square);
    if (batches_->rolls())
      lanes::kernels().square_of_rolling(of.ends, batches_->ball_rolling.view()[batch], free_.data(),
                                         bodies_.data(), square);
  } else {
    const lanes::PointBatch& points = batches_->points.view()[batch - balls];
    lanes::kernels().square_of_points(points, &batches_->rows.view()[points.first_row], free_.data(),
                                      bodies_.data(), square);
    if (batches_->rolls())
      lanes::kernels().square_of_rolling(points.ends, batches_->point_rolling.view()[batch - balls],
                                         free_.data(), bodies_.data(), square);
  }
  return square;
}

bool Sweeps::run(const SweepPlan& plan, int most, std::int64_t& count) {
  copy(last_, bodies_);
  bool converged = false;
  double last_step = 0;
  double beta = 0;
  const lanes::SweepKernels& kernels = plan.smooth ? lanes::kernels().smooth : lanes::kernels().rough;
  for (int sweep = 1; sweep <= most && !converged; ++sweep) {
    if (sweep > 1) {
      constexpr std::int64_t few_chunks = 8;  // worth waking threads for
      parallel::for_each<Host>("response.accelerate",
                               (bodies_.size() + Accelerate::chunk - 1) / Accelerate::chunk,
                               Accelerate{bodies_.view(), last_.data(), beta}, few_chunks);
    }
    lanes::for_each_color("response.sweep", *batches_,
                          SweepBalls{kernels.balls, batches_->balls.view(), batches_->ball_rolling.view(),
                                     bodies_.view(), beta, change_.data()},
                          SweepPoints{kernels.points, batches_->points.view(), batches_->rows.view(),
                                      batches_->point_rolling.view(), bodies_.view(), beta, plan.block_sweeps,
                                      change_.data() + batches_->balls.size()});
    hold_to_guides();
    ++count;
    const auto total =
        parallel::sum<ImpulseChange, Host>("response.change", change_.size(), LoadChange{change_.view()});
    converged = sweep >= plan.least && total.within(plan.tolerance);
    const double ratio = sweep > 1 ? total.step / last_step : 0.0;
    beta = ratio < 1.0 ? ratio : 0.0;
    last_step = total.step;
  }
  lanes::store_impulses(*batches_, stage_->rows, stage_->change);
  lanes::store_couples(*batches_, stage_->couples);
  return converged;
}

}  // namespace scree
