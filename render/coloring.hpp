// The meaning of the bodies' colours: which quantity or kind they show, and in which range.
#pragma once

#include "render/frame.hpp"

#include <array>
#include <optional>
#include <vector>

namespace scree::render {

enum class ColorBy { material, speed, size, kinetic_energy, force, level, id };

/// Returns whether the colours show numbers on a scale, rather than kinds.
bool is_scale(ColorBy color_by);

/// Returns the number that a body's colour shows, in SI units: speed, bounding radius, kinetic energy of
/// translation (0 for bodies without a mass) or contact force; 0 for kinds.
double value_of(const Frame& frame, ColorBy color_by, std::size_t body);

/// Returns the range that shows a frame well, over the moving bodies: for the size from its 2nd to its 98th
/// percentile, for other values from 0 to the 98th. The range is never empty; it is {0, 1} for kinds.
std::array<double, 2> value_range(const Frame& frame, ColorBy color_by);

/// Gives the colours of bodies in linear light.
class Painter {
 public:
  /// `palette` holds sRGB colours by material; it starts over after the last. `muted`, from 0 to 1, is the
  /// share of the colours that is taken away so that lines over them stand out.
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
