// The measures of the scene language: their table, their parser and their values.
#pragma once

#include "sim/observe/observation.hpp"
#include "sim/scene/scene.hpp"

#include <cstdint>
#include <functional>
#include <span>
#include <string_view>

namespace scree {

enum class Component { x, y, z, norm };

/// What a measure is taken from.
enum class MeasureSubject { body, mesh, run, region };

/// The contact impulses on all triangles of a mesh over the last step / step.
struct MeshLoad {
  Vec3 force;   ///< N
  Vec3 torque;  ///< about the place of the mesh (N m)
};

/// What the value of a measure is computed from: the run, and what the measure is of.
struct Measured {
  const Observation& run;
  const BodyState* body;      ///< null unless the measure is of a body
  const MeshLoad* mesh;       ///< null unless the measure is of a mesh
  const RegionState* region;  ///< null unless the measure is of a region
};

/// A row of the table of measures, for the parser, for the reference, and for evaluate().
struct MeasureInfo {
  std::string_view name;  ///< without the name of the body or region, and without the component
  MeasureSubject of;
  std::string_view unit;
  std::string_view help;
  double (*number)(const Measured&);  ///< the value, if it is a number
  Vec3 (*vector)(const Measured&);    ///< the value, if it is a vector; one of the two is null

  bool is_vector() const { return vector != nullptr; }
};
std::span<const MeasureInfo> measure_table();

struct Measure {
  const MeasureInfo* info = nullptr;      ///< the row of the table
  std::int32_t body = -1;                 ///< the number of the body, or of the first one of a mesh; else -1
  std::int32_t triangles = 0;             ///< of a mesh: the number of its bodies
  Vec3 to_place = Vec3::Zero();           ///< of a mesh: from the first triangle's centre, at the start (m)
  std::int32_t region = -1;               ///< the number of the region; else -1
  Component component = Component::norm;  ///< of a vector
};

/// Whether a narrow phase is needed to know the measure: it is of overlaps or of pairs.
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
