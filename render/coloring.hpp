// What the colours of bodies mean.
#pragma once

#include "render/frame.hpp"

#include <array>
#include <optional>
#include <vector>

namespace scree::render {

enum class ColorBy { material, speed, size, kinetic_energy, force, level, id };

/// Whether the colours stand for numbers on a scale, rather than for kinds.
bool is_scale(ColorBy color_by);

/// The number behind a body's colour in SI units: speed, bounding radius, kinetic energy of translation (0
/// for bodies without a mass) or contact force; 0 for kinds.
double value_of(const Frame& frame, ColorBy color_by, std::size_t body);

/// The range that shows a frame well: of the moving bodies, size from its 2nd to its 98th percentile, other
/// values from 0 to the 98th. Never empty. {0, 1} for kinds.
std::array<double, 2> value_range(const Frame& frame, ColorBy color_by);

/// Colours of bodies in linear light.
class Painter {
 public:
  /// `palette`: sRGB, by material; starts over after the last. `muted`: 0 to 1, how much of the colours is
  /// taken away so that lines over them stand out.
  Painter(const Frame& frame, ColorBy color_by, const std::array<double, 2>& range,
          const std::vector<Color>& palette, float muted = 0);

  Color operator()(std::size_t body) const;

 private:
  Color colored(std::size_t body) const;

  const Frame& frame_;
  ColorBy color_by_;
  std::array<double, 2> range_;
  std::vector<Color> palette_;
  float muted_;
};

}  // namespace scree::render
