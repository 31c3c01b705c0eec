#include "bench/solvers/scree_contacts.hpp"

#include "core/space_phases.hpp"
#include "sim/response/contacts_on_host.hpp"
#include "sim/response/padding.hpp"
#include "sim/response/sweep_loop.hpp"

#include <algorithm>
#include <utility>

namespace scree::bench {

using namespace solver;

ScreeContacts::ScreeContacts(const ContactProblem& problem)
    : problem_(problem), padding_(static_cast<std::int32_t>(problem.bodies.size())) {
  std::vector<BodyRecord<double>> records;
  for (const ContactProblem::Body& of : problem.bodies) {
    BodyRecord<double>& record = records.emplace_back();
    record.velocity = v3<double>(of.velocity);
    record.inverse_mass = of.inverse_mass;
    record.spin = v3<double>(of.spin);
    record.inverse_inertia = of.inverse_inertia(0, 0);
  }
  records.push_back({});
  copy(free_, records);
  place_contacts();
}

SolverBody ScreeContacts::body(std::int32_t k) const {
  const ContactProblem::Body& of = problem_.bodies[static_cast<std::size_t>(k)];
  return {of.velocity, of.spin, of.inverse_mass, of.inverse_inertia};
}

/// Returns whether a contact is stored as one of balls. A contact of a ball with a turning wall is not,
/// because its arms are not along the normal alone.
bool ScreeContacts::is_of_balls(const ContactProblem::Contact& contact) const {
  const auto is_ball = [&](std::int32_t k) {
    const ContactProblem::Body& of = problem_.bodies[static_cast<std::size_t>(k)];
    return of.inverse_mass > 0 || of.spin.isZero(0);
  };
  return contact.balls && is_ball(contact.i) && is_ball(contact.j);
}

/// Gives each contact of one kind the lowest free colour, in the order of the contacts; contacts of the other
/// kind get -1.
std::vector<int> ScreeContacts::color_contacts(bool balls) {
  std::vector<std::vector<bool>> taken(problem_.bodies.size());
  std::vector<int> colors;
  for (const ContactProblem::Contact& contact : problem_.contacts) {
    colors.push_back(-1);
    if (is_of_balls(contact) != balls) continue;
    const auto is_taken = [&](std::int32_t k, std::size_t color) {
      const auto& of = taken[static_cast<std::size_t>(k)];
      return body(k).is_free() && color < of.size() && of[color];
    };
    std::size_t color = 0;
    while (is_taken(contact.i, color) || is_taken(contact.j, color)) ++color;
    for (const std::int32_t k : {contact.i, contact.j}) {
      auto& of = taken[static_cast<std::size_t>(k)];
      if (of.size() <= color) of.resize(color + 1);
      of[color] = true;
    }
    colors.back() = static_cast<int>(color);
  }
  return colors;
}

void ScreeContacts::place_contacts() {
  place_.resize(problem_.contacts.size());
  ColorRanges ranges[2];
  for (const bool balls : {true, false}) {
    const std::vector<int> colors = color_contacts(balls);
    const int count = colors.empty() ? 0 : *std::ranges::max_element(colors) + 1;
    for (int color = 0; color < count; ++color) {
      std::int64_t next = ranges[balls].places();
      for (std::size_t c = 0; c < colors.size(); ++c)
        if (colors[c] == color) place_[c] = {balls, next++};
      ranges[balls].add(next - ranges[balls].places());
    }
  }
  store_.take_balls(ranges[true]);
  store_.take_points(ranges[false]);
  const std::int64_t balls = ranges[true].places();
  slots_.resize(static_cast<std::size_t>(balls + ranges[false].places()));
  for (const View<std::int32_t>& slots : {store_.balls().slot, store_.points().slot})
    std::ranges::fill(slots, Slot::empty);
  for (std::size_t c = 0; c < place_.size(); ++c) {
    const ContactProblem::Contact& contact = problem_.contacts[c];
    const auto [of_balls, at] = place_[c];
    slots_[static_cast<std::size_t>(of_balls ? at : balls + at)] = {
        .i = contact.i, .j = contact.j, .end_i = contact.i, .end_j = contact.j};
    if (of_balls) {
      fill_ball(contact, at);
    } else {
      fill_points(contact, at);
    }
  }
  for (std::int64_t b = 0; b < balls / simd::width; ++b)
    PadBalls<double>{store_.balls(), {}, false, padding_}(b);
  for (std::int64_t b = 0; b < ranges[false].places() / simd::width; ++b)
    PadPoints<double>{store_.points(), {}, false, padding_}(b);
}

void ScreeContacts::fill_ball(const ContactProblem::Contact& contact, std::int64_t to) {
  using C = BallContacts<double>;
  const C all = store_.balls();
  const ContactProblem::Point& point = problem_.points[static_cast<std::size_t>(contact.first_point)];
  const ContactRow row = make_ball_row(point.arm_i, point.arm_j, 0, body(contact.i), body(contact.j));
  all.ends[to] = {contact.i, contact.j};
  all.slot[to] = static_cast<std::int32_t>(to);
  all.flags[to] = 0;
  all.fields.set(C::normal, to, v3<double>(contact.normal));
  all.fields.at(C::arm_i, to) = point.arm_i.dot(contact.normal);
  all.fields.at(C::arm_j, to) = point.arm_j.dot(contact.normal);
  all.fields.at(C::friction, to) = contact.friction;
  all.fields.at(C::target, to) = point.target;
  all.fields.at(C::normal_mass, to) = row.normal_mass;
  all.fields.at(C::tangent_mass, to) = row.tangent_mass;
}

void ScreeContacts::fill_points(const ContactProblem::Contact& contact, std::int64_t to) {
  using C = PointContacts<double>;
  const C all = store_.points();
  const SolverBody i = body(contact.i), j = body(contact.j);
  const auto put = [&](const auto& fields, int first, const Mat3& m) {
    const double elements[] = {m(0, 0), m(1, 1), m(2, 2), m(0, 1), m(0, 2), m(1, 2)};
    for (int e = 0; e < 6; ++e) fields.at(first + e, to) = elements[e];
  };
  all.ends[to] = {contact.i, contact.j};
  all.slot[to] = static_cast<std::int32_t>(to);
  all.flags[to] = 0;
  all.points[to] = contact.count;
  all.fields.set(C::normal, to, v3<double>(contact.normal));
  all.fields.at(C::friction, to) = contact.friction;
  all.fields.at(C::cap, to) = 1;
  put(all.fields, C::inertia_i, i.inverse_inertia);
  put(all.fields, C::inertia_j, j.inverse_inertia);
  for (int k = 0; k < contact.count; ++k) {
    const ContactProblem::Point& point = problem_.points[static_cast<std::size_t>(contact.first_point + k)];
    RowCoupling coupling;
    const ContactRow row = make_row(contact.normal, point.arm_i, point.arm_j, 0, i, j, coupling);
    const auto& f = all.point_fields;
    const auto at = [k](auto field) { return C::at_point(k, field); };
    f.set(at(C::arm_i), to, v3<double>(point.arm_i));
    f.set(at(C::arm_j), to, v3<double>(point.arm_j));
    put(f, at(C::stick), coupling.stick);
    f.set(at(C::coupling), to, v3<double>(coupling.normal));
    f.at(at(C::target), to) = point.target;
    f.at(at(C::normal_mass), to) = row.normal_mass;
    f.at(at(C::tangent_mass), to) = row.tangent_mass;
  }
}

void ScreeContacts::reset() {
  copy(solver_, free_);
  last_.resize(free_.size());
  for (const auto& [of_balls, to] : place_) {
    if (of_balls) {
      using C = BallContacts<double>;
      for (const int field : {C::impulse, C::last}) store_.balls().fields.set(field, to, {});
      continue;
    }
    using C = PointContacts<double>;
    for (int k = 0; k < store_.points().points[to]; ++k)
      for (const auto field : {C::impulse, C::last})
        store_.points().point_fields.set(C::at_point(k, field), to, {});
  }
}

bool ScreeContacts::sweep(const SweepPlan& plan) {
  copy(solver_, free_);
  const ImpulsePhases<double, false> phases{.ball_colors = ColorPhases(store_.ball_colors(), simd::width),
                                            .point_colors = ColorPhases(store_.point_colors(), simd::width),
                                            .balls = store_.balls(),
                                            .points = store_.points(),
                                            .rolls = false,
                                            .ball_rolling = {},
                                            .point_rolling = {},
                                            .bodies = solver_.data(),
                                            .last = last_.data(),
                                            .body_count = solver_.size(),
                                            .hubs = {},
                                            .guides = {},
                                            .least = plan.least,
                                            .most = plan.most,
                                            .block_sweeps = plan.block_sweeps,
                                            .tolerance = plan.tolerance,
                                            .first_with_momentum = plan.first_with_momentum};
  return parallel::run_in_phases<Host>("sweeps", phases, SweepState{}).converged;
}

bool ScreeContacts::solve_islands(double tolerance, const DirectLimits& limits, std::int64_t& solved,
                                  std::int64_t& failed) {
  Inspection<double> seen;
  seen.places = {slots_.data(), static_cast<std::int64_t>(slots_.size())};
  seen.free = std::as_const(free_).view();
  seen.contacts = &store_;
  seen.first_wall_point = seen.first_part = free_.size();
  seen.first_place = store_.ball_colors().places();
  ContactsOnHost<double> contacts(seen, {});
  const bool all = contacts.solve(tolerance, limits, nullptr, solved, failed);
  contacts.put_back();
  return all;
}

PointVectors ScreeContacts::impulses() {
  PointVectors impulses(problem_.points.size());
  for (std::size_t c = 0; c < place_.size(); ++c) {
    const ContactProblem::Contact& contact = problem_.contacts[c];
    const Mat3 frame = frame_of(contact);
    for (int k = 0; k < contact.count; ++k) {
      using B = BallContacts<double>;
      using P = PointContacts<double>;
      const V3<double> impulse =
          place_[c].balls ? store_.balls().fields.vector(B::impulse, place_[c].at)
                          : store_.points().point_fields.vector(P::at_point(k, P::impulse), place_[c].at);
      impulses[static_cast<std::size_t>(contact.first_point + k)] = frame.transpose() * vec3(impulse);
    }
  }
  return impulses;
}

}  // namespace scree::bench
