#include "render/gl/facets.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace scree::render::gl {

namespace {

/// A point on a surface in the frame of its body, and the normal there.
struct Spot {
  Vec3 at, normal;
};

/// Packs a normal into a float: the octahedron of normals is unfolded into a square, with 12 bits per
/// coordinate.
float packed_normal(const Vec3& n) {
  const double sum = n.cwiseAbs().sum();
  Eigen::Vector2d p = n.head<2>() / sum;
  if (n.z() < 0) {
    const Eigen::Vector2d folded = 1 - p.cwiseAbs().reverse().array();
    p = {std::copysign(folded.x(), p.x()), std::copysign(folded.y(), p.y())};
  }
  const auto step = [](double x) { return std::clamp(std::round((x + 1) * 2047.5), 0.0, 4095.0); };
  return static_cast<float>(4096 * step(p.x()) + step(p.y()));
}

class Facets {
 public:
  Facets(const BodyTable& bodies, std::size_t body, const Vec3& eye, const Color& color, float gloss,
         std::vector<Vec4f>& texels)
      : turn_(bodies.orientation[body].toRotationMatrix()),
        place_(bodies.position[body] - eye),
        color_(color),
        gloss_(gloss),
        texels_(texels) {}

  void add(const Spot& a, const Spot& b, const Spot& c, float shade = 1) {
    for (const Spot* spot : {&a, &b, &c})
      texels_.push_back(packed(Vec3(place_ + turn_ * spot->at), packed_normal(turn_ * spot->normal)));
    texels_.push_back({shade * color_.x(), shade * color_.y(), shade * color_.z(), gloss_});
  }
  void add_flat(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& normal) {
    add({a, normal}, {b, normal}, {c, normal});
  }

  /// Adds a surface of revolution about the z axis, given its profile from below upwards. Quarters in two
  /// shades show how the body turns.
  void add_round(const std::vector<Spot>& profile) {
    constexpr int sides = 40;
    const auto turned = [](const Spot& s, int k) {
      const double angle = 2 * pi * k / sides;
      const Eigen::AngleAxisd turn(angle, Vec3::UnitZ());
      return Spot{turn * s.at, turn * s.normal};
    };
    for (int k = 0; k < sides; ++k) {
      const float shade = k * 4 / sides % 2 == 0 ? 1.1f : 0.88f;
      for (std::size_t p = 0; p + 1 < profile.size(); ++p) {
        const Spot a = turned(profile[p], k), b = turned(profile[p], k + 1);
        const Spot c = turned(profile[p + 1], k), d = turned(profile[p + 1], k + 1);
        if (profile[p].at.x() > 0) add(a, b, d, shade);
        if (profile[p + 1].at.x() > 0) add(a, d, c, shade);
      }
    }
  }

 private:
  Mat3 turn_;
  Vec3 place_;
  Color color_;
  float gloss_;
  std::vector<Vec4f>& texels_;
};

std::vector<Spot> capsule_profile(const Vec3& size) {
  constexpr int rings = 8;  // number of rings at each end
  std::vector<Spot> profile;
  for (const double side : {-1.0, 1.0})
    for (int k = 0; k <= rings; ++k) {
      const double angle = 0.5 * pi * (side < 0 ? k - rings : k) / rings;
      const Vec3 normal(k == (side < 0 ? 0 : rings) ? 0.0 : std::cos(angle), 0, std::sin(angle));
      profile.push_back({size.x() * normal + side * (size.z() - size.x()) * Vec3::UnitZ(), normal});
    }
  return profile;
}

/// Returns the profile of a cylinder, with a narrow bevel that catches the light.
std::vector<Spot> cylinder_profile(const Vec3& size) {
  const double rim = 0.05 * std::min(size.x(), size.z());
  const Vec3 up = Vec3::UnitZ(), out = Vec3::UnitX();
  std::vector<Spot> profile;
  const auto add = [&](double x, double z, const Vec3& normal) { profile.push_back({{x, 0, z}, normal}); };
  add(0, -size.z(), -up);
  add(size.x() - rim, -size.z(), -up);
  add(size.x(), -size.z() + rim, out);
  add(size.x(), size.z() - rim, out);
  add(size.x() - rim, size.z(), up);
  add(0, size.z(), up);
  return profile;
}

}  // namespace

void facets_of(const Frame& frame, std::size_t body, const Vec3& eye, const Color& color,
               std::vector<Vec4f>& texels) {
  const BodyTable& bodies = frame.snapshot.bodies;
  const Vec3& size = bodies.size[body];
  const bool is_mesh = bodies.shape[body] == Shape::triangle;
  Facets facets(bodies, body, eye, color, is_mesh ? 0.0f : 0.35f, texels);
  if (is_mesh)
    return facets.add_flat(triangle_corner(size, 0), triangle_corner(size, 1), triangle_corner(size, 2),
                           Vec3::UnitZ());
  if (bodies.shape[body] == Shape::capsule) return facets.add_round(capsule_profile(size));
  if (bodies.shape[body] == Shape::cylinder) return facets.add_round(cylinder_profile(size));
  const Hull& hull = *frame.geometry->of_body[index_of(bodies.id[body])].hull;
  for (const Hull::Face& face : hull.faces) {
    const auto corners = hull.corners_of(face);
    const auto at = [&](std::size_t k) -> const Vec3& {
      return hull.vertices[static_cast<std::size_t>(corners[k])];
    };
    for (std::size_t k = 1; k + 1 < corners.size(); ++k)
      facets.add_flat(at(0), at(k), at(k + 1), face.normal);
  }
}

}  // namespace scree::render::gl
