// Colours: encodings, the palette of materials, and the scale for quantities.
#pragma once

#include "core/math.hpp"

#include <cstdint>
#include <vector>

namespace scree::render {

/// Red, green and blue, 0 to 1. Functions say whether they mean sRGB-encoded or linear light.
using Color = Vec3f;

/// sRGB-encoded to linear light and back (IEC 61966-2-1).
Color linear_of(const Color& srgb);
Color srgb_of(const Color& linear);

/// OKLab (Ottosson 2020, "A perceptual color space for image processing"): lightness, green-red and
/// blue-yellow, from and to linear light. Colours outside sRGB's gamut are clipped to it.
Vec3f oklab_of(const Color& linear);
Color linear_of_oklab(const Vec3f& lab);

/// sRGB colours for material 0, 1, ...; materials beyond the last start over.
const std::vector<Color>& default_palette();

/// sRGB colours for kinds that have to be told apart by eye, with any common colour blindness too (Okabe and
/// Ito 2008, "Color universal design", without black).
const std::vector<Color>& category_palette();

/// Linear light for t in 0 to 1, clamped: dark violet to light yellow, with lightness linear in t in OKLab,
/// so that equal steps look equal and the order survives in grey.
Color scale_color(double t);

/// A linear colour varied a little in lightness and hue, always the same for one number: neighbours in a pile
/// of one material stay apart.
Color tinted(const Color& linear, std::int32_t id);

}  // namespace scree::render
