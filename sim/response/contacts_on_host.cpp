#include "sim/response/contacts_on_host.hpp"

#include "core/parallel_loops.hpp"
#include "core/tolerances.hpp"
#include "sim/contacts/contact_accounts.hpp"
#include "sim/laws/impulse_energy.hpp"
#include "sim/laws/rolling.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

namespace scree::solver {

template <class Real>
ContactsOnHost<Real>::ContactsOnHost(Inspection<Real>& seen, const std::vector<Guide>& guides) : seen_(seen) {
  take_bodies(guides);
  take_contacts(sort_contacts());
  set_velocities();
  islands_.find(std::as_const(contacts_).view(), std::as_const(bodies_).view());
}

/// Sorts the bodies by their numbers.
template <class Real>
void ContactsOnHost<Real>::take_bodies(const std::vector<Guide>& guides) {
  const std::int64_t n = seen_.free.size();
  bodies_.resize(n);
  velocity_.resize(n);
  spin_.resize(n);
  index_.resize(static_cast<std::size_t>(n));
  std::iota(index_.begin(), index_.end(), 0);
  for (std::int64_t k = 0; k < seen_.number.size(); ++k)
    index_[static_cast<std::size_t>(k)] = static_cast<std::int32_t>(seen_.number[k]);
  copy(guides_, guides);
  for (Guide& guide : guides_.view()) guide.body = index(guide.body);
  for (std::int32_t k = 0; k < n; ++k) {
    const BodyRecord<Real>& free = seen_.free[k];
    SolverBody& body = bodies_.view()[index(k)];
    body = {vec3(free.velocity), vec3(free.spin), static_cast<double>(free.inverse_mass),
            static_cast<double>(free.inverse_inertia) * Mat3::Identity()};
    velocity_.view()[index(k)] = body.velocity;
    spin_.view()[index(k)] = body.spin;
  }
}

/// Sorts the contacts by the numbers of their bodies, sets the first row of each, and the inertias of bodies
/// that are no balls. Returns where each contact goes, in the order of for_each_contact().
template <class Real>
std::vector<std::int64_t> ContactsOnHost<Real>::sort_contacts() {
  struct Place {
    std::int32_t i, j, surface, count;  // i, j: numbers of the bodies
    std::int64_t nth;                   // rank in the order of for_each_contact()
  };
  std::vector<Place> order;
  for_each_contact(seen_, [&](const SeenContact& c) {
    order.push_back({index(c.slot.i), index(c.slot.j), c.slot.surface, c.count, std::ssize(order)});
    if (c.balls) return;
    bodies_.view()[index(c.i)].inverse_inertia = c.inertia_i;
    bodies_.view()[index(c.j)].inverse_inertia = c.inertia_j;
  });
  std::ranges::sort(order, {}, [](const Place& at) { return std::tuple(at.i, at.j, at.surface); });
  std::vector<std::int64_t> to(order.size());
  contacts_.resize(std::ssize(order));
  std::int64_t rows = 0;
  for (std::size_t k = 0; k < order.size(); ++k) {
    to[static_cast<std::size_t>(order[k].nth)] = static_cast<std::int64_t>(k);
    contacts_.view()[static_cast<std::int64_t>(k)].first_row = rows;
    rows += order[k].count;
  }
  rows_.resize(rows);
  return to;
}

template <class Real>
void ContactsOnHost<Real>::take_contacts(const std::vector<std::int64_t>& to) {
  place_.resize(to.size());
  couples_.resize(to.size());
  std::size_t seen_so_far = 0;
  for_each_contact(seen_, [&](const SeenContact& c) {
    const std::int64_t k = to[seen_so_far++];
    const SolverBody& i = bodies_.view()[index(c.i)];
    const SolverBody& j = bodies_.view()[index(c.j)];
    Contact& contact = contacts_.view()[k];
    contact = {.i = index(c.i),
               .j = index(c.j),
               .first_row = contact.first_row,
               .count = c.count,
               .balls = c.balls,
               .normal = c.normal,
               .friction = c.friction,
               .rolling_reach = c.rolling_reach};
    place_[static_cast<std::size_t>(k)] = c.place;
    couples_[static_cast<std::size_t>(k)] = c.couple;
    for (int p = 0; p < c.count; ++p) {
      const SeenPoint& point = c.points[p];
      RowCoupling coupling;
      ContactRow& row = rows_.view()[contact.first_row + p];
      row = c.balls ? make_ball_row(point.arm_i, point.arm_j, 0, i, j)
                    : make_row(c.normal, point.arm_i, point.arm_j, 0, i, j, coupling);
      row.target = point.target;
      row.impulse = point.impulse;
    }
  });
}

/// Computes the velocities anew from the impulses, so that the rounding errors of many sweeps do not remain.
template <class Real>
void ContactsOnHost<Real>::set_velocities() {
  for (std::int64_t k = 0; k < bodies_.size(); ++k) {
    bodies_.view()[k].velocity = velocity_.view()[k];
    bodies_.view()[k].spin = spin_.view()[k];
  }
  for (std::int64_t c = 0; c < contacts_.size(); ++c) {
    const Contact& contact = contacts_.view()[c];
    SolverBody& i = bodies_.view()[contact.i];
    SolverBody& j = bodies_.view()[contact.j];
    for (int k = 0; k < contact.count; ++k) {
      const ContactRow& row = rows_.view()[contact.first_row + k];
      row.push(row.impulse, i, j);
    }
    turn(couples_[static_cast<std::size_t>(c)], i, j);
  }
  for (const Guide& guide : guides_.view()) guide.hold(bodies_.view()[guide.body].velocity);
}

template <class Real>
bool ContactsOnHost<Real>::rolls(std::int64_t island) const {
  return std::ranges::any_of(islands_.contacts(island),
                             [&](std::int32_t c) { return contacts_.view()[c].rolling_reach > 0; });
}

template <class Real>
ImpulseChange ContactsOnHost<Real>::residual_of(const IslandProblem& problem) const {
  ImpulseChange residual = natural_residual(problem);
  for (const std::int32_t c : islands_.contacts(problem.island)) {
    const Contact& contact = problem.contacts[c];
    if (contact.rolling_reach == 0) continue;
    const SolverBody& i = problem.solver[contact.i];
    const SolverBody& j = problem.solver[contact.j];
    const double mass = rolling_mass(i, j, contact.normal);
    if (mass == 0) continue;
    double pn = 0;
    for (int k = 0; k < contact.count; ++k)
      pn += problem.rows[contact.first_row + k].impulse.dot(contact.normal);
    const Vec3& now = couples_[static_cast<std::size_t>(c)];
    const Vec3 couple =
        rolling_couple(now, contact.normal, contact.rolling_reach * pn, mass, j.spin - i.spin);
    residual = residual + ImpulseChange{(couple - now).squaredNorm() / mass, now.squaredNorm() / mass};
  }
  return residual;
}

/// Sorts records of the bodies of the solver by their numbers.
template <class Real>
std::vector<BodyRecord<Real>> ContactsOnHost<Real>::by_index(
    const std::vector<BodyRecord<Real>>& by_place) const {
  std::vector<BodyRecord<Real>> sorted(by_place.size());
  for (std::size_t k = 0; k < sorted.size(); ++k) sorted[static_cast<std::size_t>(index_[k])] = by_place[k];
  return sorted;
}

/// Returns the velocities of j relative to i at a point of a contact, which are before the substep's forces,
/// with these but without contacts, and with the impulses found. `before` is sorted by the numbers of the
/// bodies.
template <class Real>
VelocitiesAt ContactsOnHost<Real>::velocities_at(const ContactRow& row, const Contact& contact,
                                                 const std::vector<BodyRecord<Real>>& before) const {
  const BodyRecord<Real>& before_i = before[static_cast<std::size_t>(contact.i)];
  const BodyRecord<Real>& before_j = before[static_cast<std::size_t>(contact.j)];
  return {row.relative_velocity(vec3(before_i.velocity), vec3(before_i.spin), vec3(before_j.velocity),
                                vec3(before_j.spin)),
          row.relative_velocity(velocity_.view()[contact.i], spin_.view()[contact.i],
                                velocity_.view()[contact.j], spin_.view()[contact.j]),
          row.relative_velocity(bodies_.view()[contact.i], bodies_.view()[contact.j])};
}

/// Returns whether the bodies of an island move on one another: whether the power of its impulses on the
/// velocities before the substep's forces is more than a share of their power on what they change. At rest it
/// is 0, even where the impulses are far from the solution. `before` is sorted by the numbers of the bodies.
template <class Real>
bool ContactsOnHost<Real>::moves(std::int64_t island, const std::vector<BodyRecord<Real>>& before) const {
  double taken = 0, changed = 0;
  for (const std::int32_t c : islands_.contacts(island)) {
    const Contact& contact = contacts_.view()[c];
    for (int k = 0; k < contact.count; ++k) {
      const ContactRow& row = rows_.view()[contact.first_row + k];
      const VelocitiesAt u = velocities_at(row, contact, before);
      taken -= row.impulse.dot(u.before);
      changed += row.impulse.dot(u.after - u.free);
    }
  }
  return taken > tolerance::moving_power * changed;
}

template <class Real>
bool ContactsOnHost<Real>::solve(double tolerance, const DirectLimits& limits,
                                 const std::vector<BodyRecord<Real>>* before, std::int64_t& solved,
                                 std::int64_t& failed) {
  const std::vector<BodyRecord<Real>> sorted =
      before != nullptr ? by_index(*before) : std::vector<BodyRecord<Real>>{};
  Array<DirectOutcome, Host> outcomes(islands_.count());
  const View<DirectOutcome> outcome = outcomes.view();
  parallel::for_each<Host>("response.islands", islands_.count(), [&](std::int64_t island) {
    const IslandProblem problem{.contacts = std::as_const(contacts_).view(),
                                .rows = rows_.view(),
                                .solver = bodies_.view(),
                                .velocity = std::as_const(velocity_).view(),
                                .spin = std::as_const(spin_).view(),
                                .islands = islands_,
                                .island = island,
                                .guides = std::as_const(guides_).view()};
    const bool is_left = rolls(island) || (before != nullptr && moves(island, sorted));
    outcome[island] = residual_of(problem).within(tolerance) ? DirectOutcome::not_needed
                      : is_left                              ? DirectOutcome::not_tried
                                                             : solve_directly(problem, tolerance, limits);
  });
  solved += std::ranges::count(outcome, DirectOutcome::solved);
  failed += std::ranges::count(outcome, DirectOutcome::failed);
  return std::ranges::all_of(outcome, [](DirectOutcome of) {
    return of == DirectOutcome::solved || of == DirectOutcome::not_needed;
  });
}

template <class Real>
int ContactsOnHost<Real>::keep_from_gaining(const std::vector<BodyRecord<Real>>& before_by_place) {
  const std::vector<BodyRecord<Real>> before = by_index(before_by_place);
  int scaled = 0;
  for (std::int64_t island = 0; island < islands_.count(); ++island) {
    Moved moved;
    for (const std::int32_t c : islands_.contacts(island)) {
      const Contact& contact = contacts_.view()[c];
      double through_mean = 0, square = 0;
      for (int k = 0; k < contact.count; ++k) {
        const ContactRow& row = rows_.view()[contact.first_row + k];
        const VelocitiesAt u = velocities_at(row, contact, before);
        through_mean += 0.5 * row.impulse.dot(u.before + u.after);
        square += 0.5 * row.impulse.dot(u.after - u.free);
      }
      const BodyRecord<Real>& before_i = before[static_cast<std::size_t>(contact.i)];
      const BodyRecord<Real>& before_j = before[static_cast<std::size_t>(contact.j)];
      const Vec3& couple = couples_[static_cast<std::size_t>(c)];
      const Vec3 spin = bodies_.view()[contact.j].spin - bodies_.view()[contact.i].spin;
      through_mean += 0.5 * couple.dot(vec3(before_j.spin) - vec3(before_i.spin) + spin);
      square += 0.5 * couple.dot(spin - spin_.view()[contact.j] + spin_.view()[contact.i]);
      moved = moved + Moved{through_mean - square, square};
    }
    if (!moved.gains(response_gain<Real>)) continue;
    const double by = moved.scale_without_gain();
    ++scaled;
    for (const std::int32_t c : islands_.contacts(island)) {
      const Contact& contact = contacts_.view()[c];
      for (int k = 0; k < contact.count; ++k) rows_.view()[contact.first_row + k].impulse *= by;
      couples_[static_cast<std::size_t>(c)] *= by;
    }
  }
  if (scaled > 0) set_velocities();
  return scaled;
}

template <class Real>
void ContactsOnHost<Real>::put_back() const {
  using B = BallContacts<Real>;
  using P = PointContacts<Real>;
  using R = RollingFields<Real>;
  const B balls = seen_.contacts->balls();
  const P points = seen_.contacts->points();
  for (std::int64_t c = 0; c < contacts_.size(); ++c) {
    const Contact& contact = contacts_.view()[c];
    const std::int64_t place = place_[static_cast<std::size_t>(c)];
    for (int k = 0; k < contact.count; ++k) {
      const V3<Real> impulse = v3<Real>(rows_.view()[contact.first_row + k].impulse);
      for (const bool last : {false, true}) {
        if (contact.balls) {
          balls.fields.set(last ? B::last : B::impulse, place, impulse);
        } else {
          points.point_fields.set(P::at_point(k, last ? P::last : P::impulse), place, impulse);
        }
      }
    }
    if (seen_.rolls) {
      const auto& fields = (contact.balls ? seen_.ball_rolling : seen_.point_rolling).fields;
      const V3<Real> couple = v3<Real>(couples_[static_cast<std::size_t>(c)]);
      fields.set(R::couple, place, couple);
      fields.set(R::last, place, couple);
    }
  }
}

template class ContactsOnHost<double>;
template class ContactsOnHost<float>;

}  // namespace scree::solver
