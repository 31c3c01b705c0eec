#include "tests/fuzz/random_scene.hpp"

#include "core/math.hpp"
#include "core/rng.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace scree {

namespace {

constexpr int steps = 200;
constexpr int most_bodies = 10;
constexpr int tries = 200;  // attempts to place one body without overlap

enum class Holder { none, floor, room, tube, platform };
enum class Kind { spheres, cubes, boxes, mixed };

class Generator {
 public:
  explicit Generator(std::uint64_t seed) : random_(seed, 0) {}

  RandomScene draw() {
    holder_ = one_of<Holder, 5>({Holder::none, Holder::floor, Holder::room, Holder::tube, Holder::platform});
    kind_ = one_of<Kind, 4>({Kind::spheres, Kind::cubes, Kind::boxes, Kind::mixed});
    const bool gravity = one_of<bool, 2>({false, true});
    overlaps_ = one_of<bool, 3>({false, false, true});
    mass_ratio_ = one_of<double, 4>({1, 10, 100, 1000});
    size_ratio_ = one_of<double, 4>({1, 1, 3, 10});
    const double step = one_of<double, 3>({1.0 / 60, 1.0 / 240, 1.0 / 1000});
    const int substeps = one_of<int, 4>({1, 1, 2, 5});
    std::string text = fmt::format("format: 1\ngravity: [0, 0, {}]\n", gravity ? -9.81 : 0.0);
    text += fmt::format("time: {{end: {}, step: {}, substeps: {}}}\n", steps * step, step, substeps);
    text += "materials:\n" + material("a") + material("b") + "bodies:\n" + holder();
    const int count = 2 + static_cast<int>(random_.uniform(0, most_bodies - 1));
    for (int k = 0; k < count; ++k) text += body();
    text += "render: false\n";
    const bool closed = holder_ == Holder::none && !gravity;
    return {.yaml = std::move(text), .closed = closed, .overlaps = overlaps_};
  }

 private:
  template <class T, std::size_t n>
  T one_of(const std::array<T, n>& values) {
    return values[static_cast<std::size_t>(random_.uniform(0, static_cast<double>(n)))];
  }

  static std::string list(const Vec3& v) { return fmt::format("[{}, {}, {}]", v.x(), v.y(), v.z()); }

  Vec3 vector(double largest) {
    Vec3 v;
    for (int k = 0; k < 3; ++k) v[k] = random_.uniform(-largest, largest);
    return v;
  }

  std::string material(const char* name) {
    const double any = random_.uniform();
    const double restitution = one_of<double, 4>({0, 0.5, 1, any});
    const double friction = one_of<double, 4>({0, 0.3, 1, 2 * any});
    return fmt::format("  {}: {{restitution: {}, friction: {}}}\n", name, restitution, friction);
  }

  std::string plane(const Vec3& normal) {
    return fmt::format("  - {{plane: {{normal: {}, offset: -1}}, material: a}}\n", list(normal));
  }

  std::string holder() {
    switch (holder_) {
      case Holder::none:
        return {};
      case Holder::floor:
        return plane(Vec3::UnitZ());
      case Holder::room: {
        std::string walls;
        for (int k = 0; k < 3; ++k) walls += plane(Vec3::Unit(k)) + plane(-Vec3::Unit(k));
        return walls;
      }
      case Holder::tube: {
        const double spin = one_of<double, 3>({0, 1, -4});
        const std::string motion =
            spin == 0 ? "fixed: true" : fmt::format("motion: {{spin: [0, {}, 0]}}", spin);
        return fmt::format(
            "  - {{tube: {{radius: 1.5, length: 2.5}}, rotate: {{axis: [1, 0, 0], degrees: 90}}, {}, "
            "material: a}}\n",
            motion);
      }
      case Holder::platform:
        return fmt::format(
            "  - {{box: {{size: [4, 4, 0.2]}}, at: [0, 0, -1.1], motion: {{velocity: {}, spin: {}}}, "
            "material: a}}\n",
            list(vector(1)), list(vector(0.5)));
    }
    return {};
  }

  /// Draws a position at which the bounding sphere of a body overlaps no other one; if overlaps are wanted,
  /// the first position drawn. Returns false if no room was found.
  bool place(double radius, Vec3& position) {
    const double reach = std::max(1.0 - 1.001 * radius, 0.0) * (overlaps_ ? 0.4 : 1.0);
    for (int k = 0; k < tries; ++k) {
      position = vector(reach);
      const auto overlapped = [&](const auto& other) {
        return (other.first - position).norm() < 1.001 * (other.second + radius);
      };
      if (overlaps_ || std::none_of(placed_.begin(), placed_.end(), overlapped)) {
        placed_.emplace_back(position, radius);
        return true;
      }
    }
    return false;
  }

  std::string body() {
    const double size = 0.2 * std::pow(size_ratio_, -random_.uniform());
    const double mass = std::pow(mass_ratio_, random_.uniform());
    const bool ball = kind_ == Kind::spheres || (kind_ == Kind::mixed && random_.uniform() < 0.5);
    Vec3 edges = Vec3::Constant(2 * size);
    if (kind_ == Kind::boxes || (kind_ == Kind::mixed && random_.uniform() < 0.5)) {
      for (int k = 0; k < 3; ++k) edges[k] *= random_.uniform(0.2, 1);
    }
    const Vec3 axis = vector(1);
    const double angle = random_.uniform(0, 180);
    const Vec3 velocity = vector(one_of<double, 3>({0, 1, 5}));
    const Vec3 spin = vector(one_of<double, 3>({0, 1, 10}));
    const char* surface = one_of<const char*, 2>({"a", "b"});
    Vec3 position;
    if (!place(ball ? size : 0.5 * edges.norm(), position)) return {};
    const std::string shape =
        ball ? fmt::format("sphere: {{radius: {}}}", size) : fmt::format("box: {{size: {}}}", list(edges));
    return fmt::format(
        "  - {{{}, mass: {}, at: {}, rotate: {{axis: {}, degrees: {}}}, velocity: {}, spin: {}, material: "
        "{}}}\n",
        shape, mass, list(position), list(axis), angle, list(velocity), list(spin), surface);
  }

  Random random_;
  Holder holder_ = Holder::none;
  Kind kind_ = Kind::spheres;
  bool overlaps_ = false;
  double mass_ratio_ = 1;
  double size_ratio_ = 1;
  std::vector<std::pair<Vec3, double>> placed_;
};

}  // namespace

RandomScene random_scene(std::uint64_t seed) { return Generator(seed).draw(); }

}  // namespace scree
