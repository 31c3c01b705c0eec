#include "bench/hulls/families.hpp"

#include "core/random_orientation.hpp"
#include "core/rng.hpp"

#include <algorithm>
#include <cmath>

namespace scree::oracle {
namespace {

/// Makes a set of points of about unit size.
class Maker {
 public:
  Maker(HullFamily family, std::uint64_t n)
      : random_(0x4c11 + static_cast<std::uint64_t>(family), n), most_(n % 40 == 39 ? 200 : 30) {}

  HullPoints make(HullFamily family) {
    fill(family);
    constexpr double unit = 0x1p-56;
    const double size = std::ldexp(1.0, whole(-20, 20));
    for (Vec3& p : points_) p = size * (p / unit).array().round().matrix() * unit;
    return {std::move(points_), size * unit};
  }

 private:
  /// Returns a random integer in [low, high].
  int whole(int low, int high) {
    return low + static_cast<int>(random_.uniform() * static_cast<double>(high - low + 1));
  }
  double power_of_ten(double low, double high) { return std::pow(10.0, random_.uniform(low, high)); }
  Vec3 in_cube() {
    const double x = random_.uniform(-1, 1), y = random_.uniform(-1, 1), z = random_.uniform(-1, 1);
    return {x, y, z};
  }
  Vec3 on_sphere() { return random_orientation(random_) * Vec3::UnitX(); }
  int some() { return whole(4, most_); }

  void turn() {
    const Quat q = random_orientation(random_);
    for (Vec3& p : points_) p = q * p;
  }
  void move_each(double far) {
    for (Vec3& p : points_) p += far * in_cube();
  }
  void round_to(double digit) {
    for (Vec3& p : points_) p = (p / digit).array().round().matrix() * digit;
  }
  /// Adds points of a lattice of `steps` to each side of the middle: all of them, or a random choice.
  void lattice() {
    const int steps = whole(1, most_ > 30 ? 4 : 2), n = 2 * steps + 1;
    const bool all = whole(0, 1) == 1 && n * n * n <= most_;
    if (all) {
      for (int k = 0; k < n * n * n; ++k)
        points_.push_back(Vec3(k % n, k / n % n, k / n / n) / steps - Vec3::Ones());
      return;
    }
    for (int k = some(); k > 0; --k) {
      const int x = whole(0, n - 1), y = whole(0, n - 1), z = whole(0, n - 1);
      points_.push_back(Vec3(x, y, z) / steps - Vec3::Ones());
    }
  }
  void rings(double half_height) {
    const int sides = whole(3, std::max(3, most_ / 3)), heights = whole(2, 3);
    const double taper = whole(0, 2) == 0 ? random_.uniform(0.5, 1) : 1;
    for (int h = 0; h < heights; ++h)
      for (int k = 0; k < sides; ++k) {
        const double angle = 2 * pi * k / sides, share = 2.0 * h / (heights - 1) - 1;
        const double r = 1 - (1 - taper) * (share + 1) / 2;
        points_.emplace_back(r * std::cos(angle), r * std::sin(angle), half_height * share);
      }
    points_.emplace_back(0, 0, half_height);
    points_.emplace_back(0.25, 0, -half_height);
  }

  void near_equal() {
    for (int k = whole(4, 8); k > 0; --k) points_.push_back(in_cube());
    if (whole(0, 1) == 0) {
      points_.clear();
      lattice();
      points_.resize(std::min<std::size_t>(points_.size(), 8));
    }
    const std::size_t few = points_.size();
    for (int k = whole(0, most_ - 8); k > 0; --k)
      points_.push_back(points_[static_cast<std::size_t>(whole(0, static_cast<int>(few) - 1))]);
    move_each(power_of_ten(-16, -7));
  }

  void near_flat() {
    const double thick = power_of_ten(-16, -4);
    lattice();
    if (whole(0, 1) == 0) std::for_each(points_.begin(), points_.end(), [&](Vec3& p) { p = in_cube(); });
    for (Vec3& p : points_) p.z() = thick * random_.uniform(-1, 1);
    turn();
  }

  void flat_faces() {
    const Vec3 half(1, random_.uniform(0.01, 1), random_.uniform(0.01, 1));
    for (int k = some(); k > 0; --k) {
      Vec3 p = in_cube();
      const int axis = whole(0, 2);
      p[axis] = p[axis] < 0 ? -1 : 1;
      if (const int other = whole(0, 2); whole(0, 1) == 0) p[other] = p[other] < 0 ? -1 : 1;
      points_.push_back(half.cwiseProduct(p));
    }
    turn();
    move_each(power_of_ten(-16, -7));
  }

