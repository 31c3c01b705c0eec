// The drawing of text on pictures.
#pragma once

#include "render/color.hpp"
#include "render/image.hpp"

#include <memory>
#include <string_view>

namespace scree::render {

/// The font that comes with the program (DejaVu Sans), at one size.
class Font {
 public:
  /// `size` is that of the em in pixels, at least 1. Throws RunError if FreeType cannot load the font.
  explicit Font(int size);
  ~Font();
  Font(Font&&) noexcept;

  int size() const { return size_; }
  /// Returns the width of the text, from its start to its end (pixels).
  int width(std::string_view utf8) const;
  /// Draws text with smooth edges. (x, y) is the start of the base line, in pixels from the upper left corner
  /// of the picture. Parts outside the picture are left out. `color` is sRGB.
  void draw(Image& image, int x, int y, std::string_view utf8, const Color& color) const;

 private:
  struct Face;
  std::unique_ptr<Face> face_;
  int size_;
};

/// Mixes a rectangle of the picture with a colour (sRGB). The part outside the picture is left out.
void fill(Image& image, int x, int y, int width, int height, const Color& color, float opacity = 1);

}  // namespace scree::render
