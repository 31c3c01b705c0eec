// A picture in memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace scree::render {

/// A picture of 8-bit sRGB, rows from the top, three bytes per pixel.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;
};

/// Returns the three bytes of a pixel inside the image.
inline std::uint8_t* pixel_of(Image& image, int x, int y) {
  return &image.rgb[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                         static_cast<std::size_t>(x))];
}

}  // namespace scree::render
