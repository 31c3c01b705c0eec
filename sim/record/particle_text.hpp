// A frame in the two particle formats that are text: extended XYZ, and LAMMPS's dump. Both know rows of
// numbers and a kind for each, no shapes: what is what stands in docs/trajectories.md.
#pragma once

#include "core/period.hpp"
#include "sim/record/export_frame.hpp"

#include <array>
#include <cstdint>
#include <string>

namespace scree {

/// How many rows of a frame are no particles: planes, tubes and triangles.
struct LeftOut {
  std::int64_t planes = 0, tubes = 0, triangles = 0;

  bool any() const { return planes + tubes + triangles > 0; }
  /// "1 plane, 128 triangles".
  std::string words() const;
  /// The larger of each.
  void include(const LeftOut& other);
};

/// Both throw InputError where the trajectory does not have what they need. `left_out` becomes what the frame
/// has besides.
std::string xyz_of(const ExportFrame& frame, const Period& period, LeftOut& left_out);
std::string lammps_of(const ExportFrame& frame, const Period& period, LeftOut& left_out);

}  // namespace scree
