// Text on pictures.
#pragma once

#include "render/color.hpp"
#include "render/image.hpp"

#include <memory>
#include <string_view>

namespace scree::render {

/// One size of the font that comes with the program (DejaVu Sans).
class Font {
 public:
  /// `size`: of the em, in pixels, at least 1. Throws RunError.
  explicit Font(int size);
  ~Font();
  Font(Font&&) noexcept;

  int size() const { return size_; }
  /// Pixels from the start of the text to its end.
  int width(std::string_view utf8) const;
  /// Draws with smooth edges; (x, y) is the start of the base line, in pixels from the upper left corner of
  /// the picture. What falls outside the picture is left out. `color`: sRGB.
  void draw(Image& image, int x, int y, std::string_view utf8, const Color& color) const;

 private:
  struct Face;
  std::unique_ptr<Face> face_;
  int size_;
};

/// Mixes a rectangle with a colour (sRGB); the part outside the picture is left out.
void fill(Image& image, int x, int y, int width, int height, const Color& color, float opacity = 1);

}  // namespace scree::render
