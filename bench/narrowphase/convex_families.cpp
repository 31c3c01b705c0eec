#include "bench/narrowphase/convex_families.hpp"

#include "narrowphase/convex_axes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace scree::oracle {

namespace {

using Kind = std::array<Shape, 2>;
constexpr std::array<Kind, convex_kinds> kinds = {{{Shape::sphere, Shape::cylinder},
                                                   {Shape::sphere, Shape::polyhedron},
                                                   {Shape::box, Shape::capsule},
                                                   {Shape::box, Shape::cylinder},
                                                   {Shape::box, Shape::polyhedron},
                                                   {Shape::capsule, Shape::capsule},
                                                   {Shape::capsule, Shape::cylinder},
                                                   {Shape::capsule, Shape::polyhedron},
                                                   {Shape::cylinder, Shape::cylinder},
                                                   {Shape::cylinder, Shape::polyhedron},
                                                   {Shape::polyhedron, Shape::polyhedron}}};

const char* word_of(Shape shape) {
  switch (shape) {
    case Shape::sphere:
      return "sphere";
    case Shape::box:
      return "box";
    case Shape::capsule:
      return "capsule";
    case Shape::cylinder:
      return "cylinder";
    default:
      return "hull";
  }
}

bool one_in(int many, Random& random) { return random.uniform() * many < 1; }
double power(double from, double to, Random& random) { return std::pow(10.0, random.uniform(from, to)); }

/// The proportions of a body before it is placed: `scale` and `stretch` multiply its half extents.
struct Form {
  Vec3 stretch = Vec3::Ones();
  double scale = 1;
};

/// Returns a prism, or the hull of points on an ellipsoid.
std::shared_ptr<const Hull> random_hull(const Form& form, Random& random) {
  std::vector<Vec3> points;
  const Vec3 half(std::exp2(random.uniform(-1, 0)), std::exp2(random.uniform(-1, 0)),
                  std::exp2(random.uniform(-1, 0)));
  if (one_in(2, random)) {
    const int corners = 3 + static_cast<int>(random.uniform(0, 6));
    for (int k = 0; k < corners; ++k)
      for (const double side : {-1.0, 1.0})
        points.emplace_back(std::cos(2 * pi * k / corners), std::sin(2 * pi * k / corners), side);
  } else {
    const int count = 6 + static_cast<int>(random.uniform(0, 14));
    for (int k = 0; k < count; ++k) points.push_back(random_unit(random));
  }
  for (Vec3& p : points) p = form.scale * p.cwiseProduct(half).cwiseProduct(form.stretch);
  return std::make_shared<const Hull>(make_hull(points));
}

ShapedSolid random_body(Shape shape, const Form& form, std::shared_ptr<const Hull>& hull, Random& random) {
  ShapedSolid body{shape, {Vec3::Zero(), random_turn(random), Vec3::Zero()}};
  const double radius = std::exp2(random.uniform(-2, 0));
  const double across = radius * std::min(form.stretch.x(), 1 / form.stretch.z());
  Vec3& size = body.solid.size;
  switch (shape) {
    case Shape::sphere:
      size.setConstant(form.scale * radius);
      break;
    case Shape::box:
      for (double& half : size) half = std::exp2(random.uniform(-2, 0));
      size = form.scale * size.cwiseProduct(form.stretch);
      break;
    case Shape::capsule:
      size = form.scale * Vec3(across, across, across + random.uniform(0.05, 1));
      break;
    case Shape::cylinder:
      size = form.scale * Vec3(radius * form.stretch.x(), radius * form.stretch.x(),
                               std::exp2(random.uniform(-2, 0)) * form.stretch.z());
      break;
    default:
      hull = random_hull(form, random);
      size = hull->half_extent();
      break;
  }
  return body;
}

Form form_of(ConvexFamily family, bool large, Random& random) {
  Form form;
  if (family == ConvexFamily::slender)
    form.stretch = one_in(2, random) ? Vec3(0.01, 0.01, 1) : Vec3(1, 1, 0.01);
  if (family == ConvexFamily::size_ratio && large) {
    form.scale = 1000;
    if (one_in(2, random)) form.stretch.z() = 1e-3;
  }
  return form;
}

/// Sets the orientations and returns the direction from the first body to the second.
Vec3 arrange(ConvexFamily family, ShapedSolid& a, ShapedSolid& b, Random& random) {
  const Vec3 axis = random_unit(random), any = random_unit(random);
  const double tilt = one_in(3, random) ? 0.0 : power(-12, -1, random);
  const Quat turned = rotation_of(random.uniform(0, 2 * pi) * Vec3::UnitZ());
  if (family == ConvexFamily::parallel) {
    if (one_in(2, random)) a.solid.orientation = Quat::Identity();
    const Quat yaw = one_in(2, random) ? Quat::Identity() : turned;
    b.solid.orientation = (a.solid.orientation * rotation_of(tilt * axis) * yaw).normalized();
    if (one_in(3, random)) return any;
    return a.solid.orientation * (one_in(2, random) ? Vec3(Vec3::UnitZ()) : Vec3(turned * Vec3::UnitX()));
  }
  if (family == ConvexFamily::crossed) {
    const Quat across = rotation_of((pi / 2 + tilt) * Vec3::UnitX());
    b.solid.orientation = (a.solid.orientation * across).normalized();
    if (one_in(3, random)) return any;
    return a.solid.orientation * Vec3(Vec3::UnitX());
  }
  return any;
}

double separation_of(const ConvexPair& pair) {
  const ConvexBody a(pair.a, &pair.data_a, Vec3::Zero()), b(pair.b, &pair.data_b, Vec3::Zero());
  ConvexAxes axes;
  best_axes(a, b, HUGE_VAL, pair.smallest, axes);
  return axes.best.separation;
}

/// Returns the distance along the direction at which the bodies overlap by `depth`, found by bisection. The
/// axes under test only serve to place the bodies; the true separation comes from the oracle.
double distance_for(ConvexPair pair, const Vec3& direction, double depth) {
  double near = 0, far = 3 * (pair.a.solid.size.norm() + pair.b.solid.size.norm());
  for (int k = 0; k < 40; ++k) {
    const double middle = 0.5 * (near + far);
    pair.b.solid.position = middle * direction;
    (separation_of(pair) < -depth ? near : far) = middle;
  }
  return near;
}

double distance_of(ConvexFamily family, const ConvexPair& pair, const Vec3& direction, Random& random) {
  const double smaller = std::min(pair.a.solid.size.maxCoeff(), pair.b.solid.size.maxCoeff());
  switch (family) {
    case ConvexFamily::coincident:
      return 0;
    case ConvexFamily::touching:
      return distance_for(pair, direction, smaller * power(-16, -7, random));
    case ConvexFamily::shallow:
      return distance_for(pair, direction, smaller * power(-6, -1, random));
    case ConvexFamily::deep:
      return random.uniform(0, 0.8) * distance_for(pair, direction, 0);
    default:
      return distance_for(pair, direction,
                          smaller * (one_in(3, random) ? power(-7, -1, random) : random.uniform(0, 0.2)));
  }
}

}  // namespace

