// Random sequential addition of bodies, with a grid of cells to find the bodies nearby.
#include "sim/scene/scatter.hpp"

#include "core/geometry.hpp"
#include "core/rng.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace scree {
namespace {

double radius_of(const BodyTable& bodies, std::size_t b) {
  return bounding_radius(bodies.shape[b], bodies.size[b]);
}

/// A grid of cells, each with the bodies whose bounds touch it. Cells at the rim reach to infinity, so that
/// bodies of any size and position are found.
class CellGrid {
 public:
  CellGrid(const Vec3& low, const Vec3& high, std::int64_t count) : low_(low), bodies_(count) {
    const Vec3 extent = high - low;
    // The number of bodies per cell stays small for any shape of the region; flat regions have one layer of
    // cells.
    double edge =
        std::max(extent.maxCoeff() / static_cast<double>(count), std::numeric_limits<double>::min());
    do {
      for (int k = 0; k < 3; ++k)
        cells_[k] = static_cast<std::int64_t>(std::clamp(extent[k] / edge, 1.0, static_cast<double>(count)));
      edge *= 1.25;
    } while (cells_[0] * cells_[1] > 2 * count || cells_[0] * cells_[1] * cells_[2] > 2 * count);
    for (int k = 0; k < 3; ++k)
      inverse_edge_[k] = extent[k] > 0 ? static_cast<double>(cells_[k]) / extent[k] : 0;
    heads_.assign(static_cast<std::size_t>(cells_[0] * cells_[1] * cells_[2]), -1);
  }

  /// Adds a body. Returns false, without adding it, if the body touches more than an eighth of the cells,
  /// because it is as fast to test it for every position. It also returns false if there would be so many
  /// links, because many bodies overlap, that they fill the memory or exceed their 32-bit indices.
  bool insert(std::int32_t body, const Vec3& low, const Vec3& high) {
    std::int64_t touched = 1;
    for (int k = 0; k < 3; ++k) touched *= cell(high[k], k) - cell(low[k], k) + 1;
    const std::int64_t most_links = std::min(links_per_body * (bodies_ + 1), std::int64_t{INT32_MAX});
    if (8 * touched > std::ssize(heads_) || std::ssize(links_) + touched > most_links) return false;
    ++bodies_;
    return visit(low, high, [&](std::int32_t& head) {
      links_.push_back({body, head});
      head = static_cast<std::int32_t>(links_.size()) - 1;
      return true;
    });
  }

  /// Returns whether f(body) is true for every body that may touch the bounds.
  template <class F>
  bool all_of(const Vec3& low, const Vec3& high, F&& f) {
    return visit(low, high, [&](std::int32_t head) {
      for (; head >= 0; head = links_[static_cast<std::size_t>(head)].next)
        if (!f(links_[static_cast<std::size_t>(head)].body)) return false;
      return true;
    });
  }

 private:
  static constexpr std::int64_t links_per_body =
      64;  // most links per body; equal spheres that are close together take 8

  struct Link {
    std::int32_t body;
    std::int32_t next;
  };

  /// Returns the cell of a coordinate along axis k. Where infinities make its position no number, as with a
  /// flat region, it is the first cell: fmax() then returns 0.
  std::int64_t cell(double x, int k) const {
    const double at = std::floor((x - low_[k]) * inverse_edge_[k]);
    return static_cast<std::int64_t>(std::fmin(std::fmax(at, 0.0), static_cast<double>(cells_[k] - 1)));
  }

  template <class F>
  bool visit(const Vec3& low, const Vec3& high, F&& f) {
    std::array<std::int64_t, 3> first{};
    std::array<std::int64_t, 3> last{};
    for (int k = 0; k < 3; ++k) {
      first[k] = cell(low[k], k);
      last[k] = cell(high[k], k);
    }
    for (std::int64_t z = first[2]; z <= last[2]; ++z)
      for (std::int64_t y = first[1]; y <= last[1]; ++y)
        for (std::int64_t x = first[0]; x <= last[0]; ++x)
          if (!f(heads_[static_cast<std::size_t>(x + cells_[0] * (y + cells_[1] * z))])) return false;
    return true;
  }

