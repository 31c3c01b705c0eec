#include "sim/step/step_failure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace scree {

namespace {

constexpr std::size_t most_named = 8;

bool is_in_range(const BodyTable& bodies, std::size_t k) {
  return (bodies.position[k].array().abs() <= std::numeric_limits<float>::max()).all() &&
         bodies.orientation[k].coeffs().allFinite() && bodies.velocity[k].allFinite() &&
         bodies.spin[k].allFinite();
}

/// Returns the scene's name for a body; empty if it has none.
std::string given_name(std::int32_t body, const Scene& scene) {
  const auto named =
      std::ranges::find(scene.body_names, body, [](const auto& entry) { return entry.second; });
  return named == scene.body_names.end() ? "" : named->first;
}

}  // namespace

StepFailure::StepFailure(const std::string& what, std::vector<std::int32_t> bodies)
    : RunError(what), bodies_(std::move(bodies)) {
  bodies_.resize(std::min(bodies_.size(), most_named));
}

std::vector<std::int32_t> bodies_out_of_range(const BodyTable& bodies) {
  std::vector<std::int32_t> found;
  for (std::size_t k = 0; k < bodies.position.size(); ++k) {
    if (bodies.mobility[k] != Mobility::absent && !is_in_range(bodies, k))
      found.push_back(static_cast<std::int32_t>(bodies.id[k]));
  }
  return found;
}

std::vector<std::int32_t> by_kinetic_energy(const BodyTable& bodies) {
  std::vector<std::pair<double, std::int32_t>> free;
  for (std::size_t k = 0; k < bodies.position.size(); ++k) {
    if (bodies.mobility[k] != Mobility::free) continue;
    free.emplace_back(-bodies.velocity[k].squaredNorm() / bodies.inverse_mass[k],
                      static_cast<std::int32_t>(bodies.id[k]));
  }
  std::ranges::sort(free);
  std::vector<std::int32_t> ids;
  for (const auto& [energy, id] : free) ids.push_back(id);
  return ids;
}

std::string words_for(const std::vector<std::int32_t>& bodies, const Scene& scene) {
  std::string words;
  for (std::size_t k = 0; k < std::min(bodies.size(), most_named); ++k) {
    const std::string name = given_name(bodies[k], scene);
    words += k == 0 ? "" : ", ";
    words += name.empty() ? fmt::format("body {}", bodies[k]) : fmt::format("{} (body {})", name, bodies[k]);
  }
  if (bodies.size() > most_named) words += fmt::format(" and {} more", bodies.size() - most_named);
  return words;
}

}  // namespace scree
