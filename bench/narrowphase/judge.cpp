#include "bench/narrowphase/judge.hpp"

#include "bench/narrowphase/bounds.hpp"
#include "bench/narrowphase/oracle.hpp"
#include "narrowphase/box_box_libccd.hpp"

#include <algorithm>
#include <cmath>

namespace scree::bench {

namespace {

using oracle::ClosedForm;
using oracle::Real;
using oracle::SolidPair;

/// Moves a pair so that the second body is at the origin. Far from the origin even long double has too few
/// digits.
SolidPair at_origin(SolidPair pair) {
  pair.a.position -= pair.b.position;
  pair.b.position.setZero();
  return pair;
}

/// Sets the gap of the first surface, and none for the others.
void set_gap(Item& item, Real gap) {
  item.gap = {static_cast<double>(gap), HUGE_VAL, HUGE_VAL};
  item.certain = {true, true, true};
}

Real lowest(const oracle::Box& box, auto height_of) {
  Real least = INFINITY;
  for (const oracle::Vec& corner : box.vertices) least = std::min(least, height_of(corner));
  return least;
}

void true_gap_in_tube(ClosedForm form, const SolidPair& pair, Item& item) {
  const oracle::Tube tube(pair.b);
  const oracle::Vec centre = pair.a.position.cast<Real>();
  const Real depth = tube.depth(centre, item.margin);
  for (int part = 0; part < most_parts; ++part) {
    const auto height_of = [&](const oracle::Vec& p) { return tube.distance(part, p); };
    const Real gap = form == ClosedForm::sphere_tube ? height_of(centre) - pair.a.size.x()
                                                     : lowest(oracle::Box(pair.a), height_of);
    item.gap[part] = depth < 0 ? HUGE_VAL : static_cast<double>(gap);
    item.certain[part] = std::fabs(depth) > rounding * pair.length;
  }
}

bool is_finite(const Answer& answer) {
  return std::all_of(answer.manifolds.begin(), answer.manifolds.begin() + answer.count, [](const auto& m) {
    return m.normal.allFinite() && std::all_of(m.points, m.points + m.count, [](const auto& p) {
             return p.position.allFinite() && std::isfinite(p.gap);
           });
  });
}

/// Returns the smallest gap found at one surface; infinite if there is no contact.
double gap_at(const Answer& answer, int part) {
  double gap = HUGE_VAL;
  for (int k = 0; k < answer.count; ++k) {
    const Manifold& m = answer.manifolds[k];
    for (int p = 0; p < m.count && m.part == part; ++p) gap = std::min(gap, m.points[p].gap);
  }
  return gap;
}

/// Returns whether the answer was within bounds at one surface.
bool judge_part(const Item& item, const Answer& answer, int part, bool of_boxes, Row& row) {
  const double gap = item.gap[part], slack = rounding * item.pair.length;
  const double found = gap_at(answer, part);
  const double given_away = of_boxes ? oracle::most_given_away(gap, item.pair.smallest) +
                                           tolerance::same_feature * item.pair.smallest
                                     : 0.0;
  const double open = slack + (item.margin > 0 ? given_away : 0.0);
  const bool missed = found == HUGE_VAL && gap < item.margin - open;
  const bool made_up = found < HUGE_VAL && gap > item.margin + open;
  row.missed += missed;
  row.made_up += made_up;
  if (missed || made_up) return false;
  if (found == HUGE_VAL || gap == HUGE_VAL) return true;
  const double off = std::fabs(found - gap);
  if (!of_boxes) {
    row.error = std::max(row.error, off / item.pair.length);
    return off <= slack;
  }
  row.given_away = std::max(row.given_away, (off - slack) / given_away);
  return off <= given_away + slack;
}

/// Returns whether the depth by the 15 axes is right to rounding.
bool judge_axes(const Item& item, Row& row) {
  if (item.gap[0] > 0) return true;
  const double found = separating_axes(BoxPair(item.pair.a, item.pair.b), HUGE_VAL).separation;
  const double error = std::fabs(found - item.gap[0]) / item.pair.length;
  row.error = std::max(row.error, error);
  return error <= rounding;
}

/// Judges libccd's own answer, if the method by libccd called it. Returns false if it continued after its
/// budget.
bool judge_libccd(const Item& item, libccd::Method method, Row& row) {
  const BoxPair pair(item.pair.a, item.pair.b);
  const BoxAxes axes = separating_axes(pair, item.margin);
  if (axes.separation >= 0.0) return true;
  const libccd::Answer answer = detail::ask_libccd(pair, method);
  const bool hung = answer.supports > libccd::support_budget + supports_to_end;
  NarrowPhaseStats stats;
  detail::certified_direction(pair, axes, method, stats);
  row.ccd_calls += stats.ccd_calls;
  row.ccd_refused += stats.ccd_rejected;
  row.ccd_stopped += stats.ccd_stopped;
  row.ccd_hung += hung;
  if (answer.direction) {
    const double excess = axes.separation - pair.separation_along(*answer.direction);
    row.error = std::max(row.error, excess / item.pair.length);
  }
  return !hung;
}

}  // namespace

void find_truth(oracle::Family, Item& item) {
  const auto [a, b, length, smallest] = at_origin(item.pair);
  Real gap = oracle::separation(a, b);
  // The distance is at least the separation: if the separation is well beyond the margin, so is the distance.
  if (gap > 0 && gap <= 2 * item.margin + rounding * length) gap = oracle::distance(a, b);
  set_gap(item, gap);
}

void find_truth(ClosedForm form, Item& item) {
  const SolidPair pair = at_origin(item.pair);
  const auto& [a, b, length, smallest] = pair;
  const oracle::Vec centre = a.position.cast<Real>();
  const Real radius = a.size.x();
  oracle::Vec nearest = oracle::Vec::Zero();
  switch (form) {
    case ClosedForm::sphere_sphere:
      return set_gap(item, (b.position.cast<Real>() - centre).norm() - radius - b.size.x());
    case ClosedForm::sphere_box:
      return set_gap(item, oracle::to_surface(oracle::Box(b), centre, nearest) - radius);
    case ClosedForm::sphere_plane:
      return set_gap(item, oracle::height(b, centre) - radius);
    case ClosedForm::box_plane:
      return set_gap(
          item, lowest(oracle::Box(a), [&plane = b](const auto& p) { return oracle::height(plane, p); }));
    case ClosedForm::sphere_tube:
    case ClosedForm::box_tube:
      return true_gap_in_tube(form, pair, item);
    case ClosedForm::count:
      break;
  }
}

void judge(const Item& item, const Answer& answer, std::uint64_t n, bool of_boxes,
           std::optional<libccd::Method> method, Row& row) {
  ++row.pairs;
  bool good = is_finite(answer);
  row.not_finite += !good;
  bool touches = false;
  for (int part = 0; part < most_parts; ++part) {
    touches = touches || item.gap[part] <= item.margin;
    if (item.certain[part]) good = judge_part(item, answer, part, of_boxes, row) && good;
  }
  row.touching += touches;
  if (method) {
    good = judge_libccd(item, *method, row) && good;
  } else if (of_boxes) {
    good = judge_axes(item, row) && good;
  }
  row.broken += !good;
  if (!good && row.which.size() < 5) row.which.push_back(n);
}

}  // namespace scree::bench
