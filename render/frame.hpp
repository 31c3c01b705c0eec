// The content of one picture.
#pragma once

#include "core/geometry.hpp"
#include "core/snapshot.hpp"
#include "render/color.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace scree::render {

/// Returns whether the colour of a body shows its material or its state. Fixed bodies stay in the background,
/// and so do boundaries, turning or not.
inline bool is_colored(const BodyTable& bodies, std::size_t body) {
  return bodies.mobility[body] != Mobility::fixed && bodies.mobility[body] != Mobility::absent &&
         !is_surface(bodies.shape[body]);
}

/// A straight line drawn over the bodies.
struct Line {
  Vec3 from = Vec3::Zero(), to = Vec3::Zero();  ///< ends (m)
  float width = 1;              ///< width in pixels of a picture 720 high; larger pictures have wider lines
  Color color = Color::Zero();  ///< sRGB
  float where_hidden = 1;       ///< opacity where bodies hide the line, 0 to 1
};

struct Frame {
  Snapshot snapshot{};
  // Values by place in the snapshot; empty unless the colours need them.
  std::vector<double> force{};        ///< sum of the contact forces on the body (N)
  std::vector<std::int32_t> level{};  ///< level of the body in the hierarchical grid
  /// Names of the kinds that the colours stand for (materials, levels), in the order of the palette.
  std::vector<std::string> kinds{};
  std::vector<Line> lines{};                   ///< lines, of which later ones are drawn over earlier ones
  std::shared_ptr<const Geometry> geometry{};  ///< geometry by body id; null if no body's shape is general
};

}  // namespace scree::render
