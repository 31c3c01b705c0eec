// A picture in memory.
#pragma once

#include <cstdint>
#include <vector>

namespace scree::render {

/// 8-bit sRGB, rows from the top, three bytes per pixel.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;
};

}  // namespace scree::render
