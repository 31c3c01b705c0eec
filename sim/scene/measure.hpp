// The measures of the scene language: their grammar, and what each is worth.
#pragma once

#include "sim/observe/observation.hpp"
#include "sim/scene/scene.hpp"

#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>

namespace scree {

enum class MeasureKind {
  // Of one body; see BodyState.
  position,
  velocity,
  spin,
  acceleration,
  force,
  tilt,
  // Of a mesh: sums over its triangles.
  mesh_force,
  mesh_torque,
  // Of the whole run; see Observation.
  energy_total,
  energy_kinetic,
  energy_linear,
  energy_angular,
  energy_potential,
  energy_unexplained,
  energy_work,
  energy_integration,
  energy_exchange,
  dissipated_restitution,
  dissipated_friction,
  dissipated_correction,
  momentum,
  angular_momentum,
  centre,
  penetration_max,
  penetration_mean,
  penetration_p99,
  penetration_relative_max,
  penetration_relative_mean,
  gap_mean,
  contacts_count,
  pairs_count,
  bodies_count,
  speed_max,
  speed_rms,
  speed_kurtosis,
  impacts_count,
  coordination_mean,
  guards_redone,
  guards_left,
  guards_sweeps,
  guards_impacts,
  guards_newton,
  guards_gjk,
  emission_requested,
  emission_emitted,
  // Of a region; see RegionState.
  region_count,
  region_fraction,
  region_flux,
  region_removed,
  region_removed_mass,
};

enum class Component { x, y, z, norm };

struct Measure {
  MeasureKind kind = MeasureKind::energy_total;
  std::int32_t body = -1;                 ///< its number in the scene; -1 for other measures
  std::int32_t triangles = 0;             ///< of a mesh: bodies from that one on
  Vec3 to_place = Vec3::Zero();           ///< of a mesh: from the first triangle's centre, at the start (m)
  std::int32_t region = -1;               ///< likewise
  Component component = Component::norm;  ///< of a vector
};

enum class MeasureSubject { body, mesh, run, region };

/// What there is to measure, for the parser and for the reference.
struct MeasureInfo {
  MeasureKind kind;
  std::string_view name;  ///< without the name of the body or region, and without the component
  MeasureSubject of;
  bool is_vector;
  std::string_view unit;
  std::string_view help;
};
const std::vector<MeasureInfo>& measure_table();

/// Whether it is of overlaps, or of pairs: a narrow phase is needed to know it.
bool is_of_overlaps(const Measure& measure);

/// True for the first words of measures that are of no body (energy, region ...): no body may be called so.
bool is_measure_word(std::string_view name);

/// Parses energy.total, momentum.x, puck.velocity.norm, bed[3].tilt, floor.torque.y, region.exit.flux; the
/// names are those of the scene. Throws InputError, without a place, that names what is unknown and the
/// nearest known word.
Measure parse_measure(std::string_view text, const Scene& scene);

/// The measure's value in SI units. `body` is asked for the state of a body only for measures of it, or of
/// its mesh.
double evaluate(const Measure& measure, const Observation& observation,
                const std::function<BodyState(std::int32_t)>& body);

}  // namespace scree
