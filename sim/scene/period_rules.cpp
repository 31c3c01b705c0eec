// Rules for scenes with periods: which planes, tubes, worlds and regions they may have, and how large their
// bodies may be.
#include "core/tolerances.hpp"
#include "sim/scene/rules.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace scree {
namespace {

constexpr std::array axis_names = {"x", "y", "z"};

class PeriodRules {
 public:
  PeriodRules(const SceneEntry& scene, const Node& root, Reader& reader)
      : scene_(scene), root_(root), reader_(reader), period_(period_of(*scene.periodic)) {}

  void check() {
    for (std::size_t i = 0; i < scene_.bodies.size(); ++i) {
      const Reader::Step bodies(reader_, "bodies");
      const Reader::Step item(reader_, i);
      check_body(scene_.bodies[i]);
    }
    for (int a = 0; a < 3; ++a) {
      if (!period_.is_along(a)) continue;
      check_world(a);
      check_regions(a);
    }
  }

 private:
  void check_body(const BodyEntry& body) {
    const Node& node = *body.node;
    if (body.tube)
      reader_.fail_at("tube", node,
                      "does not go with `periodic`: the inside of a cylinder has no images of itself");
    if (!body.plane) return;
    for (int a = 0; a < 3; ++a)
      if (period_.is_along(a) && body.plane->normal[a] != 0)
        reader_.fail_at("plane", node,
                        fmt::format("must be parallel to {}, which is periodic: its normal has a part of {} "
                                    "along it",
                                    axis_names[a], body.plane->normal[a]));
  }

  void check_world(int a) {
    if (!scene_.world || scene_.world->to[a] - scene_.world->from[a] >= period_.length[a]) return;
    const Reader::Step step(reader_, "world");
    reader_.fail_at("to", *root_.find("world"),
                    fmt::format("must be at least a period, {} m, beyond `from` along {}: what leaves there "
                                "comes in again",
                                period_.length[a], axis_names[a]));
  }

  void check_regions(int a) {
    for (const Region& region : scene_.regions) {
      if (region.to[a] - region.from[a] <= period_.length[a]) continue;
      const Reader::Step regions(reader_, "regions");
      const Reader::Step name(reader_, region.name);
      reader_.fail_at("to", *root_.find("regions")->find(region.name),
                      fmt::format("must be at most a period, {} m, beyond `from` along {}: a body is there "
                                  "once",
                                  period_.length[a], axis_names[a]));
    }
  }

  const SceneEntry& scene_;
  const Node& root_;
  Reader& reader_;
  Period period_;
};

/// Returns the largest sum of the bounding radii of two bodies, at least one of which is free (m). A period
/// of twice this sum is the shortest at which any two bodies meet through one image only.
double reach_of_two(const BodyTable& bodies) {
  double free = 0;  // largest radius of the free bodies; `other` is the largest of all other bodies
  double other = 0;
  for (std::size_t k = 0; k < bodies.shape.size(); ++k) {
    if (is_boundary(bodies.shape[k])) continue;
    const double radius = bounding_radius(bodies.shape[k], bodies.size[k]);
    if (bodies.mobility[k] == Mobility::free && radius > free) {
      other = std::max(other, free);
      free = radius;
    } else {
      other = std::max(other, radius);
    }
  }
  return free > 0 ? free + other : 0;
}

}  // namespace

void check_periodic(const PeriodicEntry& periodic, const Node& node, Reader& reader) {
  bool any = false;
  for (int a = 0; a < 3; ++a) {
    const auto& ends = periodic.ends(a);
    if (!ends) continue;
    any = true;
    const double length = (*ends)[1] - (*ends)[0];
    if (!(length > 0) || !std::isfinite(length) || !std::isfinite(1 / length))
      reader.fail_at(axis_names[a], node, "must be [low, high] with low < high");
  }
  if (!any) reader.fail(node.mark, "needs x, y or z");
}

void check_in_period(const SceneEntry& scene, const Node& node, Reader& reader) {
  if (scene.periodic) PeriodRules(scene, node, reader).check();
}

Period period_of(const PeriodicEntry& periodic) {
  Vec3 low = Vec3::Zero(), length = Vec3::Zero();
  for (int a = 0; a < 3; ++a) {
    if (const auto& ends = periodic.ends(a)) {
      low[a] = (*ends)[0];
      length[a] = (*ends)[1] - (*ends)[0];
    }
  }
  return period_of(low, length);
}

void fit_bodies(const PeriodicEntry& periodic, BodyTable& bodies, Reader& reader) {
  Period& period = bodies.period;
  const double reach = reach_of_two(bodies);
  const double least = 2 * (1 + 2 * (tolerance::contact_slack + tolerance::pair_skin)) * reach;
  double shortest = HUGE_VAL;
  for (int a = 0; a < 3; ++a) {
    if (!period.is_along(a)) continue;
    shortest = std::min(shortest, period.length[a]);
    if (period.length[a] >= least) continue;
    const Reader::Step step(reader, "periodic");
    reader.fail_at(axis_names[a], *periodic.node,
                   fmt::format("must be at least {:.6g} m long, not {:.6g} m: twice what the spheres around "
                               "two of these bodies reach, {:.6g} m, and a little more. Shorter, two could "
                               "meet through two images; a floor that ends nowhere is a plane",
                               least, period.length[a], reach));
  }
  // Half a period, less a margin that is far larger than the rounding of the boxes to float.
  constexpr double share = 0.499;
  period.most_margin = 0.5 * (share * shortest - reach);
}

}  // namespace scree
