// What the keys of one section must say together. Each rule runs once the keys themselves are right.
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
/// The sections of a scene beside its periods.
void check_in_period(const SceneEntry& scene, const Node& node, Reader& reader);
void check_precision(const SceneEntry& scene, const Node& node, Reader& reader);
void check_render(const RenderSettings& render, const Node& node, Reader& reader);
void check_camera(const CameraSettings& camera, const Node& node, Reader& reader);
void check_check(const CheckEntry& check, const Node& node, Reader& reader);
template <class T>
void check_distribution(const Distribution<T>& sizes, const Node& node, Reader& reader);

Period period_of(const PeriodicEntry& periodic);
/// Sets how far the bodies, which have their sizes and their period, may look for others; fails where they
/// are too large for it.
void fit_bodies(const PeriodicEntry& periodic, BodyTable& bodies, Reader& reader);

/// Of the keys from and until of `node` (s; never, if there is none), once the steps of the run are known:
/// the span must hold one.
TimeSpan time_span(double from, const std::optional<double>& until, const TimeGrid& grid, const Node& node,
                   Reader& reader);

}  // namespace scree
