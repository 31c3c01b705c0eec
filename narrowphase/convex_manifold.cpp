#include "narrowphase/convex_manifold.hpp"

#include "narrowphase/box_pair.hpp"
#include "narrowphase/gjk.hpp"

#include <algorithm>

namespace scree {

namespace {

/// A corner in the frame of a face: two coordinates in the plane of the face, and the height over it (m).
struct Flat {
  double x, y, height;
  int name;
};

struct FlatPolygon {
  int count = 0;
  Flat corner[Facing::most];
  double turn = 1;  ///< 1 if the corners are counterclockwise, else -1

  const Flat& at(int k) const { return corner[k < count ? k : 0]; }
};

/// Returns twice the area of a triangle, positive if counterclockwise.
double area(const Flat& a, const Flat& b, double x, double y) {
  return (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
}

struct Frame {
  Vec3 origin, u, w, normal;

  FlatPolygon flatten(const Facing& facing) const {
    FlatPolygon polygon;
    for (const Corner& c : facing.corners()) {
      const Vec3 d = c.at - origin;
      polygon.corner[polygon.count++] = {u.dot(d), w.dot(d), normal.dot(d), c.name};
    }
    double sum = 0;
    for (int k = 1; k + 1 < polygon.count; ++k)
      sum += area(polygon.at(0), polygon.at(k), polygon.at(k + 1).x, polygon.at(k + 1).y);
    polygon.turn = sum < 0 ? -1 : 1;
    return polygon;
  }
  Vec3 point(double x, double y, double height) const { return origin + x * u + y * w + height * normal; }
};

bool is_inside(const FlatPolygon& polygon, double x, double y, double slack) {
  for (int k = 0; k < polygon.count; ++k) {
    const Flat &a = polygon.at(k), &b = polygon.at(k + 1);
    if (polygon.turn * area(a, b, x, y) < -slack * std::hypot(b.x - a.x, b.y - a.y)) return false;
  }
  return true;
}

/// Returns the height of a polygon's plane at a place.
double height_at(const FlatPolygon& polygon, double x, double y) {
  // This is Newell's normal, which uses all corners.
  double nx = 0, ny = 0, nz = 0, mx = 0, my = 0, mh = 0;
  for (int k = 0; k < polygon.count; ++k) {
    const Flat &a = polygon.at(k), &b = polygon.at(k + 1);
    nx += (a.y - b.y) * (a.height + b.height);
    ny += (a.height - b.height) * (a.x + b.x);
    nz += (a.x - b.x) * (a.y + b.y);
    mx += a.x / polygon.count;
    my += a.y / polygon.count;
    mh += a.height / polygon.count;
  }
  return nz == 0 ? mh : mh - (nx * (x - mx) + ny * (y - my)) / nz;
}

struct FacePoint {
  double x, y, height;
  SharedPoint::Kind kind;
  int name_face, name_other;
};

void add_crossings(const FlatPolygon& face, const FlatPolygon& other, std::vector<FacePoint>& points) {
  const int edges = other.count < 3 ? other.count - 1 : other.count;
  for (int i = 0; i < face.count; ++i) {
    const Flat &a = face.at(i), &b = face.at(i + 1);
    for (int j = 0; j < edges; ++j) {
      const Flat &c = other.at(j), &d = other.at(j + 1);
      const double from = area(a, b, c.x, c.y), to = area(a, b, d.x, d.y);
      if (!(from * to < 0)) continue;
      if (!(area(c, d, a.x, a.y) * area(c, d, b.x, b.y) < 0)) continue;
      const double share = from / (from - to);
      points.push_back({c.x + share * (d.x - c.x), c.y + share * (d.y - c.y),
                        c.height + share * (d.height - c.height), SharedPoint::Kind::crossing, a.name,
                        c.name});
    }
  }
}

}  // namespace

void share_face(const Facing& face, const Vec3& normal, const Facing& other, bool face_is_a,
                const double radii[2], double slack, SharedPoints& out) {
  const Vec3 u = tangent_of(normal);
  const Frame frame{face.corner[0].at, u, normal.cross(u), normal};
  const FlatPolygon own = frame.flatten(face), theirs = frame.flatten(other);
  using Kind = SharedPoint::Kind;
  const Kind of_face = face_is_a ? Kind::corner_of_a : Kind::corner_of_b;
  const Kind of_other = face_is_a ? Kind::corner_of_b : Kind::corner_of_a;
  std::vector<FacePoint> points;
  for (int k = 0; k < theirs.count; ++k) {
    const Flat& c = theirs.at(k);
    if (is_inside(own, c.x, c.y, slack)) points.push_back({c.x, c.y, c.height, of_other, -1, c.name});
  }
  if (theirs.count >= 3)
    for (int k = 0; k < own.count; ++k) {
      const Flat& c = own.at(k);
      if (is_inside(theirs, c.x, c.y, slack))
        points.push_back({c.x, c.y, height_at(theirs, c.x, c.y), of_face, c.name, -1});
    }
  add_crossings(own, theirs, points);
  const double radius = face_is_a ? radii[0] : radii[1], other_radius = face_is_a ? radii[1] : radii[0];
  for (std::size_t k = 0; k < points.size(); ++k) {
    const FacePoint& p = points[k];
    const bool again =
        std::any_of(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(k),
                    [&](const FacePoint& q) { return std::hypot(p.x - q.x, p.y - q.y) <= 2 * slack; });
    if (again) continue;
    const double gap = p.height - radius - other_radius;
    out.add({p.kind, face_is_a ? p.name_face : p.name_other, face_is_a ? p.name_other : p.name_face,
             frame.point(p.x, p.y, radius + 0.5 * gap), gap});
  }
}

namespace {

/// Returns the point shared by a point of each core: midway between the two surfaces, which are opposite each
/// other along the normal.
SharedPoint shared(const Corner& a, const Corner& b, const Vec3& normal, const double radii[2],
                   SharedPoint::Kind kind) {
  const double gap = normal.dot(b.at - a.at) - radii[0] - radii[1];
  return {kind, a.name, b.name, 0.5 * (a.at + b.at + (radii[0] - radii[1]) * normal), gap};
}

Corner on_segment(const Facing& segment, double share) {
  const Vec3 &from = segment.corner[0].at, &to = segment.corner[1].at;
  return {from + share * (to - from), segment.corner[0].name};
}

double nearest_share(const Facing& segment, const Vec3& to) {
  const Vec3 way = segment.corner[1].at - segment.corner[0].at;
  return std::clamp(way.dot(to - segment.corner[0].at) / way.squaredNorm(), 0.0, 1.0);
}

/// Adds the ends of the stretch over which two parallel segments are side by side. Returns false if one
/// segment is wholly beyond the other.
bool share_stretch(const Facing& a, const Facing& b, const Vec3& normal, const double radii[2],
                   SharedPoints& out) {
  using Kind = SharedPoint::Kind;
  const int before = out.count;
  const auto add_ends = [&](const Facing& of, const Facing& other, bool of_a) {
    const Vec3 way = other.corner[1].at - other.corner[0].at;
    for (int k = 0; k < 2; ++k) {
      const double share = way.dot(of.corner[k].at - other.corner[0].at) / way.squaredNorm();
      if (share < 0 || share > 1) continue;
      const Corner foot = on_segment(other, share);
      out.add(of_a ? shared(of.corner[k], foot, normal, radii, Kind::corner_of_a)
                   : shared(foot, of.corner[k], normal, radii, Kind::corner_of_b));
    }
  };
  add_ends(a, b, true);
  add_ends(b, a, false);
  return out.count > before;
}

}  // namespace

void share_edges(const Facing& a, const Facing& b, const Vec3& normal, const double radii[2],
                 SharedPoints& out) {
  using Kind = SharedPoint::Kind;
  if (a.count == 2 && b.count == 2) {
    const Vec3 way_a = a.corner[1].at - a.corner[0].at, way_b = b.corner[1].at - b.corner[0].at;
    const Vec3 across = way_a.cross(way_b);
    const double sine2 = across.squaredNorm() / (way_a.squaredNorm() * way_b.squaredNorm());
    if (sine2 < tolerance::parallel_edges * tolerance::parallel_edges &&
        share_stretch(a, b, normal, radii, out))
      return;
    const Vec3 offset = b.corner[0].at - a.corner[0].at;
    double share =
        sine2 > 0 ? std::clamp(offset.cross(way_b).dot(across) / across.squaredNorm(), 0.0, 1.0) : 0.5;
    const double on_b = nearest_share(b, on_segment(a, share).at);
    share = nearest_share(a, on_segment(b, on_b).at);
    out.add(shared(on_segment(a, share), on_segment(b, on_b), normal, radii, Kind::crossing));
    return;
  }
  const Corner on_a = a.count == 2 ? on_segment(a, nearest_share(a, b.corner[0].at)) : a.corner[0];
  const Corner on_b = b.count == 2 ? on_segment(b, nearest_share(b, a.corner[0].at)) : b.corner[0];
  out.add(shared(on_a, on_b, normal, radii, a.count == 2 ? Kind::corner_of_b : Kind::corner_of_a));
}

namespace {

/// Moves a point to place `slot`: the first of the later points whose value exceeds all values before it by
/// more than the slack.
template <class Value>
void select(std::vector<SharedPoint>& points, std::size_t slot, double slack, Value value) {
  std::size_t best = slot;
  for (std::size_t k = slot + 1; k < points.size(); ++k)
    if (value(points[k]) > value(points[best]) + slack) best = k;
  std::rotate(points.begin() + static_cast<std::ptrdiff_t>(slot),
              points.begin() + static_cast<std::ptrdiff_t>(best),
              points.begin() + static_cast<std::ptrdiff_t>(best) + 1);
}

void reduce(std::vector<SharedPoint>& points, const Vec3& normal, double slack) {
  const auto by_feature = [](const SharedPoint& a, const SharedPoint& b) {
    return a.feature() < b.feature();
  };
  std::stable_sort(points.begin(), points.end(), by_feature);
  if (points.size() <= Manifold::max_points) return;
  const auto doubled = [&](const SharedPoint& a, const SharedPoint& b, const SharedPoint& c) {
    return normal.dot((b.position - a.position).cross(c.position - a.position));
  };
  select(points, 0, slack, [](const SharedPoint& p) { return -p.gap; });
  const auto distance = [&](const SharedPoint& p) { return (p.position - points[0].position).norm(); };
  select(points, 1, slack, distance);
  const double area_slack = slack * distance(points[1]);
  select(points, 2, area_slack,
         [&](const SharedPoint& p) { return std::abs(doubled(points[0], points[1], p)); });
  const double turn = doubled(points[0], points[1], points[2]) < 0 ? -1.0 : 1.0;
  select(points, 3, area_slack, [&](const SharedPoint& p) {
    return std::max({-turn * doubled(points[0], points[1], p), -turn * doubled(points[1], points[2], p),
                     -turn * doubled(points[2], points[0], p)});
  });
  points.resize(Manifold::max_points);
  std::stable_sort(points.begin(), points.end(), by_feature);
}

double least_gap(const SharedPoints& shared) {
  double least = HUGE_VAL;
  for (int k = 0; k < shared.count; ++k) least = std::min(least, shared.point[k].gap);
  return least;
}

}  // namespace

bool take_points(const SharedPoints& shared, const Vec3& normal, const Vec3& origin, double margin,
                 double slack, Manifold& out) {
  std::vector<SharedPoint> points;
  for (int k = 0; k < shared.count; ++k)
    if (shared.point[k].gap <= margin) points.push_back(shared.point[k]);
  if (points.empty()) return false;
  reduce(points, normal, slack);
  out.part = 0;
  out.at_edge = true;
  out.normal = normal;
  out.count = static_cast<int>(points.size());
  for (int k = 0; k < out.count; ++k) {
    const SharedPoint& p = points[static_cast<std::size_t>(k)];
    out.points[k] = {origin + p.position, p.gap, p.feature()};
  }
  return true;
}

bool contact_along(const ConvexBody& a, const ConvexBody& b, const ConvexAxes& axes, double margin,
                   double size, const Vec3& origin, Manifold& out) {
  const double slack = tolerance::same_feature * size;
  const double radii[2] = {a.radius(), b.radius()};
  const ConvexAxis& face = axes.face;
  if (face.owner >= 0 && !clearly_better(axes.best.separation, face.separation, size)) {
    const bool of_a = face.owner == 0;
    const Vec3 outward = of_a ? face.normal : Vec3(-face.normal);
    SharedPoints shared;
    share_face((of_a ? a : b).face_toward(outward, face.face), outward,
               (of_a ? b : a).widest_toward(-outward), of_a, radii, slack, shared);
    // The face must have a point as close as the bodies are: a feature that is not over the face may be
    // closer.
    if (least_gap(shared) <= axes.best.separation + preference(axes.best.separation, size) &&
        take_points(shared, face.normal, origin, margin, slack, out))
      return true;
  }
  const Vec3& normal = axes.best.normal;
  SharedPoints shared;
  share_edges(a.edge_toward(normal), b.edge_toward(-normal), normal, radii, shared);
  // The points may lie beside the place that the best direction touches; the separation along this direction
  // is known all the same, and no gap is smaller.
  for (int k = 0; k < shared.count; ++k)
    shared.point[k].gap = std::max(shared.point[k].gap, axes.best.separation);
  return take_points(shared, normal, origin, margin, slack, out);
}

}  // namespace scree
