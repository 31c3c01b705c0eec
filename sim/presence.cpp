#include "sim/presence.hpp"

#include "sim/dynamics/leaving.hpp"
#include "sim/dynamics/motion.hpp"

#include <algorithm>
#include <utility>

namespace scree {

namespace {

void set_present(std::int64_t k, const BodyTable& start, const BodyView& views) {
  const auto from = static_cast<std::size_t>(k);
  views.mobility[k] = start.mobility[from];
  views.inverse_mass[k] = start.inverse_mass[from];
  views.inverse_inertia[k] = start.inverse_inertia[from];
}

}  // namespace

Presence::Presence(const Scene& scene, const TimeGrid& grid) : count_(scene.bodies.count()) {
  for (const Lifetime& lifetime : scene.lifetimes) {
    windows_.push_back({lifetime.bodies, grid.steps_in(lifetime.span)});
    if (!windows_.back().steps.holds(0)) count_ -= lifetime.bodies.count;
  }
}

const Presence::Window* Presence::window_of(std::int32_t body) const {
  const auto after = std::upper_bound(windows_.begin(), windows_.end(), body,
                                      [](std::int32_t id, const Window& w) { return id < w.bodies.first; });
  if (after == windows_.begin()) return nullptr;
  const Window& window = *std::prev(after);
  return body < window.bodies.first + window.bodies.count ? &window : nullptr;
}

bool Presence::holds(std::int32_t body, std::int64_t step) const {
  const Window* window = window_of(body);
  return window == nullptr || window->steps.holds(step);
}

std::int64_t Presence::first_step(std::int32_t body) const {
  const Window* window = window_of(body);
  return window == nullptr ? 0 : window->steps.first;
}

void Presence::begin(Bodies<Host>& bodies) const {
  for (const Window& window : windows_) {
    if (window.steps.holds(0)) continue;
    for (std::int32_t k = 0; k < window.bodies.count; ++k)
      set_absent(window.bodies.first + k, view_of(bodies));
  }
}

bool Presence::changes(std::int64_t step) const {
  return std::any_of(windows_.begin(), windows_.end(),
                     [step](const Window& window) { return window.changes_at(step); });
}

/// Adds what a body has, or takes it away.
void Presence::book(const ConstBodyView& bodies, std::int64_t k, double sign, const Scene& scene,
                    const Vec3& reference, Change& change) {
  const Totals body = totals_of_body(bodies, k, scene.gravity, reference);
  change.exchange.mass += sign * body.mass;
  change.exchange.energy += sign * (body.kinetic() + body.potential);
  change.exchange.momentum += sign * body.momentum;
  change.exchange.angular_momentum += sign * body.angular_momentum;
  const Vec3 start = scene.bodies.position[static_cast<std::size_t>(bodies.id[k])] - reference;
  change.first_potential -= sign * body.mass * scene.gravity.dot(start);
  count_ += sign > 0 ? 1 : -1;
}

Presence::Change Presence::update(std::int64_t step, const Scene& scene, const Vec3& reference,
                                  Bodies<Host>& bodies) {
  Change change;
  const BodyView views = view_of(bodies);
  for (const Window& window : windows_) {
    if (!window.changes_at(step)) continue;
    const bool comes = window.steps.first == step;
    for (std::int64_t k = window.bodies.first; k < window.bodies.first + window.bodies.count; ++k) {
      if (comes) set_present(k, scene.bodies, views);
      if (views.mobility[k] == Mobility::absent) continue;  // it has left before its time
      book(view_of(std::as_const(bodies)), k, comes ? 1 : -1, scene, reference, change);
      if (!comes) set_absent(k, views);
    }
  }
  return change;
}

Presence::Change Presence::take_leave_of(const BodyTable& gone, const Scene& scene, const Vec3& reference) {
  Change change;
  Bodies<Host> bodies;
  copy_bodies(bodies, gone);
  for (std::int64_t k = 0; k < bodies.count(); ++k)
    book(view_of(std::as_const(bodies)), k, -1, scene, reference, change);
  return change;
}

}  // namespace scree