  void aspect() {
    const double a = power_of_ten(-6, 0), b = power_of_ten(-6, 0);
    const Vec3 half(1, a, whole(0, 2) == 0 ? a : b);
    lattice();
    for (Vec3& p : points_) p = half.cwiseProduct(whole(0, 1) == 0 ? p : in_cube());
    turn();
  }

  void clusters() {
    std::vector<Vec3> centres;
    for (int k = whole(2, 6); k > 0; --k) centres.push_back(in_cube());
    for (int k = some(); k > 0; --k)
      points_.push_back(centres[static_cast<std::size_t>(whole(0, static_cast<int>(centres.size()) - 1))]);
    move_each(power_of_ten(-12, -1));
  }

  void far() {
    constexpr HullFamily near[] = {HullFamily::ball, HullFamily::prism, HullFamily::whole};
    fill(near[whole(0, 2)]);
    const Vec3 away = power_of_ten(0, 6) * on_sphere();
    for (Vec3& p : points_) p += away;
  }

  void magnitudes() {
    for (int k = some(); k > 0; --k) {
      Vec3 p = in_cube();
      for (int c = 0; c < 3; ++c) p[c] *= whole(0, 1) == 0 ? 1 : power_of_ten(-12, 0);
      points_.push_back(p);
    }
  }

  void planes() {
    for (int k = some(); k > 0; --k) {
      Vec3 p = in_cube();
      p[whole(0, 2)] = 0;
      if (whole(0, 2) == 0) p[whole(0, 2)] = 0;
      points_.push_back(p);
    }
    turn();
  }

  void bevels() {
    const double fine = power_of_ten(-7, -2);
    std::vector<Vec3> corners;
    for (int k = whole(2, 12); k > 0; --k) {
      const int x = whole(-8, 7), y = whole(-8, 7);
      corners.emplace_back(x / 8.0, y / 8.0, 0);
    }
    for (int k = some(); k > 0; --k) {
      const int x = whole(-8, 7), y = whole(-8, 7), z = whole(-8, 7);
      const Vec3& corner = corners[static_cast<std::size_t>(whole(0, static_cast<int>(corners.size()) - 1))];
      points_.push_back(corner + fine * Vec3(x, y, z) / 8);
    }
    if (whole(0, 1) == 0) turn();
  }

  void fill(HullFamily family) {
    switch (family) {
      case HullFamily::ball:
        for (int k = some(); k > 0; --k) points_.push_back(std::cbrt(random_.uniform()) * on_sphere());
        break;
      case HullFamily::sphere:
        for (int k = some(); k > 0; --k) points_.push_back(on_sphere());
        break;
      case HullFamily::digits_6:
      case HullFamily::digits_8:
        lattice();
        turn();
        round_to(family == HullFamily::digits_6 ? 1e-6 : 1e-8);
        break;
      case HullFamily::single:
        lattice();
        turn();
        for (Vec3& p : points_) p = p.cast<float>().cast<double>();
        break;
      case HullFamily::whole:
        lattice();
        break;
      case HullFamily::near_equal:
        near_equal();
        break;
      case HullFamily::near_flat:
        near_flat();
        break;
      case HullFamily::flat_faces:
        flat_faces();
        break;
      case HullFamily::prism:
        rings(power_of_ten(-2, 0.5));
        if (whole(0, 1) == 0) turn();
        break;
      case HullFamily::disc:
        rings(power_of_ten(-6, -2));
        turn();
        break;
      case HullFamily::aspect:
        aspect();
        break;
      case HullFamily::clusters:
        clusters();
        break;
      case HullFamily::far:
        far();
        break;
      case HullFamily::magnitudes:
        magnitudes();
        break;
      case HullFamily::planes:
        planes();
        break;
      case HullFamily::tolerance:
        lattice();
        turn();
        move_each(power_of_ten(-7, -4));
        break;
      case HullFamily::bevels:
        bevels();
        break;
      case HullFamily::count:
        break;
    }
  }

  Random random_;
  int most_;
  std::vector<Vec3> points_;
};

}  // namespace

const char* name_of(HullFamily family) {
  constexpr const char* names[] = {"ball",   "sphere",     "digits_6",  "digits_8",   "single",
                                   "whole",  "near_equal", "near_flat", "flat_faces", "prism",
                                   "disc",   "aspect",     "clusters",  "far",        "magnitudes",
                                   "planes", "tolerance",  "bevels"};
  static_assert(std::size(names) == static_cast<std::size_t>(HullFamily::count));
  return names[static_cast<std::size_t>(family)];
}

HullPoints make_points(HullFamily family, std::uint64_t n) { return Maker(family, n).make(family); }

}  // namespace scree::oracle
