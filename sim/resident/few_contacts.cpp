#include "sim/resident/few_contacts.hpp"

#include <algorithm>
#include <utility>

namespace scree::resident {

template <class Real>
FewContacts<Real>::FewContacts(Inspection<Real>& seen) : seen_(seen) {
  const auto n = static_cast<std::int64_t>(seen.free.size());
  bodies_.resize(n);
  velocity_.resize(n);
  spin_.resize(n);
  for (std::int64_t k = 0; k < n; ++k) {
    const BodyRecord<Real>& free = seen.free[static_cast<std::size_t>(k)];
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
                        .count = static_cast<std::int32_t>(c.points.size()),
                        .loaded = true,
                        .flying = false,
                        .balls = c.balls,
                        .aligned = c.balls,
                        .free_ends = static_cast<std::int8_t>(i.is_free() + j.is_free()),
                        .normal = c.normal,
                        .friction = c.friction,
                        .rolling_reach = 0,
                        .lead = 0,
                        .size = 0});
    place_.push_back(c.place);
    for (const SeenPoint& point : c.points) {
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
  for (const Contact& contact : contacts_.view()) {
    for (int k = 0; k < contact.count; ++k) {
      const ContactRow& row = rows_.view()[contact.first_row + k];
      row.push(row.impulse, bodies_.view()[contact.i], bodies_.view()[contact.j]);
    }
  }
  islands_.find(std::as_const(contacts_).view(), std::as_const(bodies_).view());
}

template <class Real>
bool FewContacts<Real>::solve(double tolerance, const DirectLimits& limits, std::int64_t& solved,
                              std::int64_t& failed) {
  bool all = true;
  for (std::int64_t island = 0; island < islands_.count(); ++island) {
    const IslandProblem problem{.contacts = std::as_const(contacts_).view(),
                                .rows = rows_.view(),
                                .solver = bodies_.view(),
                                .velocity = std::as_const(velocity_).view(),
                                .spin = std::as_const(spin_).view(),
                                .islands = islands_,
                                .island = island};
    if (natural_residual(problem).within(tolerance)) continue;
    const DirectOutcome outcome = solve_directly(problem, tolerance, limits);
    solved += outcome == DirectOutcome::solved;
    failed += outcome == DirectOutcome::failed;
    all = all && outcome == DirectOutcome::solved;
  }
  return all;
}

template <class Real>
std::vector<BodyRecord<Real>> FewContacts<Real>::put_back() {
  using B = BallContacts<Real>;
  using P = PointContacts<Real>;
  const B balls = seen_.contacts.balls();
  const P points = seen_.contacts.points();
  std::vector<BodyRecord<Real>> bodies = seen_.free;
  const auto move = [&](std::int32_t end, std::int32_t body) {
    bodies[static_cast<std::size_t>(end)].velocity = v3<Real>(bodies_.view()[body].velocity);
    bodies[static_cast<std::size_t>(end)].spin = v3<Real>(bodies_.view()[body].spin);
  };
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
    const Ends& ends = contact.balls ? balls.ends[place] : points.ends[place];
    for (const auto& [end, body] : {std::pair(ends.i, contact.i), std::pair(ends.j, contact.j)}) {
      if (!bodies_.view()[body].is_free()) continue;
      move(body, body);
      move(end, body);
    }
  }
  return bodies;
}

template class FewContacts<double>;
template class FewContacts<float>;

}  // namespace scree::resident
