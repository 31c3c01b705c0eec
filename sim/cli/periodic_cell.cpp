#include "sim/cli/periodic_cell.hpp"

#include "broadphase/bounds.hpp"

#include <cstddef>

namespace scree::cli {

namespace {

/// Returns by how much the image of a body is shifted along each axis to be seen at both ends of the cell
/// (m); 0: the body does not reach through an end.
Vec3 shift_of(const BodyTable& bodies, std::size_t k) {
  Vec3 shift = Vec3::Zero();
  const Period& period = bodies.period;
  const Vec3 half =
      half_extent_of({bodies.shape[k], bodies.position[k], bodies.orientation[k], bodies.size[k]});
  const Vec3 above = bodies.position[k] - period.low;
  for (int a = 0; a < 3; ++a) {
    if (!period.is_along(a)) continue;
    if (above[a] < half[a]) shift[a] = period.length[a];
    if (above[a] > period.length[a] - half[a]) shift[a] = -period.length[a];
  }
  return shift;
}

void append_image(std::size_t k, const Vec3& by, render::Frame& frame) {
  BodyTable& bodies = frame.snapshot.bodies;
  for_each_field(
      [k](const char*, auto& field) {
        auto value = field[k];
        field.push_back(value);
      },
      bodies);
  bodies.position.back() += by;
  if (k < frame.force.size()) frame.force.push_back(frame.force[k]);
  if (k < frame.level.size()) frame.level.push_back(frame.level[k]);
}

}  // namespace

void move_into_cell(BodyTable& bodies) {
  if (!bodies.period.exists) return;
  for (std::size_t k = 0; k < bodies.shape.size(); ++k)
    if (!is_boundary(bodies.shape[k])) bodies.period.wrap(bodies.position[k]);
}

void append_images(render::Frame& frame) {
  const BodyTable& bodies = frame.snapshot.bodies;
  if (!bodies.period.exists) return;
  const std::size_t count = bodies.shape.size();
  for (std::size_t k = 0; k < count; ++k) {
    if (is_boundary(bodies.shape[k]) || bodies.mobility[k] == Mobility::absent) continue;
    const Vec3 shift = shift_of(bodies, k);
    // There is an image for each combination of the axes along which the body reaches through an end.
    for (int axes = 1; axes < 8; ++axes) {
      Vec3 by = Vec3::Zero();
      bool all = true;
      for (int a = 0; a < 3; ++a) {
        if ((axes >> a & 1) == 0) continue;
        by[a] = shift[a];
        all = all && shift[a] != 0;
      }
      if (all) append_image(k, by, frame);
    }
  }
}

}  // namespace scree::cli
