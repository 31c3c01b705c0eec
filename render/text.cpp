#include "render/text.hpp"

#include "core/error.hpp"

#include <ft2build.h>
#include FT_FREETYPE_H

#include <algorithm>
#include <cmath>

// The font is part of the program, so that the same scene gives the same bytes on every machine.
__asm__(
    ".section .rodata\n"
    "scree_font_begin: .incbin \"" SCREE_FONT
    "\"\n"
    "scree_font_end: .byte 0\n"
    ".text\n");
extern "C" const unsigned char scree_font_begin[], scree_font_end[];

namespace scree::render {

namespace {

// Removes the next code point of valid UTF-8 from the front of the text and returns it.
std::uint32_t take_code_point(std::string_view& text) {
  const auto lead = static_cast<unsigned char>(text[0]);
  const std::size_t length = std::min<std::size_t>(lead < 0x80   ? 1
                                                   : lead < 0xE0 ? 2
                                                   : lead < 0xF0 ? 3
                                                                 : 4,
                                                   text.size());
  std::uint32_t code = length == 1 ? lead : lead & (0x7Fu >> length);
  for (std::size_t k = 1; k < length; ++k) code = code << 6 | (static_cast<unsigned char>(text[k]) & 0x3Fu);
  text.remove_prefix(length);
  return code;
}

void mix(std::uint8_t* rgb, const Color& color, float share) {
  for (int c = 0; c < 3; ++c) {
    const float old = rgb[c];
    rgb[c] = static_cast<std::uint8_t>(std::lround(old + share * (255 * color[c] - old)));
  }
}

}  // namespace

struct Font::Face {
  FT_Library library = nullptr;
  FT_Face face = nullptr;

  Face() = default;
  ~Face() {
    FT_Done_Face(face);
    FT_Done_FreeType(library);
  }
  Face(const Face&) = delete;
  Face& operator=(const Face&) = delete;

  /// Calls f(glyph slot, pen) for each glyph. Returns the position of the pen after the last one (pixels).
  template <class F>
  int for_each_glyph(std::string_view text, F&& f) const {
    int pen = 0;
    while (!text.empty()) {
      if (FT_Load_Char(face, take_code_point(text), FT_LOAD_RENDER | FT_LOAD_TARGET_LIGHT) != 0) continue;
      f(*face->glyph, pen);
      pen += static_cast<int>((face->glyph->advance.x + 32) >> 6);
    }
    return pen;
  }
};

Font::Font(int size) : face_(std::make_unique<Face>()), size_(size) {
  const auto bytes = static_cast<FT_Long>(scree_font_end - scree_font_begin);
  if (FT_Init_FreeType(&face_->library) != 0 ||
      FT_New_Memory_Face(face_->library, scree_font_begin, bytes, 0, &face_->face) != 0 ||
      FT_Set_Pixel_Sizes(face_->face, 0, static_cast<FT_UInt>(size)) != 0) {
    throw RunError("FreeType cannot load the font at " + std::to_string(size) + " pixels");
  }
}
Font::~Font() = default;
Font::Font(Font&&) noexcept = default;

int Font::width(std::string_view utf8) const {
  return face_->for_each_glyph(utf8, [](const FT_GlyphSlotRec&, int) {});
}

void Font::draw(Image& image, int x, int y, std::string_view utf8, const Color& color) const {
  face_->for_each_glyph(utf8, [&](const FT_GlyphSlotRec& glyph, int pen) {
    const FT_Bitmap& coverage = glyph.bitmap;
    for (int row = 0; row < static_cast<int>(coverage.rows); ++row) {
      for (int column = 0; column < static_cast<int>(coverage.width); ++column) {
        const int px = x + pen + glyph.bitmap_left + column, py = y - glyph.bitmap_top + row;
        if (px < 0 || px >= image.width || py < 0 || py >= image.height) continue;
        mix(pixel_of(image, px, py), color,
            static_cast<float>(coverage.buffer[row * coverage.pitch + column]) / 255);
      }
    }
  });
}

void fill(Image& image, int x, int y, int width, int height, const Color& color, float opacity) {
  for (int py = std::max(y, 0); py < std::min(y + height, image.height); ++py) {
    for (int px = std::max(x, 0); px < std::min(x + width, image.width); ++px) {
      mix(pixel_of(image, px, py), color, opacity);
    }
  }
}

}  // namespace scree::render
