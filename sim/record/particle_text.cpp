#include "sim/record/particle_text.hpp"

#include "core/error.hpp"
#include "sim/scene/particle_kinds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <vector>

namespace scree {

namespace {

/// The particles of a frame: the rows that are particles, and the numbers of their columns.
struct Particles {
  const ExportFrame& frame;
  std::vector<std::size_t> rows;
  std::size_t id, shape, size, material, mobility;
  std::optional<std::size_t> orientation, velocity, spin;
  LeftOut left_out;

  /// Returns the type of numbers that are computed from others.
  const FieldType& real() const { return frame.about[size].type; }
};

Particles particles_of(const ExportFrame& frame) {
  Particles particles{frame,
                      {},
                      frame.require("id"),
                      frame.require("shape"),
                      frame.require("size"),
                      frame.require("material"),
                      frame.require("mobility"),
                      frame.find("orientation"),
                      frame.find("velocity"),
                      frame.find("spin"),
                      {}};
  for (std::size_t row = 0; row < frame.rows(); ++row) {
    const Shape shape = frame.shape(particles.shape, row);
    particles.left_out.planes += shape == Shape::plane;
    particles.left_out.tubes += shape == Shape::tube;
    particles.left_out.triangles += shape == Shape::triangle;
    if (!is_surface(shape)) particles.rows.push_back(row);
  }
  return particles;
}

/// The size of a particle as OVITO reads it (manual, "Particles"; its kinds sphere, box, spherocylinder and
/// cylinder): a sphere has a radius, a box its half extents, and a shape that is round along z its radius
/// and, as third number, the whole length of its cylinder.
struct Outline {
  double radius = 0;
  Vec3 shape = Vec3::Zero();
};

Outline outline_of(Shape shape, const Vec3& extent) {
  const double radius = 0.5 * extent.x();
  switch (shape) {
    case Shape::sphere:
      return {radius, Vec3::Zero()};
    case Shape::capsule:
      return {radius, {radius, radius, extent.z() - extent.x()}};
    case Shape::cylinder:
      return {radius, {radius, radius, extent.z()}};
    default:
      return {0, 0.5 * extent};
  }
}

Outline outline_of(const Particles& particles, std::size_t row) {
  return outline_of(particles.frame.shape(particles.shape, row), particles.frame.vector(particles.size, row));
}

/// The corners of the cell: those of the period along periodic axes, else those of a box around the centres.
struct CellCorners {
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();
};

CellCorners cell_of(const Particles& particles, const Period& period) {
  CellCorners cell;
  for (std::size_t n = 0; n < particles.rows.size(); ++n) {
    const Vec3 x = particles.frame.vector(0, particles.rows[n]);
    cell.low = n == 0 ? x : cell.low.cwiseMin(x);
    cell.high = n == 0 ? x : cell.high.cwiseMax(x);
  }
  for (int a = 0; a < 3; ++a) {
    if (!period.is_along(a)) continue;
    cell.low[a] = period.low[a];
    cell.high[a] = period.low[a] + period.length[a];
  }
  return cell;
}

void append(std::string& text, const Vec3& v, const FieldType& type) {
  for (int k = 0; k < 3; ++k) {
    text += ' ';
    append_number(text, v[k], type);
  }
}

}  // namespace

std::string LeftOut::words() const {
  std::string text;
  const auto add = [&text](std::int64_t count, const char* word) {
    if (count > 0)
      text += fmt::format("{}{} {}{}", text.empty() ? "" : ", ", count, word, count == 1 ? "" : "s");
  };
  add(planes, "plane");
  add(tubes, "tube");
  add(triangles, "triangle");
  return text;
}

void LeftOut::include(const LeftOut& other) {
  planes = std::max(planes, other.planes);
  tubes = std::max(tubes, other.tubes);
  triangles = std::max(triangles, other.triangles);
}

// OVITO has quaternions in the order x, y, z, w (manual, "Extended XYZ").
std::string xyz_of(const ExportFrame& frame, const Period& period, LeftOut& left_out) {
  const Particles particles = particles_of(frame);
  left_out = particles.left_out;
  std::string text =
      fmt::format("{}\nProperties=type:I:1:pos:R:3:id:I:1:material:I:1:radius:R:1:aspherical_shape:R:3",
                  particles.rows.size());
  if (particles.orientation) text += ":orientation:R:4";
  if (particles.velocity) text += ":velo:R:3";
  if (particles.spin) text += ":angular_velocity:R:3";
  text += ":mobility:I:1";
  const auto out = std::back_inserter(text);
  fmt::format_to(out, " Time={} Timestep={}", frame.frame.time, frame.frame.step);
  if (period.exists) {
    const CellCorners cell = cell_of(particles, period);
    const Vec3 edge = cell.high - cell.low;
    fmt::format_to(out, " Lattice=\"{} 0 0 0 {} 0 0 0 {}\" Origin=\"{} {} {}\"", edge.x(), edge.y(), edge.z(),
                   cell.low.x(), cell.low.y(), cell.low.z());
  }
  const auto flag = [&period](int a) { return period.is_along(a) ? 'T' : 'F'; };
  fmt::format_to(out, " pbc=\"{} {} {}\" types=\"{}\"", flag(0), flag(1), flag(2), particle_kinds);
  if (left_out.any()) fmt::format_to(out, " left_out=\"{}\"", left_out.words());
  text += '\n';
  for (const std::size_t row : particles.rows) {
    text += std::to_string(kind_of(frame.shape(particles.shape, row)));
    append_row(text, frame, 0, row, ' ');
    append_row(text, frame, particles.id, row, ' ');
    append_row(text, frame, particles.material, row, ' ');
    const Outline outline = outline_of(particles, row);
    text += ' ';
    append_number(text, outline.radius, particles.real());
    append(text, outline.shape, particles.real());
    if (particles.orientation) {
      for (const std::size_t k : {1, 2, 3, 0}) {
        text += ' ';
        append_number(text, frame.number(*particles.orientation, row, k), particles.real());
      }
    }
    if (particles.velocity) append_row(text, frame, *particles.velocity, row, ' ');
    if (particles.spin) append_row(text, frame, *particles.spin, row, ' ');
    append_row(text, frame, particles.mobility, row, ' ');
    text += '\n';
  }
  return text;
}

std::string lammps_of(const ExportFrame& frame, const Period& period, LeftOut& left_out) {
  const Particles particles = particles_of(frame);
  left_out = particles.left_out;
  const auto flag = [&period](int a) { return period.is_along(a) ? "pp" : "ff"; };
  std::string text = fmt::format(
      "ITEM: TIMESTEP\n{}\nITEM: TIME\n{}\nITEM: NUMBER OF ATOMS\n{}\nITEM: BOX BOUNDS {} {} {}\n",
      frame.frame.step, frame.frame.time, particles.rows.size(), flag(0), flag(1), flag(2));
  const CellCorners cell = cell_of(particles, period);  // LAMMPS needs a cell
  for (int a = 0; a < 3; ++a) {
    append_number(text, cell.low[a], particles.real());
    text += ' ';
    append_number(text, cell.high[a], particles.real());
    text += '\n';
  }
  text += "ITEM: ATOMS id type x y z radius shapex shapey shapez";
  if (particles.orientation) text += " quatw quati quatj quatk";
  if (particles.velocity) text += " vx vy vz";
  if (particles.spin) text += " omegax omegay omegaz";
  text += " mobility\n";
  for (const std::size_t row : particles.rows) {
    const Shape shape = frame.shape(particles.shape, row);
    // LAMMPS counts atoms and types from 1.
    fmt::format_to(std::back_inserter(text), "{} {}", frame.number(particles.id, row) + 1, kind_of(shape));
    append_row(text, frame, 0, row, ' ');
    const Outline outline = outline_of(particles, row);
    text += ' ';
    append_number(text, outline.radius, particles.real());
    // LAMMPS has diameters, of which OVITO takes half.
    append(text, shape == Shape::sphere ? Vec3::Constant(2 * outline.radius) : Vec3(2 * outline.shape),
           particles.real());
    if (particles.orientation) append_row(text, frame, *particles.orientation, row, ' ');
    if (particles.velocity) append_row(text, frame, *particles.velocity, row, ' ');
    if (particles.spin) append_row(text, frame, *particles.spin, row, ' ');
    append_row(text, frame, particles.mobility, row, ' ');
    text += '\n';
  }
  return text;
}

}  // namespace scree
