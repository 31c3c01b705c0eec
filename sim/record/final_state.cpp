#include "sim/record/final_state.hpp"

#include "sim/record/files.hpp"
#include "sim/scene/body_file.hpp"

#include <fmt/format.h>

#include <iterator>
#include <string>

namespace scree {

namespace {

void append(std::string& text, const Vec3& v) {
  fmt::format_to(std::back_inserter(text), ",{},{},{}", v.x(), v.y(), v.z());
}

/// In the order of BodyColumn.
void append_row(std::string& text, const BodyTable& bodies, std::size_t k, const Material& material) {
  const auto out = std::back_inserter(text);
  const Quat& q = bodies.orientation[k];
  if (bodies.shape[k] == Shape::sphere) {
    fmt::format_to(out, "sphere,{},,,", bodies.size[k].x());
  } else if (bodies.shape[k] == Shape::capsule || bodies.shape[k] == Shape::cylinder) {
    fmt::format_to(out, "{},{},,,{}", bodies.shape[k] == Shape::capsule ? "capsule" : "cylinder",
                   bodies.size[k].x(), 2 * bodies.size[k].z());
  } else {
    // Which polyhedron it is, a row cannot say: reading it back is refused.
    text += bodies.shape[k] == Shape::polyhedron ? "polyhedron," : "box,";
    append(text, 2 * bodies.size[k]);
  }
  append(text, bodies.position[k]);
  fmt::format_to(out, ",{},{},{},{}", q.w(), q.x(), q.y(), q.z());
  append(text, bodies.velocity[k]);
  append(text, bodies.spin[k]);
  text += ',';
  const double mass = material.density * volume_of(bodies.shape[k], bodies.size[k]);  // of no polyhedron
  if (1 / mass != bodies.inverse_mass[k]) fmt::format_to(out, "{}", 1 / bodies.inverse_mass[k]);
  fmt::format_to(out, ",{}\n", material.name);
}

}  // namespace

void write_final_state(const BodyTable& bodies, const Scene& scene, const std::filesystem::path& file) {
  constexpr std::size_t chunk = 1 << 20;
  AtomicFile out(file);
  std::string text;
  for (int column = 0; column < body_columns; ++column) {
    text += column == 0 ? "" : ",";
    text += name_of(static_cast<BodyColumn>(column));
  }
  text += '\n';
  for (std::size_t k = 0; k < bodies.mobility.size(); ++k) {
    if (bodies.mobility[k] != Mobility::free) continue;
    append_row(text, bodies, k, scene.materials[static_cast<std::size_t>(bodies.material[k])]);
    if (text.size() < chunk) continue;
    out.write(text);
    text.clear();
  }
  out.write(text);
  out.commit();
}

}  // namespace scree
