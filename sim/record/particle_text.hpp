// A frame in the two particle formats that are text: extended XYZ, and the dump of LAMMPS. Both have rows of
// numbers and a kind for each row, but no shapes; docs/trajectories.md lists the kinds.
#pragma once

#include "core/period.hpp"
#include "sim/record/export_frame.hpp"

#include <array>
#include <cstdint>
#include <string>

namespace scree {

/// Numbers of rows of a frame that are not particles: planes, tubes and triangles.
struct LeftOut {
  std::int64_t planes = 0, tubes = 0, triangles = 0;

  bool any() const { return planes + tubes + triangles > 0; }
  /// Returns the numbers in words: "1 plane, 128 triangles".
  std::string words() const;
  /// Sets each number to the larger one of both.
  void include(const LeftOut& other);
};

/// Return the text of a frame. Both throw InputError if the trajectory does not have what they need, and set
/// `left_out` to the rows that are not particles.
std::string xyz_of(const ExportFrame& frame, const Period& period, LeftOut& left_out);
std::string lammps_of(const ExportFrame& frame, const Period& period, LeftOut& left_out);

}  // namespace scree
