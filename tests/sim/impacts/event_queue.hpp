// An event queue that resolves all impacts of a flight on Host in the order of their times, each one with the
// outcome of those before it: the oracle for ImpactRounds.
#pragma once

#include "core/tolerances.hpp"
#include "sim/impacts/impact.hpp"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <tuple>
#include <utility>
#include <vector>

namespace scree::test {

/// A queue for bodies without loads, which predicts meetings by a search for every pair.
class EventQueue {
 public:
  /// Resolves impacts as ImpactRounds::resolve() does. The candidates must contain all pairs that may meet.
  Ledger resolve(ConstView<Pair> pairs, const FlightTerms& terms, const ResponseParameters& parameters,
                 BodyView bodies) {
    const std::int64_t n = bodies.count();
    log_.resize(n);
    impacts_.clear();
    events_.clear();
    version_.assign(static_cast<std::size_t>(n), 0);
    partners_.assign(static_cast<std::size_t>(n), {});
    struck_.assign(static_cast<std::size_t>(n), 0);
    FlightStage stage(terms, parameters, bodies, log_);
    for (std::int64_t k = 0; k < n; ++k) {
      log_.clock.view()[k] = terms.from > 0 ? std::max(log_.clock.view()[k], terms.from) : 0.0;
      log_.budget_used.view()[k] = 0;
      stage.bound(static_cast<std::int32_t>(k));
    }
    for (const auto& [i, j] : pairs) {
      partners_[at(i)].push_back(j);
      partners_[at(j)].push_back(i);
      predict(stage, i, j);
    }
    Ledger ledger;
    while (!events_.empty()) {
      std::pop_heap(events_.begin(), events_.end(), std::greater<>());
      const Event event = events_.back();
      events_.pop_back();
      if (version_[at(event.i)] == event.version_i && version_[at(event.j)] == event.version_j)
        ledger = ledger + resolve(stage, event);
    }
    return ledger;
  }

  const std::vector<Impact>& impacts() const { return impacts_; }
  bool any_late_impact(const FlightTerms& terms) const {
    for (std::size_t k = 0; k < struck_.size(); ++k)
      if (struck_[k] != 0 && log_.clock.view()[static_cast<std::int64_t>(k)] > 0.5 * terms.step) return true;
    return false;
  }
  FlightStage stage(const FlightTerms& terms, const ResponseParameters& parameters, const BodyView& bodies) {
    return {terms, parameters, bodies, log_};
  }

 private:
  /// A predicted meeting.
  struct Event {
    Meeting meeting;
    std::int32_t i, j;
    std::int32_t version_i, version_j;  // versions of the bodies' flights at the prediction

    friend bool operator>(const Event& a, const Event& b) {
      return std::tuple(a.meeting.time, a.i, a.j, a.meeting.part) >
             std::tuple(b.meeting.time, b.i, b.j, b.meeting.part);
    }
  };
  static std::size_t at(std::int32_t body) { return static_cast<std::size_t>(body); }

  void predict(const FlightStage& stage, std::int32_t i, std::int32_t j) {
    const Meeting meeting = stage.next(i, j, LoadedParts{});
    if (meeting.time > stage.terms.step) return;
    events_.push_back({meeting, i, j, version_[at(i)], version_[at(j)]});
    std::push_heap(events_.begin(), events_.end(), std::greater<>());
  }
  void predict_all_of(const FlightStage& stage, std::int32_t body, std::int32_t but) {
    if (!stage.is_free(body)) return;
    for (const std::int32_t other : partners_[at(body)])
      if (other != but) predict(stage, std::min(body, other), std::max(body, other));
  }

  Ledger resolve(const FlightStage& stage, const Event& event) {
    const auto [meeting, i, j, version_i, version_j] = event;
    // Visits each wall (a body that is not free) that the free body of the pair meets, except one that is in
    // the pair.
    const auto other_walls = [&](const auto& then) {
      const std::int32_t body = stage.is_free(i) ? i : j;
      for (const std::int32_t wall : partners_[at(body)]) {
        if (stage.is_free(wall) || wall == i || wall == j) continue;
        const Meeting other = stage.next(std::min(body, wall), std::max(body, wall), LoadedParts{});
        if (other.time <= stage.terms.step) then(wall, other.part);
      }
    };
    SolvedImpact solved;
    if (!solve_impact(stage, i, j, meeting, LoadedParts{}, other_walls, solved)) return {};
    const Ledger moved = fly_on(stage, solved, impacts_.emplace_back());
    for (int k = 0; k < solved.count; ++k)
      if (solved.is_first_of_wall(k)) impacts_.push_back(solved.of_wall(solved.wall[k]));
    for (const std::int32_t body : {i, j}) {
      if (!stage.is_free(body)) continue;
      ++version_[at(body)];
      struck_[at(body)] = 1;
    }
    predict(stage, i, j);
    predict_all_of(stage, i, j);
    predict_all_of(stage, j, i);
    return moved;
  }

  FlightLog<Host> log_;
  std::vector<Event> events_;          // a heap with the earliest event first
  std::vector<std::int32_t> version_;  // version of each body's flight: the number of impacts that led to it
  std::vector<std::vector<std::int32_t>> partners_;
  std::vector<std::uint8_t> struck_;
  std::vector<Impact> impacts_;
};

}  // namespace scree::test
