#include "sim/bodies/presence.hpp"

#include "sim/bodies/coming_and_going.hpp"
#include "sim/bodies/motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <numeric>
#include <utility>

namespace scree {

namespace {

void set_present(std::int32_t k, const BodyTable& start, const BodyView& views) {
  const std::size_t from = index_of(views.id[k]);
  views.mobility[k] = start.mobility[from];
  views.inverse_mass[k] = start.inverse_mass[from];
  views.inverse_inertia[k] = start.inverse_inertia[from];
}

/// Returns the item of a list, ordered by ascending body, whose range holds the body; null if there is none.
template <class T, class RangeOf>
const T* find_range(const std::vector<T>& list, std::int32_t body, RangeOf range_of) {
  const auto after = std::upper_bound(list.begin(), list.end(), body, [&](std::int32_t id, const T& item) {
    return id < range_of(item).first;
  });
  if (after == list.begin()) return nullptr;
  const T& item = *std::prev(after);
  return body < range_of(item).first + range_of(item).count ? &item : nullptr;
}

}  // namespace

Presence::Presence(const Scene& scene, const TimeGrid& grid) : count_(scene.bodies.count()) {
  for (const Lifetime& lifetime : scene.lifetimes) {
    windows_.push_back({lifetime.bodies, grid.steps_in(lifetime.span)});
    if (!windows_.back().steps.holds(0)) count_ -= lifetime.bodies.count;
  }
  for (const Emitter& emitter : scene.emitters) {
    emissions_.emplace_back(emitter, grid);
    count_ -= emitter.bodies.count;
  }
}

const Presence::Window* Presence::window_of(std::int32_t body) const {
  return find_range(windows_, body, [](const Window& window) { return window.bodies; });
}

const Emission* Presence::emission_of(std::int32_t body) const {
  return find_range(emissions_, body, [](const Emission& emission) { return emission.bodies(); });
}

std::int64_t Presence::requested() const {
  return std::transform_reduce(emissions_.begin(), emissions_.end(), std::int64_t{0}, std::plus<>(),
                               [](const Emission& emission) { return emission.requested(); });
}

std::int64_t Presence::emitted() const {
  return std::transform_reduce(emissions_.begin(), emissions_.end(), std::int64_t{0}, std::plus<>(),
                               [](const Emission& emission) { return emission.emitted(); });
}

void Presence::archive(Archive& archive) {
  archive("count", count_);
  for (std::size_t e = 0; e < emissions_.size(); ++e)
    archive.part(fmt::format("emission{}", e).c_str(), emissions_[e]);
}

bool Presence::holds(std::int32_t body, std::int64_t step) const {
  if (const Emission* emission = emission_of(body)) return emission->holds(body, step);
  const Window* window = window_of(body);
  return window == nullptr || window->steps.holds(step);
}

std::int64_t Presence::first_step(std::int32_t body) const {
  const Window* window = window_of(body);
  return window == nullptr ? 0 : window->steps.first;
}

void Presence::begin(Bodies<Host>& bodies) const {
  const BodyView views = view_of(bodies);
  for (const Window& window : windows_) {
    if (window.steps.holds(0)) continue;
    for (std::int32_t k = 0; k < window.bodies.count; ++k)
      set_absent(views.place(BodyNumber{window.bodies.first + k}), views);
  }
  for (const Emission& emission : emissions_) {
    for (std::int32_t k = 0; k < emission.bodies().count; ++k)
      set_absent(views.place(BodyNumber{emission.bodies().first + k}), views);
  }
}

bool Presence::changes(std::int64_t step) const {
  return std::any_of(windows_.begin(), windows_.end(),
                     [step](const Window& window) { return window.changes_at(step); });
}

/// Adds mass, energy and momenta of a body to the change, or subtracts them (sign: 1 or -1), and counts it.
void Presence::account(const ConstBodyView& bodies, std::int64_t k, double sign, const Scene& scene,
                       const PotentialField& field, Change& change) {
  const Totals body = totals_of_body(bodies, k, field.gravity, field.reference);
  change.exchange.mass += sign * body.mass;
  change.exchange.energy += sign * (body.kinetic() + body.potential);
  change.exchange.momentum += sign * body.momentum;
  change.exchange.angular_momentum += sign * body.angular_momentum;
  const auto id = static_cast<std::int32_t>(bodies.id[k]);
  const Emission* emission = emission_of(id);
  const Vec3& start = emission ? emission->place(id) : scene.bodies.position[static_cast<std::size_t>(id)];
  change.first_potential -= sign * body.mass * field.gravity.dot(start - field.reference);
  count_ += sign > 0 ? 1 : -1;
}

Presence::Change Presence::update(std::int64_t step, const Scene& scene, const PotentialField& field,
                                  Bodies<Host>& bodies) {
  Change change;
  const BodyView views = view_of(bodies);
  for (const Window& window : windows_) {
    if (!window.changes_at(step)) continue;
    const bool comes = window.steps.first == step;
    for (std::int32_t number = 0; number < window.bodies.count; ++number) {
      const std::int32_t k = views.place(BodyNumber{window.bodies.first + number});
      if (comes) set_present(k, scene.bodies, views);
      if (views.mobility[k] == Mobility::absent) continue;  // the body was removed earlier for another reason
      account(view_of(std::as_const(bodies)), k, comes ? 1 : -1, scene, field, change);
      if (!comes) set_absent(k, views);
    }
  }
  return change;
}

Presence::Change Presence::account_all(const BodyTable& table, double sign, const Scene& scene,
                                       const PotentialField& field) {
  Change change;
  Bodies<Host> bodies;
  copy_bodies(bodies, table);
  for (std::int64_t k = 0; k < bodies.count(); ++k)
    account(view_of(std::as_const(bodies)), k, sign, scene, field, change);
  return change;
}

Presence::Change Presence::account_for_removed(const BodyTable& gone, const Scene& scene,
                                               const PotentialField& field) {
  return account_all(gone, -1, scene, field);
}

Presence::Change Presence::account_for_added(const BodyTable& come, const Scene& scene,
                                             const PotentialField& field) {
  return account_all(come, 1, scene, field);
}

}  // namespace scree
