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

/// The subject of a measure.
enum class MeasureSubject { body, mesh, run, region };

/// The contact load on all triangles of a mesh: contact impulses over the last step / step.
struct MeshLoad {
  Vec3 force;   ///< force (N)
  Vec3 torque;  ///< torque about the place of the mesh (N m)
};

/// The data from which the value of a measure is computed: the run, and the subject of the measure.
struct Measured {
  const Observation& run;
  const BodyState* body;      ///< the body; null unless the measure is of a body
  const MeshLoad* mesh;       ///< the load on the mesh; null unless the measure is of a mesh
  const RegionState* region;  ///< the region; null unless the measure is of a region
};

/// A row of the table of measures, for the parser, for the reference, and for evaluate().
struct MeasureInfo {
  std::string_view name;  ///< name without that of the body or region, and without the component
  MeasureSubject of;
  std::string_view unit;
  std::string_view help;
  double (*number)(const Measured&);  ///< the value, if it is a number
  Vec3 (*vector)(const Measured&);    ///< the value, if it is a vector; one of the two is null

  bool is_vector() const { return vector != nullptr; }
};
std::span<const MeasureInfo> measure_table();

struct Measure {
  const MeasureInfo* info = nullptr;  ///< the row of the table
  std::int32_t body = -1;             ///< the number of the body, or of the first one of a mesh; else -1
  std::int32_t triangles = 0;         ///< number of triangles, which are bodies, if the measure is of a mesh
  Vec3 to_place = Vec3::Zero();  ///< vector from the centre of a mesh's first triangle to the mesh's place,
                                 ///< at the start (m)
  std::int32_t region = -1;      ///< the number of the region; else -1
  Component component = Component::norm;  ///< component that is measured, if the measure is a vector
};

/// Returns whether a narrow phase is needed to know the measure: it is of overlaps or of pairs.
bool is_of_overlaps(const Measure& measure);

/// Returns whether the measure is of the contact forces on a body or a mesh.
bool is_of_forces(const Measure& measure);

/// Returns whether the name is the first word of measures that are not of a body (energy, region ...). No
/// body may have such a name.
bool is_measure_word(std::string_view name);

/// Parses a measure such as energy.total, momentum.x, puck.velocity.norm, bed[3].tilt, floor.torque.y or
/// region.exit.flux, with the names of the scene. Throws InputError, without a line and column, that names
/// the unknown word and the nearest known one.
Measure parse_measure(std::string_view text, const Scene& scene);

/// Returns the value of the measure in SI units. `body` returns the state of a body; it is called only for
/// measures of a body or of a mesh.
double evaluate(const Measure& measure, const Observation& observation,
                const std::function<BodyState(std::int32_t)>& body);

}  // namespace scree
