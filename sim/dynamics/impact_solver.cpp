#include "sim/dynamics/impact_solver.hpp"

#include "core/parallel_loops.hpp"
#include "core/tolerances.hpp"

#include <algorithm>
#include <functional>

namespace scree {

namespace {

/// The loads of a pair, as the last substep left them.
struct RememberedLoads {
  ImpulseMemory::Index memory;
  std::int32_t i, j;
  SCREE_HD bool is_loaded(int part) const { return memory.is_loaded(i, j, part); }
};

/// The first impact of each pair; whether it has one.
struct FindFirst {
  FlightStage stage;
  ConstView<Pair> pairs;
  ImpulseMemory::Index memory;
  View<Meeting> first;
  int operator()(std::int64_t k) const {
    const auto [i, j] = pairs[k];
    first[k] = stage.next(i, j, RememberedLoads{memory, i, j});
    return first[k].time <= stage.terms.step ? 1 : 0;
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

struct MinusSize {
  FlightStage stage;
  double operator()(std::int64_t k) const { return -stage.size_of(k); }
};

/// FlightStage::harmless of the bodies in flight.
double harmless_speed(const FlightStage& stage) {
  const std::int64_t n = stage.bodies.count();
  const double size = stage.parameters.continuous
                          ? -parallel::max<double, Host>("impact.size", n, MinusSize{stage}, -HUGE_VAL)
                          : HUGE_VAL;
  double restitution = 0;
  for (const PairLaw& law : stage.terms.laws.table) restitution = std::max(restitution, law.restitution);
  return stage.harmless_speed(size, restitution);
}

struct LoadSpeed {
  View<double> speed;
  SCREE_HD double operator()(std::int64_t k) const { return speed[k]; }
};

}  // namespace

Ledger ImpactSolver::resolve(const ImpactProblem& problem, const ResponseParameters& parameters,
                             BodyView bodies) {
  const std::int64_t n = bodies.count();
  log_.resize(n);
  parallel::for_each<Host>("impact.reset", n, StartClock{log_.clock.view(), problem.terms.from});
  parallel::fill("impact.reset", log_.weary, 0.0);
  impacts_.clear();
  saved_.clear();
  hit_bound_ = false;
  FlightStage stage(problem.terms, parameters, bodies, log_);
  parallel::for_each<Host>("impact.reach", n, SetReach{stage});
  stage.harmless = harmless_speed(stage);
  if (2 * parallel::max<double, Host>("impact.speed", n, LoadSpeed{stage.top_speed}, 0.0) <= stage.harmless)
    return {};
  const ConstView<Pair> pairs = problem.pairs;
  const ImpulseMemory::Index memory = problem.memory.index();
  first_.resize(pairs.size());
  const FindFirst find_first{stage, pairs, memory, first_.view()};
  if (parallel::max<int, Host>("impact.first", pairs.size(), find_first, 0) == 0) return {};

  events_.clear();
  version_.assign(static_cast<std::size_t>(n), 0);
  for (std::int64_t k = 0; k < pairs.size(); ++k) foresee(stage, pairs[k].i, pairs[k].j, first_.view()[k]);
  list_partners(pairs, bodies.count());

  const auto foresee_all_of = [&](std::int32_t body, std::int32_t but) {
    if (!stage.is_free(body)) return;
    const auto look_at = [&](std::int32_t other) {
      if (other == body || other == but) return;
      const auto [i, j] = std::minmax(body, other);
      foresee(stage, i, j, stage.next(i, j, RememberedLoads{memory, i, j}));
    };
    const auto k = static_cast<std::size_t>(body);
    for (std::int64_t p = begin_[k]; p < begin_[k + 1]; ++p) look_at(partners_[static_cast<std::size_t>(p)]);
  };
  const auto save = [&](std::int32_t body) {
    if (!stage.is_free(body) || version_[static_cast<std::size_t>(body)] > 0) return;
    saved_.push_back(before_impacts(stage, body));
  };
  /// What is not free and meets the free body of a pair, besides that of the pair.
  const auto other_walls_of = [&](std::int32_t i, std::int32_t j) {
    return [&, i, j](const auto& then) {
      const std::int32_t body = stage.is_free(i) ? i : j;
      const auto k = static_cast<std::size_t>(body);
      for (std::int64_t p = begin_[k]; p < begin_[k + 1]; ++p) {
        const std::int32_t wall = partners_[static_cast<std::size_t>(p)];
        if (stage.is_free(wall) || wall == i || wall == j) continue;
        const auto [first, second] = std::minmax(body, wall);
        const Meeting meeting = stage.next(first, second, RememberedLoads{memory, first, second});
        if (meeting.time <= stage.terms.step) then(wall, meeting.part);
      }
    };
  };
  Ledger ledger;
  while (!events_.empty()) {
    std::pop_heap(events_.begin(), events_.end(), std::greater<>());
    const Event event = events_.back();
    events_.pop_back();
    const auto [meeting, i, j, version_i, version_j] = event;
    std::int32_t& now_i = version_[static_cast<std::size_t>(i)];
    std::int32_t& now_j = version_[static_cast<std::size_t>(j)];
    if (now_i != version_i || now_j != version_j) continue;
    const std::size_t saved = saved_.size();
    save(i);
    save(j);
    const RememberedLoads loads{memory, i, j};
    SolvedImpact solved;
    if (!solve_impact(stage, i, j, meeting, loads, other_walls_of(i, j), solved)) {
      saved_.resize(saved);
      continue;
    }
    ledger = ledger + fly_on(stage, solved, impacts_.emplace_back());
    for (int k = 0; k < solved.count; ++k)
      if (solved.is_first_of_wall(k)) impacts_.push_back(solved.of_wall(solved.wall[k]));
    if (stage.is_free(i)) ++now_i;
    if (stage.is_free(j)) ++now_j;
    hit_bound_ = hit_bound_ || std::max(stage.weary[i], stage.weary[j]) >= impacts_end;
    foresee(stage, i, j, stage.next(i, j, loads));
    foresee_all_of(i, j);
    foresee_all_of(j, i);
  }
  return ledger;
}

void ImpactSolver::foresee(const FlightStage& stage, std::int32_t i, std::int32_t j, const Meeting& meeting) {
  if (meeting.time > stage.terms.step) return;
  events_.push_back(
      {meeting, i, j, version_[static_cast<std::size_t>(i)], version_[static_cast<std::size_t>(j)]});
  std::push_heap(events_.begin(), events_.end(), std::greater<>());
}

void ImpactSolver::list_partners(ConstView<Pair> pairs, std::int64_t bodies) {
  begin_.assign(static_cast<std::size_t>(bodies) + 1, 0);
  for (const Pair& pair : pairs) {
    ++begin_[static_cast<std::size_t>(pair.i) + 1];
    ++begin_[static_cast<std::size_t>(pair.j) + 1];
  }
  for (std::size_t k = 1; k < begin_.size(); ++k) begin_[k] += begin_[k - 1];
  partners_.resize(static_cast<std::size_t>(begin_.back()));
  next_.assign(begin_.begin(), begin_.end());
  for (const Pair& pair : pairs) {
    partners_[static_cast<std::size_t>(next_[static_cast<std::size_t>(pair.i)]++)] = pair.j;
    partners_[static_cast<std::size_t>(next_[static_cast<std::size_t>(pair.j)]++)] = pair.i;
  }
}

void ImpactSolver::undo(BodyView bodies) {
  for (const StruckBody& saved : saved_) restore(saved, bodies, log_.clock.view());
  saved_.clear();
  impacts_.clear();
}

const LateBodies* ImpactSolver::late_bodies(const ImpactProblem& problem,
                                            const ResponseParameters& parameters, BodyView bodies) {
  const FlightStage stage(problem.terms, parameters, bodies, log_);
  if (!any_is_late(stage, saved_)) return nullptr;
  return &late_.emplace(stage);
}

void ImpactSolver::take_normals_of_faces(const ImpactProblem& problem, const ResponseParameters& parameters,
                                         BodyView bodies, View<ManifoldHeader> headers,
                                         View<ContactPoint> points) {
  scree::take_normals_of_faces(FlightStage(problem.terms, parameters, bodies, log_), headers, points);
}

void ImpactSolver::mark_flights(const ImpactProblem& problem, const ResponseParameters& parameters,
                                const Manifolds& manifolds, BodyView bodies, ContactSet& set,
                                BallPairs& balls) {
  scree::mark_flights(FlightStage(problem.terms, parameters, bodies, log_), manifolds, set, balls);
}

Ledger ImpactSolver::shift_late(const ImpactProblem& problem, const ResponseParameters& parameters,
                                BodyView bodies, const ContactSet& set) {
  return scree::shift_late(FlightStage(problem.terms, parameters, bodies, log_), saved_, set, impulse_);
}

}  // namespace scree
