// What the keys of one section must say together. Each rule runs once the keys themselves are right.
#pragma once

#include "sim/scene/keys.hpp"

namespace scree {

void check_time(const TimeSettings& time, const Node& node, Reader& reader);
void check_plane(const PlaneEntry& plane, const Node& node, Reader& reader);
void check_rotation(const RotationEntry& rotation, const Node& node, Reader& reader);
void check_motion(const MotionEntry& motion, const Node& node, Reader& reader);
void check_scatter(const ScatterEntry& scatter, const Node& node, Reader& reader);
void check_body(const BodyEntry& body, const Node& node, Reader& reader);
void check_force(const ForceEntry& force, const Node& node, Reader& reader);
void check_region(const Region& region, const Node& node, Reader& reader);
void check_orbit(const OrbitSettings& orbit, const Node& node, Reader& reader);
void check_keyframe(const CameraKeySettings& key, const Node& node, Reader& reader);
void check_render(const RenderSettings& render, const Node& node, Reader& reader);
void check_camera(const CameraSettings& camera, const Node& node, Reader& reader);
void check_check(const CheckEntry& check, const Node& node, Reader& reader);
template <class T>
void check_distribution(const Distribution<T>& sizes, const Node& node, Reader& reader);

}  // namespace scree
