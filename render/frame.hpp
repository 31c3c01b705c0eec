// What one picture shows.
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

/// Whether the colour of a body shows its material or its state: what stands still stays in the background,
/// and so do boundaries, turning or not.
inline bool is_colored(const BodyTable& bodies, std::size_t body) {
  return bodies.mobility[body] != Mobility::fixed && bodies.mobility[body] != Mobility::absent &&
         !is_surface(bodies.shape[body]);
}

/// A straight line over the bodies.
struct Line {
  Vec3 from = Vec3::Zero(), to = Vec3::Zero();  ///< m
  float width = 1;                              ///< pixels of a picture 720 high; grows with larger ones
  Color color = Color::Zero();                  ///< sRGB
  float where_hidden = 1;                       ///< opacity behind bodies, 0 to 1
};

struct Frame {
  Snapshot snapshot{};
  // By place in the snapshot; empty unless the colours ask for it.
  std::vector<double> force{};        ///< sum of the contact forces on the body (N)
  std::vector<std::int32_t> level{};  ///< of the hierarchical grid
  /// Names of the kinds that the colours stand for (materials, levels), in the order of the palette.
  std::vector<std::string> kinds{};
  std::vector<Line> lines{};                   ///< the later ones on top
  std::shared_ptr<const Geometry> geometry{};  ///< by id; null if no body's shape is general
};

}  // namespace scree::render
