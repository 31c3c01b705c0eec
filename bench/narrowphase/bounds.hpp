// Bounds that the narrow phase's answers are held to, for all shapes.
#pragma once

namespace scree::bench {

inline constexpr double rounding =
    1e-12;  ///< error of a gap by rounding alone, relative to the pair's length
/// Number of support points that libccd may request after the one that signals it to end, because each
/// running loop must end.
inline constexpr int supports_to_end = 16;

}  // namespace scree::bench
