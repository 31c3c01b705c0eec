#include "sim/resident/contacts_on_host.hpp"

#include "core/parallel_loops.hpp"
#include "sim/dynamics/rolling.hpp"
#include "sim/resident/books.hpp"

#include <algorithm>
#include <utility>

namespace scree::resident {

template <class Real>
ContactsOnHost<Real>::ContactsOnHost(Inspection<Real>& seen, const std::vector<Guide>& guides) : seen_(seen) {
  const std::int64_t n = seen.free.size();
  bodies_.resize(n);
  velocity_.resize(n);
  spin_.resize(n);
  copy(guides_, guides);
  for (std::int64_t k = 0; k < n; ++k) {
    const BodyRecord<Real>& free = seen.free[k];
    SolverBody& body = bodies_.view()[k];
    body = {vec3(free.velocity), vec3(free.spin), static_cast<double>(free.inverse_mass),
            static_cast<double>(free.inverse_inertia) * Mat3::Identity()};
    velocity_.view()[k] = body.velocity;
    spin_.view()[k] = body.spin;
  }
  for_each_contact(seen, [&](const SeenContact& c) {
    if (c.balls) return;
    bodies_.view()[c.i].inverse_inertia = c.inertia_i;
    bodies_.view()[c.j].inverse_inertia = c.inertia_j;
  });
  std::vector<Contact> contacts;
  std::vector<ContactRow> rows;
  for_each_contact(seen, [&](const SeenContact& c) {
    SolverBody& i = bodies_.view()[c.i];
    SolverBody& j = bodies_.view()[c.j];
    contacts.push_back({.i = c.i,
                        .j = c.j,
                        .first_row = static_cast<std::int64_t>(rows.size()),
                        .count = c.count,
                        .balls = c.balls,
                        .normal = c.normal,
                        .friction = c.friction,
                        .rolling_reach = c.rolling_reach});
    place_.push_back(c.place);
    couples_.push_back(c.couple);
    for (int k = 0; k < c.count; ++k) {
      const SeenPoint& point = c.points[k];
      RowCoupling coupling;
      ContactRow& row =
          rows.emplace_back(c.balls ? make_ball_row(point.arm_i, point.arm_j, 0, i, j)
                                    : make_row(c.normal, point.arm_i, point.arm_j, 0, i, j, coupling));
      row.target = point.target;
      row.impulse = point.impulse;
    }
  });
  copy(contacts_, contacts);
  copy(rows_, rows);
  set_velocities();
  islands_.find(std::as_const(contacts_).view(), std::as_const(bodies_).view());
}

/// To what the impulses give, so that the rounding of many sweeps is none.
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

template <class Real>
bool ContactsOnHost<Real>::solve(double tolerance, const DirectLimits& limits, std::int64_t& solved,
                                 std::int64_t& failed) {
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
    outcome[island] = residual_of(problem).within(tolerance) ? DirectOutcome::not_needed
                      : rolls(island)                        ? DirectOutcome::too_large
                                                             : solve_directly(problem, tolerance, limits);
  });
  solved += std::ranges::count(outcome, DirectOutcome::solved);
  failed += std::ranges::count(outcome, DirectOutcome::failed);
  return std::ranges::all_of(outcome, [](DirectOutcome of) {
    return of == DirectOutcome::solved || of == DirectOutcome::not_needed;
  });
}

template <class Real>
int ContactsOnHost<Real>::keep_from_gaining(const std::vector<BodyRecord<Real>>& before) {
  int scaled = 0;
  for (std::int64_t island = 0; island < islands_.count(); ++island) {
    Moved moved;
    for (const std::int32_t c : islands_.contacts(island)) {
      const Contact& contact = contacts_.view()[c];
      const SolverBody& i = bodies_.view()[contact.i];
      const SolverBody& j = bodies_.view()[contact.j];
      const BodyRecord<Real>& before_i = before[static_cast<std::size_t>(contact.i)];
      const BodyRecord<Real>& before_j = before[static_cast<std::size_t>(contact.j)];
      double through_mean = 0, square = 0;
      for (int k = 0; k < contact.count; ++k) {
        const ContactRow& row = rows_.view()[contact.first_row + k];
        const Vec3 u = row.relative_velocity(i, j);
        const Vec3 u_before = row.relative_velocity(vec3(before_i.velocity), vec3(before_i.spin),
                                                    vec3(before_j.velocity), vec3(before_j.spin));
        const Vec3 u_free = row.relative_velocity(velocity_.view()[contact.i], spin_.view()[contact.i],
                                                  velocity_.view()[contact.j], spin_.view()[contact.j]);
        through_mean += 0.5 * row.impulse.dot(u_before + u);
        square += 0.5 * row.impulse.dot(u - u_free);
      }
      const Vec3& couple = couples_[static_cast<std::size_t>(c)];
      const Vec3 spin = j.spin - i.spin;
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

}  // namespace scree::resident
