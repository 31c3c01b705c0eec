#include "sim/dynamics/impact_solver.hpp"

#include "core/parallel.hpp"
#include "core/tolerances.hpp"

#include <algorithm>
#include <functional>

namespace scree {

namespace {

/// The first impact of each pair, then of each plane with each body.
struct FindFirst {
  FlightStage stage;
  const std::int32_t* planes;
  View<Meeting> first;

  void operator()(std::int64_t k) const {
    const auto [i, j] = candidate(k);
    first[k] = stage.next(i, j);
  }

  /// Pairs with planes may be among the others too: they are left to the planes.
  std::pair<std::int32_t, std::int32_t> candidate(std::int64_t k) const {
    const ConstView<Pair> pairs = stage.problem.pairs;
    if (k < pairs.size()) {
      const Pair& pair = pairs[k];
      const bool has_plane =
          stage.bodies.shape[pair.i] == Shape::plane || stage.bodies.shape[pair.j] == Shape::plane;
      return has_plane ? std::pair(pair.i, pair.i) : std::pair(pair.i, pair.j);
    }
    const std::int64_t bodies = stage.bodies.count();
    const std::int32_t plane = planes[(k - pairs.size()) / bodies];
    const auto body = static_cast<std::int32_t>((k - pairs.size()) % bodies);
    return std::minmax(plane, body);
  }
};

/// Who has had an impact later than the flight begins has been where it was before that.
struct StartClock {
  View<double> clock;
  double from;
  SCREE_HD void operator()(std::int64_t k) const { clock[k] = from > 0 ? fmax(clock[k], from) : 0.0; }
};

struct SetReach {
  FlightStage stage;
  void operator()(std::int64_t k) const { stage.bound(static_cast<std::int32_t>(k)); }
};

struct LoadReach {
  View<double> reach;
  SCREE_HD double operator()(std::int64_t k) const { return reach[k]; }
};

struct MinusSize {
  BodyView bodies;
  SCREE_HD double operator()(std::int64_t k) const {
    return bodies.mobility[k] == Mobility::absent ? -HUGE_VAL
                                                  : -smallest_size(bodies.shape[k], bodies.size[k]);
  }
};

/// False if no two bodies can go deep into one another.
bool may_go_deep(const FlightStage& stage) {
  const std::int64_t n = stage.bodies.count();
  const double reach = parallel::max<double, Host>("impact.reach", n, LoadReach{stage.reach}, 0.0);
  const double size = -parallel::max<double, Host>("impact.size", n, MinusSize{stage.bodies}, -HUGE_VAL);
  // The reach is of half a substep: two bodies, and both halves.
  return stage.parameters.continuous && 4 * reach > tolerance::deep_approach * size;
}

}  // namespace

Ledger ImpactSolver::resolve(const ImpactProblem& problem, const ResponseParameters& parameters,
                             BodyView bodies) {
  const std::int64_t n = bodies.count();
  log_.clock.resize(n);
  log_.hits.resize(n);
  parallel::for_each<Host>("impact.reset", n, StartClock{log_.clock.view(), problem.from});
  parallel::fill("impact.reset", log_.hits, std::int32_t{0});
  impacts_.clear();
  saved_.clear();
  hit_bound_ = false;
  log_.turn.resize(n);
  log_.reach.resize(n);
  const FlightStage stage(problem, parameters, bodies, log_);
  parallel::for_each<Host>("impact.reach", n, SetReach{stage});
  if (!(problem.bounces && parameters.restitution) && !may_go_deep(stage)) return {};
  planes_.clear();
  for (std::int64_t k = 0; k < n; ++k) {
    if (bodies.shape[k] == Shape::plane) planes_.push_back(static_cast<std::int32_t>(k));
  }
  first_.resize(problem.pairs.size() + static_cast<std::int64_t>(planes_.size()) * n);
  const FindFirst find{stage, planes_.data(), first_.view()};
  parallel::for_each<Host>("impact.first", first_.size(), find);

  events_.clear();
  for (std::int64_t k = 0; k < first_.size(); ++k) {
    if (first_.view()[k].time > problem.step) continue;
    const auto [i, j] = find.candidate(k);
    foresee(stage, i, j, first_.view()[k]);
  }
  if (events_.empty()) return {};
  list_partners(problem.pairs, bodies);

  const auto foresee_all_of = [&](std::int32_t body, std::int32_t but) {
    if (!stage.is_free(body)) return;
    const auto look_at = [&](std::int32_t other) {
      if (other == body || other == but) return;
      const auto [i, j] = std::minmax(body, other);
      foresee(stage, i, j, stage.next(i, j));
    };
    const auto k = static_cast<std::size_t>(body);
    for (std::int64_t p = begin_[k]; p < begin_[k + 1]; ++p) look_at(partners_[static_cast<std::size_t>(p)]);
    for (const std::int32_t plane : planes_) look_at(plane);
  };
  const auto save = [&](std::int32_t body) {
    if (!stage.is_free(body) || stage.hits[body] > 0) return;
    saved_.push_back({body, bodies.position[body], bodies.orientation[body], bodies.velocity[body],
                      bodies.spin[body], stage.clock[body]});
  };
  Ledger ledger;
  while (!events_.empty()) {
    std::pop_heap(events_.begin(), events_.end(), std::greater<>());
    const Event event = events_.back();
    events_.pop_back();
    const auto [meeting, i, j, hits_i, hits_j] = event;
    if (stage.hits[i] != hits_i || stage.hits[j] != hits_j) continue;
    const std::size_t saved = saved_.size();
    save(i);
    save(j);
    Impact impact;
    if (!resolve_impact(stage, i, j, meeting, impact, ledger)) {
      saved_.resize(saved);
      continue;
    }
    impacts_.push_back(impact);
    hit_bound_ = hit_bound_ || std::max(stage.hits[i], stage.hits[j]) >= most_bounces;
    foresee(stage, i, j, stage.next(i, j));
    foresee_all_of(i, j);
    foresee_all_of(j, i);
  }
  return ledger;
}

void ImpactSolver::foresee(const FlightStage& stage, std::int32_t i, std::int32_t j, const Meeting& meeting) {
  if (meeting.time > stage.problem.step) return;
  events_.push_back({meeting, i, j, stage.hits[i], stage.hits[j]});
  std::push_heap(events_.begin(), events_.end(), std::greater<>());
}

void ImpactSolver::list_partners(ConstView<Pair> pairs, const BodyView& bodies) {
  begin_.assign(static_cast<std::size_t>(bodies.count()) + 1, 0);
  const auto count = [&](std::int32_t body) { ++begin_[static_cast<std::size_t>(body) + 1]; };
  const auto is_listed = [&](const Pair& pair) {
    return bodies.shape[pair.i] != Shape::plane && bodies.shape[pair.j] != Shape::plane;
  };
  for (const Pair& pair : pairs) {
    if (!is_listed(pair)) continue;
    count(pair.i);
    count(pair.j);
  }
  for (std::size_t k = 1; k < begin_.size(); ++k) begin_[k] += begin_[k - 1];
  partners_.resize(static_cast<std::size_t>(begin_.back()));
  std::vector<std::int64_t>& next = next_;
  next.assign(begin_.begin(), begin_.end());
  for (const Pair& pair : pairs) {
    if (!is_listed(pair)) continue;
    partners_[static_cast<std::size_t>(next[static_cast<std::size_t>(pair.i)]++)] = pair.j;
    partners_[static_cast<std::size_t>(next[static_cast<std::size_t>(pair.j)]++)] = pair.i;
  }
}

void ImpactSolver::undo(BodyView bodies) {
  for (const StruckBody& saved : saved_) {
    bodies.position[saved.body] = saved.position;
    bodies.orientation[saved.body] = saved.orientation;
    bodies.velocity[saved.body] = saved.velocity;
    bodies.spin[saved.body] = saved.spin;
    log_.clock.view()[saved.body] = saved.clock;
  }
  saved_.clear();
  impacts_.clear();
}

const LateBodies* ImpactSolver::late_bodies(const ImpactProblem& problem,
                                            const ResponseParameters& parameters, BodyView bodies) {
  const FlightStage stage(problem, parameters, bodies, log_);
  if (!any_is_late(stage, saved_)) return nullptr;
  return &late_.emplace(stage);
}

void ImpactSolver::mark_flights(const ImpactProblem& problem, const ResponseParameters& parameters,
                                ConstView<Manifold> manifolds, BodyView bodies, ContactSet& set) {
  scree::mark_flights(FlightStage(problem, parameters, bodies, log_), manifolds, set);
}

Ledger ImpactSolver::shift_late(const ImpactProblem& problem, const ResponseParameters& parameters,
                                BodyView bodies, const ContactSet& set) {
  return scree::shift_late(FlightStage(problem, parameters, bodies, log_), saved_, set, impulse_);
}

}  // namespace scree
