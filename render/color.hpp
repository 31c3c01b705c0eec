// Colours: encodings, the palettes of materials and of kinds, and the scale for quantities.
#pragma once

#include "core/math.hpp"

#include <cstdint>
#include <vector>

namespace scree::render {

/// Red, green and blue, from 0 to 1. Each function says whether it means sRGB-encoded or linear light.
using Color = Vec3f;

/// Convert sRGB-encoded colours to linear light and back (IEC 61966-2-1).
Color linear_of(const Color& srgb);
Color srgb_of(const Color& linear);

/// Convert linear light to OKLab and back (Ottosson 2020, "A perceptual color space for image processing").
/// OKLab has lightness, green-red and blue-yellow. Colours outside sRGB's gamut are clipped to it.
Vec3f oklab_of(const Color& linear);
Color linear_of_oklab(const Vec3f& lab);

/// Returns the sRGB colours of materials 0, 1, ...; materials beyond the last colour start again with the
/// first.
const std::vector<Color>& default_palette();

/// Returns sRGB colours for kinds that must be distinguished by eye, also with any common colour blindness
/// (Okabe and Ito 2008, "Color universal design", without black).
const std::vector<Color>& category_palette();

/// Returns the colour of the scale at t from 0 to 1 (clamped), in linear light: dark violet to light yellow.
/// The lightness is linear in t in OKLab, so that equal steps look equal and the order survives in grey.
Color scale_color(double t);

/// Returns a linear colour varied a little in lightness and hue, always in the same way for the same number,
/// so that neighbouring bodies in a pile of one material can be distinguished.
Color tinted(const Color& linear, std::int32_t id);

}  // namespace scree::render
