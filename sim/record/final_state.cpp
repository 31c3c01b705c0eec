#include "sim/record/final_state.hpp"

#include "core/error.hpp"
#include "sim/record/files.hpp"
#include "sim/scene/body_file.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <iterator>
#include <map>
#include <string>
#include <system_error>
#include <utility>

namespace scree {

namespace {

namespace fs = std::filesystem;

void append(std::string& text, const Vec3& v) {
  fmt::format_to(std::back_inserter(text), ",{},{},{}", v.x(), v.y(), v.z());
}

/// Returns an OBJ file with the vertices in the hull's own frame, in their order, and its faces.
std::string obj_of(const Hull& hull) {
  std::string text;
  const auto out = std::back_inserter(text);
  for (const Vec3& v : hull.vertices) fmt::format_to(out, "v {} {} {}\n", v.x(), v.y(), v.z());
  for (const Hull::Face& face : hull.faces) {
    text += 'f';
    for (const int corner : hull.corners_of(face)) fmt::format_to(out, " {}", corner + 1);
    text += '\n';
  }
  return text;
}

/// The rows of the table, with the columns in the order of BodyColumn. Columns from `hull` on are written
/// only if a body needs them.
class Rows {
 public:
  Rows(const BodyTable& bodies, const Scene& scene, fs::path folder)
      : bodies_(bodies), scene_(scene), folder_(std::move(folder)) {
    for (const Servo& servo : scene.servos) servos_.emplace(BodyNumber{servo.body}, &servo);
    for (std::size_t k = 0; k < bodies.shape.size(); ++k) {
      if (!is_in(k)) continue;
      has_hulls_ = has_hulls_ || bodies.shape[k] == Shape::polyhedron;
      has_servos_ = has_servos_ || servos_.contains(bodies.id[k]);
    }
  }

  bool is_in(std::size_t k) const { return bodies_.mobility[k] == Mobility::free; }

  std::string head() const {
    std::string text;
    for (int c = 0; c < body_columns; ++c) {
      const auto column = static_cast<BodyColumn>(c);
      if (column == BodyColumn::hull ? !has_hulls_ : column > BodyColumn::hull && !has_servos_) continue;
      text += c == 0 ? "" : ",";
      text += name_of(column);
    }
    return text + '\n';
  }

  void append_to(std::string& text, std::size_t k) {
    append_sizes(text, k);
    append(text, bodies_.position[k]);
    const auto out = std::back_inserter(text);
    const Quat& q = bodies_.orientation[k];
    fmt::format_to(out, ",{},{},{},{}", q.w(), q.x(), q.y(), q.z());
    append(text, bodies_.velocity[k]);
    append(text, bodies_.spin[k]);
    text += ',';
    const Material& material = scene_.materials[static_cast<std::size_t>(bodies_.material[k])];
    if (!follows_from_density(k, material.density)) fmt::format_to(out, "{}", 1 / bodies_.inverse_mass[k]);
    fmt::format_to(out, ",{}", material.name);
    if (has_hulls_) fmt::format_to(out, ",{}", hull_file(k));
    if (has_servos_) append_servo(text, k);
    text += '\n';
  }

 private:
  /// Whether the mass follows from the density to the bit. That of a polyhedron never does, as the volume of
  /// its hull is computed anew.
  bool follows_from_density(std::size_t k, double density) const {
    return bodies_.shape[k] != Shape::polyhedron &&
           1 / (density * volume_of(bodies_.shape[k], bodies_.size[k])) == bodies_.inverse_mass[k];
  }

  void append_sizes(std::string& text, std::size_t k) const {
    const auto out = std::back_inserter(text);
    const Vec3& size = bodies_.size[k];
    switch (bodies_.shape[k]) {
      case Shape::sphere:
        fmt::format_to(out, "sphere,{},,,", size.x());
        return;
      case Shape::capsule:
      case Shape::cylinder:
        fmt::format_to(out, "{},{},,,{}", bodies_.shape[k] == Shape::capsule ? "capsule" : "cylinder",
                       size.x(), 2 * size.z());
        return;
      case Shape::polyhedron:
        text += "polyhedron,,,,";
        return;
      default:
        text += "box,";
        append(text, 2 * size);
    }
  }

  /// Returns the name of the body's hull file, which is written for the first body that has the hull; empty
  /// for other shapes.
  std::string hull_file(std::size_t k) {
    if (bodies_.shape[k] != Shape::polyhedron) return {};
    const Hull* hull = scene_.geometry->of_body[index_of(bodies_.id[k])].hull;
    const auto [found, fresh] = hull_files_.try_emplace(hull);
    if (fresh) {
      found->second = fmt::format("{}/{}.obj", hulls_name, hull_files_.size() - 1);
      std::error_code error;
      fs::create_directory(folder_ / hulls_name, error);
      if (error)
        throw RunError(fmt::format("cannot make {}: {}", (folder_ / hulls_name).string(), error.message()));
      write_file(folder_ / found->second, obj_of(*hull));
    }
    return found->second;
  }

  void append_servo(std::string& text, std::size_t k) const {
    const auto servo = servos_.find(bodies_.id[k]);
    if (servo == servos_.end()) {
      text += ",,,,";
      return;
    }
    append(text, servo->second->axis);
    fmt::format_to(std::back_inserter(text), ",{}", servo->second->force);
  }

  const BodyTable& bodies_;
  const Scene& scene_;
  fs::path folder_;
  bool has_hulls_ = false, has_servos_ = false;
  std::map<BodyNumber, const Servo*> servos_;  ///< servos by their bodies
  std::map<const Hull*, std::string> hull_files_;
};

}  // namespace

void write_final_state(const BodyTable& bodies, const Scene& scene, const fs::path& file) {
  constexpr std::size_t chunk = 1 << 20;
  Rows rows(bodies, scene, file.parent_path());
  AtomicFile out(file);
  std::string text = rows.head();
  for (std::size_t k = 0; k < bodies.mobility.size(); ++k) {
    if (!rows.is_in(k)) continue;
    rows.append_to(text, k);
    if (text.size() < chunk) continue;
    out.write(text);
    text.clear();
  }
  out.write(text);
  out.commit();
}

}  // namespace scree