  Vec3 low_;
  std::int64_t bodies_;  // number of bodies for which the grid is made, plus those that it holds
  std::array<std::int64_t, 3> cells_{};
  std::array<double, 3> inverse_edge_{};
  std::vector<std::int32_t> heads_;
  std::vector<Link> links_;
};

/// Calls f with each shift (m) from the position of a body to one of its images that may touch something
/// within half a period of `middle`. Returns whether f was true for all of them. `reach`: sum of the radii of
/// that body and of the largest body that it may touch (m).
template <class F>
bool all_images(const Period& period, const Vec3& middle, const Vec3& at, double reach, F&& f) {
  std::array<int, 3> first{}, last{};
  for (int k = 0; k < 3; ++k) {
    if (!period.is_along(k)) continue;
    first[k] = at[k] - middle[k] > 0.5 * period.length[k] - reach ? -1 : 0;
    last[k] = at[k] - middle[k] < reach - 0.5 * period.length[k] ? 1 : 0;
  }
  for (int z = first[2]; z <= last[2]; ++z)
    for (int y = first[1]; y <= last[1]; ++y)
      for (int x = first[0]; x <= last[0]; ++x)
        if (!f(Vec3(Vec3(x, y, z).cwiseProduct(period.length)))) return false;
  return true;
}

/// Returns whether the body is a tube that does not reach into the box, by the bounds of its cylinder. Bodies
/// outside a tube do not collide with it, so such a tube is no obstacle. No body is scattered outside a tube
/// that reaches into the box.
bool is_apart(const BodyTable& bodies, std::size_t tube, const Scattering& box) {
  if (bodies.shape[tube] != Shape::tube) return false;
  const Vec3 axis = bodies.orientation[tube] * Vec3::UnitZ();
  const Vec3 across = (1 - axis.array().square()).cwiseMax(0).sqrt();  // share of the radius along each axis
  const Vec3 half = bodies.size[tube].z() * axis.cwiseAbs() + bodies.size[tube].x() * across;
  const Vec3& at = bodies.position[tube];
  return (at - half - box.to).maxCoeff() >= 0 || (box.from - at - half).maxCoeff() >= 0;
}

/// Returns the distance from a triangle to a point in the triangle's frame (m).
double distance_to_triangle(const Vec3& size, const Vec3& point) {
  bool over = true;
  double nearest = HUGE_VAL;
  for (int k = 0; k < 3; ++k) {
    const Vec3 from = triangle_corner(size, k), way = triangle_corner(size, (k + 1) % 3) - from;
    const Vec3 to = point - from;
    over = over && way.x() * to.y() - way.y() * to.x() >= 0;
    nearest = std::min(nearest, (to - std::clamp(way.dot(to) / way.squaredNorm(), 0.0, 1.0) * way).norm());
  }
  return over ? std::abs(point.z()) : nearest;
}

}  // namespace

double distance_to(const BodyTable& bodies, std::size_t b, const Vec3& point) {
  const Vec3 local = bodies.orientation[b].conjugate() * (point - bodies.position[b]);
  switch (bodies.shape[b]) {
    case Shape::sphere:
      return local.norm() - bodies.size[b].x();
    case Shape::box:
      return (local.cwiseAbs() - bodies.size[b]).cwiseMax(0.0).norm();
    case Shape::plane:
      return local.z();
    case Shape::capsule: {
      const double half = bodies.size[b].z() - bodies.size[b].x();
      return (local - std::clamp(local.z(), -half, half) * Vec3::UnitZ()).norm() - bodies.size[b].x();
    }
    case Shape::cylinder:
    case Shape::polyhedron:
      // The distance from the box around the shape, which is at most that from the shape.
      return (local.cwiseAbs() - bodies.size[b]).cwiseMax(0.0).norm();
    case Shape::triangle:
      return distance_to_triangle(bodies.size[b], local);
    case Shape::tube:
      return std::min(bodies.size[b].x() - local.head<2>().norm(), bodies.size[b].z() - std::abs(local.z()));
  }
  return 0;
}

