// The search for the time at which two bodies of any shape meet along their flights.
#pragma once

#include "core/tolerances.hpp"
#include "narrowphase/any_contacts.hpp"
#include "sim/laws/body_flight.hpp"

#include <algorithm>
#include <cmath>

namespace scree {

struct Meeting {
  double time = HUGE_VAL;  ///< time into the substep (s); infinite: no meeting
  int part = 0;            ///< Manifold::part of the contact
};

/// A search for the first meeting that counts, by conservative advancement (Mirtich 1996, sec. 2.3): no step
/// is longer than the gap divided by the fastest approach. Near the contact Newton's steps are taken instead,
/// and an overlap is bisected.
class MeetingSearch {
 public:
  /// Prepares a search. `fastest`: fastest_approach() of the pair (m/s).
  SCREE_HD MeetingSearch(const PairFlight& pair, double fastest)
      : pair_(pair), fastest_(fastest), size_(pair.smaller_size()) {}

  /// Returns the first meeting at `earliest` (s) or later. If `divide` is given, only the side of `divide` on
  /// which the time of the meeting lies is exact: the search ends as soon as that is known.
  SCREE_HD Meeting run(double earliest, double divide = NAN) {
    double s = earliest;
    Look now = look(s);
    for (int iteration = 0; now.near && iteration < most_iterations; ++iteration) {
      if (now.hit) return {.time = s, .part = now.part};
      settle(now);
      if (s >= pair_.until) return {};
      const double next = std::min(s + step_from(now), pair_.until);
      const Look then = look(next);
      const double level = std::min(now.gap, 0.0);
      if (then.hit) {
        SCREE_ON_HOST(if (now.hidden) return first_hit(s, next, then);)
        const bool is_told = next <= divide || s >= divide;
        if (is_told || then.gap >= level - touching()) return {.time = next, .part = then.part};
        // The meeting is where the gap falls to that level, unless the approach does not count there yet.
        double touch = next;
        const Look at = find_touch(s, now, touch, then, level);
        return at.hit ? Meeting{.time = touch, .part = at.part} : Meeting{.time = next, .part = then.part};
      }
      s = next;
      now = then;
    }
    return {};
  }

 private:
  static constexpr int most_iterations = 1000;
  static constexpr int most_bisections = 60;

  /// The pair at one instant.
  struct Look {
    bool near = false;      // whether anything of the pair is within reach
    bool hidden = false;    // whether the nearest manifold is no contact of the pair (hidden_part)
    double gap = HUGE_VAL;  // smallest gap of the points whose part may count (m)
    double closing = 0;     // speed at which the bodies close there (m/s)
    bool hit = false;       // whether the approach counts at a point that touches
    int part = 0;           // Manifold::part of that point
    bool rests[PairFlight::parts] = {};  // parts where a point touches whose approach does not count
  };

  SCREE_HD double touching() const { return tolerance::touching_gap * size_; }

  /// Excludes parts from bouncing that have touched slowly or touch at rest: they bear load from then on.
  SCREE_HD void settle(const Look& now) {
    for (int part = 0; part < PairFlight::parts; ++part) {
      if (now.rests[part]) pair_.slowest[part] = HUGE_VAL;
    }
  }

  [[gnu::noinline]] SCREE_HD Look look(double s) const {
    const BodyInstant i = instant_of(pair_.i, s);
    const BodyInstant j = instant_of(pair_.j, s);
    Manifold manifolds[max_pair_manifolds];
    const double reach = fastest_ * (pair_.until - s) + 2 * touching();
    const int count = find_any_contacts({pair_.i.shape, i.solid}, {pair_.j.shape, j.solid}, pair_.shapes,
                                        {.margin = reach, .hidden = true}, manifolds);
    Look look;
    for (int m = 0; m < count; ++m) {
      const int part = manifolds[m].part;
      SCREE_ON_HOST(if (part == hidden_part) {
        see_hidden(manifolds[m], i, j, look);
        continue;
      })
      if (pair_.slowest[part] == HUGE_VAL && pair_.farthest == HUGE_VAL) continue;
      for (int k = 0; k < manifolds[m].count; ++k) {
        const ContactPoint& point = manifolds[m].points[k];
        const double gap = point.gap;
        const double closing = closing_speed(manifolds[m].normal, point.position, i, j);
        look.near = true;
        if (gap < look.gap) {
          look.hidden = false;
          look.gap = gap;
          look.closing = closing;
        }
        if (gap > touching()) continue;
        if (!look.hit && pair_.counts(part, manifolds[m].normal, closing, s)) {
          look.hit = true;
          look.part = part;
        }
        const bool bears = closing > 0 || (closing == 0 && pair_.slowest[part] > 0);
        look.rests[part] =
            look.rests[part] || (bears && !pair_.counts(part, manifolds[m].normal, closing, s));
      }
    }
    return look;
  }

  /// Notes a hidden manifold, which is no contact yet but may lead to one.
  void see_hidden(const Manifold& m, const BodyInstant& i, const BodyInstant& j, Look& look) const {
    look.near = true;
    if (m.points[0].gap >= look.gap) return;
    look.hidden = true;
    look.gap = m.points[0].gap;
    look.closing = closing_speed(m.normal, m.points[0].position, i, j);
  }

  /// Returns the length of the next step (s): the time that the gap lasts at the fastest approach, or more
  /// where that is next to nothing.
  SCREE_HD double step_from(const Look& now) const {
    const double safe = std::max(now.gap, 0.0) / fastest_;
    const double least = tolerance::search_advance * size_ / fastest_;
    if (now.closing > 0 && now.gap > touching())
      return std::max(safe, std::min(now.gap / now.closing, least));
    return std::max(safe, least);
  }

  /// Finds where a contact begins that was hidden before, by bisection: its gap need not have been 0 then.
  Meeting first_hit(double from, double to, Look after) const {
    for (int k = 0; k < most_bisections; ++k) {
      const double middle = 0.5 * (from + to);
      if (!(middle > from && middle < to)) break;
      const Look at = look(middle);
      if (at.hit) {
        to = middle;
        after = at;
      } else {
        from = middle;
      }
    }
    return {.time = to, .part = after.part};
  }

  /// Finds where the gap falls through the level from above, between two instants, and moves `to` there. It
  /// takes Newton's steps from the instants before and after, if the bodies close there; from both, it
  /// prefers the one whose gap is nearer to the level. It halves the interval where these steps leave it or
  /// converge slowly, since nearest features change and gaps have kinks and jumps. It aims at the near end of
  /// the gaps that count as touching: if it went deeper, bodies at rest with e = 1 would bounce more.
  SCREE_HD Look find_touch(double from, Look before, double& to, Look after, double level) const {
    constexpr int usual_steps = 4;
    const double aim = level - tolerance::touch_aim * touching();
    for (int k = 1; k <= most_bisections && after.gap < level - touching(); ++k) {
      const double above = before.gap - aim;
      const double below = aim - after.gap;
      const bool forward = before.closing > 0 && (above < below || !(after.closing > 0));
      double middle = forward ? from + above / before.closing : to - below / after.closing;
      const bool halves = (k > usual_steps && k % 2 == 0) || !(middle > from && middle < to);
      if (halves) middle = 0.5 * (from + to);
      if (!(middle > from && middle < to) || fastest_ * (to - from) <= touching()) break;
      const Look at = look(middle);
      if (at.gap <= level) {
        to = middle;
        after = at;
      } else {
        from = middle;
        before = at;
      }
    }
    return after;
  }

  PairFlight pair_;
  double fastest_;
  double size_;
};

}  // namespace scree
