// Rules that the keys of one section must fulfil together. Each rule runs after the keys have been found
// right by themselves.
#pragma once

#include "sim/scene/keys.hpp"
#include "sim/scene/time_grid.hpp"

#include <optional>

namespace scree {

void check_time(const TimeSettings& time, const Node& node, Reader& reader);
void check_plane(const PlaneEntry& plane, const Node& node, Reader& reader);
void check_mesh(const MeshEntry& mesh, const Node& node, Reader& reader);
void check_polyhedron(const PolyhedronEntry& polyhedron, const Node& node, Reader& reader);
void check_rotation(const RotationEntry& rotation, const Node& node, Reader& reader);
void check_oscillation(const Oscillation& oscillation, const Node& node, Reader& reader);
void check_motion_key(const MotionKeyEntry& key, const Node& node, Reader& reader);
void check_motion(const MotionEntry& motion, const Node& node, Reader& reader);
void check_servo(const ServoEntry& servo, const Node& node, Reader& reader);
void check_gravity(const GravityEntry& gravity, const Node& node, Reader& reader);
void check_scatter(const ScatterEntry& scatter, const Node& node, Reader& reader);
void check_emit(const EmitEntry& emit, const Node& node, Reader& reader);
void check_body(const BodyEntry& body, const Node& node, Reader& reader);
void check_force(const ForceEntry& force, const Node& node, Reader& reader);
void check_region(const Region& region, const Node& node, Reader& reader);
void check_world(const World& world, const Node& node, Reader& reader);
void check_orbit(const OrbitSettings& orbit, const Node& node, Reader& reader);
void check_keyframe(const CameraKeySettings& key, const Node& node, Reader& reader);
void check_periodic(const PeriodicEntry& periodic, const Node& node, Reader& reader);
/// Checks the other sections of a scene against its periods.
void check_in_period(const SceneEntry& scene, const Node& node, Reader& reader);
void check_precision(const SceneEntry& scene, const Node& node, Reader& reader);
void check_render(const RenderSettings& render, const Node& node, Reader& reader);
void check_camera(const CameraSettings& camera, const Node& node, Reader& reader);
void check_check(const CheckEntry& check, const Node& node, Reader& reader);
template <class T>
void check_distribution(const Distribution<T>& sizes, const Node& node, Reader& reader);

Period period_of(const PeriodicEntry& periodic);
/// Sets how far from its surface a body may search for others (Period::most_margin). The bodies must have
/// their sizes and their period. Fails if the bodies are too large for the period.
void fit_bodies(const PeriodicEntry& periodic, BodyTable& bodies, Reader& reader);

/// Returns the time span between the keys `from` and `until` of `node` (s; without `until` it has no end),
/// once the steps of the run are known. Fails unless the span holds a step.
TimeSpan time_span(double from, const std::optional<double>& until, const TimeGrid& grid, const Node& node,
                   Reader& reader);

}  // namespace scree