namespace {

/// Places bodies in a box one after the other, clear of all bodies that are there already.
class Scatterer {
 public:
  /// `largest`: the largest radius of the bodies to be placed (m); `count`: how many there are.
  Scatterer(BodyTable& bodies, const Scattering& how, std::int64_t count, double largest)
      : bodies_(bodies),
        how_(how),
        middle_(0.5 * (how.from + how.to)),
        grid_(how.from, how.to, count),
        reach_(largest),
        largest_(largest) {}

  void add_obstacle(std::int32_t b) {
    const auto o = static_cast<std::size_t>(b);
    if (is_boundary(bodies_.shape[o])) {
      if (!is_apart(bodies_, o, how_)) walls_.push_back(b);
      return;
    }
    Vec3 away = bodies_.position[o].cwiseMax(how_.from).cwiseMin(how_.to) - bodies_.position[o];
    for (int k = 0; k < 3; ++k)
      if (how_.period.is_along(k)) away[k] = 0;
    if (away.norm() <= reach_ + radius(b)) insert(b);
  }

  /// Tries random positions until one is clear. Returns false if none was.
  bool place(std::int32_t b) {
    Vec3& at = bodies_.position[static_cast<std::size_t>(b)];
    // Positions have random streams of their own, so that other draws for a body do not change its position.
    const auto id = static_cast<std::uint64_t>(bodies_.id[static_cast<std::size_t>(b)]);
    Random random(how_.seed, id + ((how_.round + 1) << 32));
    for (int tries = 0; tries < how_.tries; ++tries) {
      for (int k = 0; k < 3; ++k) at[k] = random.uniform(how_.from[k], how_.to[k]);
      if (is_clear(b)) {
        insert(b);
        return true;
      }
    }
    return false;
  }

 private:
  double radius(std::int32_t b) const { return radius_of(bodies_, static_cast<std::size_t>(b)); }

  void insert(std::int32_t b) {
    Vec3 at = bodies_.position[static_cast<std::size_t>(b)];
    how_.period.bring_near(middle_, at);
    largest_ = std::max(largest_, radius(b));
    if (!grid_.insert(b, at.array() - radius(b), at.array() + radius(b))) walls_.push_back(b);
  }

  bool is_clear(std::int32_t b) {
    const double r = radius(b);
    const Vec3& at = bodies_.position[static_cast<std::size_t>(b)];
    const auto clear_of = [&](std::int32_t other) {
      Vec3 near = at;
      how_.period.bring_near(bodies_.position[static_cast<std::size_t>(other)], near);
      return distance_to(bodies_, static_cast<std::size_t>(other), near) >= r;
    };
    Vec3 place = at;
    how_.period.bring_near(middle_, place);
    return std::all_of(walls_.begin(), walls_.end(), clear_of) &&
           all_images(how_.period, middle_, place, r + largest_, [&](const Vec3& shift) {
             return grid_.all_of((place + shift).array() - r, (place + shift).array() + r, clear_of);
           });
  }

  BodyTable& bodies_;
  const Scattering& how_;
  Vec3 middle_;
  CellGrid grid_;
  std::vector<std::int32_t> walls_;  // bodies that are not in the grid; they are tested for every position
  double reach_;                     // largest radius of the bodies to be placed (m)
  double largest_;                   // largest radius of all bodies so far (m)
};

}  // namespace

std::int64_t scatter(BodyTable& bodies, std::vector<std::int32_t>& those, const Scattering& how,
                     const std::vector<std::int32_t>& obstacles) {
  if (those.empty()) return 0;
  const auto radius = [&](std::int32_t b) { return radius_of(bodies, static_cast<std::size_t>(b)); };
  std::stable_sort(those.begin(), those.end(),
                   [&](std::int32_t a, std::int32_t b) { return radius(a) > radius(b); });
  Scatterer scatterer(bodies, how, std::ssize(those), radius(those.front()));
  for (const std::int32_t b : obstacles) scatterer.add_obstacle(b);
  for (std::int64_t fitted = 0; fitted < std::ssize(those); ++fitted)
    if (!scatterer.place(those[static_cast<std::size_t>(fitted)])) return fitted;
  return std::ssize(those);
}

}  // namespace scree