const char* name_of(ConvexFamily family) {
  constexpr const char* names[] = {"any",     "touching",   "shallow",    "deep",   "parallel", "crossed",
                                   "slender", "size ratio", "coincident", "scaled", "far"};
  return names[static_cast<int>(family)];
}

std::string kind_name(std::uint64_t kind) {
  return std::string(word_of(kinds[kind][0])) + "-" + word_of(kinds[kind][1]);
}

ConvexPair make_pair(ConvexFamily family, std::uint64_t n) {
  Random random(static_cast<std::uint64_t>(family) + 300, n);
  const Kind kind = kinds[n % convex_kinds];
  const bool first_large = one_in(2, random);
  Form forms[2] = {form_of(family, first_large, random), form_of(family, !first_large, random)};
  if (family == ConvexFamily::scaled) forms[0].scale = forms[1].scale = power(-6, 6, random);
  ConvexPair pair{};
  pair.a = random_body(kind[0], forms[0], pair.hull_a, random);
  pair.b = random_body(kind[1], forms[1], pair.hull_b, random);
  pair.data_a.hull = pair.hull_a.get();
  pair.data_b.hull = pair.hull_b.get();
  Solid &a = pair.a.solid, &b = pair.b.solid;
  pair.length = std::max(a.size.maxCoeff(), b.size.maxCoeff());
  pair.smallest = std::min(smallest_size(pair.a.shape, a.size), smallest_size(pair.b.shape, b.size));
  const Vec3 direction = arrange(family, pair.a, pair.b, random);
  b.position = distance_of(family, pair, direction, random) * direction;
  const double smaller = std::min(a.size.maxCoeff(), b.size.maxCoeff());
  const Vec3 away =
      smaller * (family == ConvexFamily::far ? 1e6 : random.uniform(0, 100)) * random_unit(random);
  a.position += away;
  b.position += away;
  return pair;
}

}  // namespace scree::oracle
