#include "render/camera.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

namespace scree::render {

namespace {

struct Ball {
  Vec3 center;
  double radius;
};

struct Floor {
  Vec3 normal, point;
};

// Returns the planes on which bodies can come to rest.
std::vector<Floor> floors_of(const BodyTable& bodies, const Vec3& up) {
  std::vector<Floor> floors;
  for (std::size_t k = 0; k < bodies.shape.size(); ++k) {
    if (bodies.shape[k] != Shape::plane) continue;
    const Vec3 normal = bodies.orientation[k] * Vec3::UnitZ();
    if (normal.dot(up) >= floor_cosine) floors.push_back({normal, bodies.position[k]});
  }
  return floors;
}

// Returns the place where a ball first meets a floor if it falls freely, or the ball itself if it meets none.
Ball landed(const Ball& ball, const std::vector<Floor>& floors, const Vec3& up) {
  double fall = std::numeric_limits<double>::infinity();
  for (const Floor& floor : floors) {
    const double gap = floor.normal.dot(ball.center - floor.point) - ball.radius;
    if (gap > 0) fall = std::min(fall, gap / floor.normal.dot(up));
  }
  return std::isfinite(fall) ? Ball{ball.center - fall * up, ball.radius} : ball;
}

// Returns the balls that the picture is to show.
std::vector<Ball> subjects(const BodyTable& bodies, const Vec3& up) {
  const std::vector<Floor> floors = floors_of(bodies, up);
  std::vector<Ball> moving, fixed;
  Eigen::AlignedBox3d bounds;
  for (std::size_t k = 0; k < bodies.shape.size(); ++k) {
    if (bodies.shape[k] == Shape::plane) continue;
    const Ball ball{bodies.position[k], bounding_radius(bodies.shape[k], bodies.size[k])};
    if (bodies.mobility[k] == Mobility::fixed) {
      fixed.push_back(ball);
      continue;
    }
    moving.push_back(ball);
    bounds.extend(ball.center);
    if (bodies.mobility[k] == Mobility::free) moving.push_back(landed(ball, floors, up));
  }
  if (moving.empty()) return fixed;
  double extent = bounds.diagonal().norm();
  for (const Ball& ball : moving) extent = std::max(extent, 3 * ball.radius);
  for (const Ball& ball : fixed) {
    if (ball.radius <= extent) moving.push_back(ball);
  }
  return moving;
}

}  // namespace

Mat3 axes_of(const Camera& camera) {
  const Vec3 forward = (camera.to - camera.from).normalized();
  Vec3 right = forward.cross(camera.up.normalized());
  // The roll is undetermined if the camera looks straight up or down: then `right` consists of rounding
  // errors.
  const double parallel = std::sqrt(std::numeric_limits<double>::epsilon());
  right = right.norm() > parallel ? Vec3(right.normalized()) : tangent_of(forward);
  Mat3 axes;
  axes << right, right.cross(forward), forward;
  return axes;
}

double grid_cell(const Camera& camera) {
  const double half_height = (camera.to - camera.from).norm() * std::tan(0.5 * camera.fov * pi / 180);
  return std::pow(10.0, std::floor(std::log10(half_height / 4)));
}

Vec3 up_of(const Vec3& gravity) { return gravity.norm() > 0 ? Vec3(-gravity.normalized()) : Vec3::UnitZ(); }

Camera frame_all(const Snapshot& snapshot, const Vec3& gravity, double aspect, double fov) {
  Camera camera;
  camera.up = up_of(gravity);
  camera.fov = fov;
  // The camera looks from the front (against y where up is z), a little from the right, 22 degrees down.
  const Vec3 side = std::abs(camera.up.x()) < 0.9 ? Vec3::UnitX() : Vec3::UnitY();
  const Vec3 right = (side - side.dot(camera.up) * camera.up).normalized();
  const Vec3 back = right.cross(camera.up);
  const Vec3 toward_camera = (0.45 * right + back + 0.45 * camera.up).normalized();
  camera.from = toward_camera;
  camera.to.setZero();
  const Mat3 axes = axes_of(camera);

  // The axes are those of the camera, with z along the view. A ball lies inside the frustum of a camera at c
  // if on each side
  //   +-(x - c_x) cos a - (z - c_z) sin a + r <= 0.
  // So each side gives one bound of c. The bounds of two opposite sides give the camera's place across the
  // view and its distance back.
  const std::vector<Ball> balls = subjects(snapshot.bodies, camera.up);
  if (balls.empty()) return {4 * toward_camera, Vec3::Zero(), camera.up, fov};
  constexpr double margin = 1.12;
  const double tan_y = std::tan(0.5 * fov * pi / 180) / margin;
  const std::array<double, 2> angle = {std::atan(tan_y * aspect), std::atan(tan_y)};
  Vec3 eye(0, 0, std::numeric_limits<double>::infinity());
  for (int axis = 0; axis < 2; ++axis) {
    const double c = std::cos(angle[axis]), s = std::sin(angle[axis]);
    double positive = -std::numeric_limits<double>::infinity(), negative = positive;
    for (const Ball& ball : balls) {
      const Vec3 p = axes.transpose() * ball.center;
      positive = std::max(positive, p[axis] * c - p.z() * s + ball.radius);
      negative = std::max(negative, -p[axis] * c - p.z() * s + ball.radius);
    }
    eye[axis] = (positive - negative) / (2 * c);
    eye.z() = std::min(eye.z(), -(positive + negative) / (2 * s));
  }
  double depth = 0;
  for (const Ball& ball : balls) depth += axes.col(2).dot(ball.center) - eye.z();
  camera.from = axes * eye;
  camera.to = camera.from + axes.col(2) * (depth / static_cast<double>(balls.size()));
  return camera;
}

}  // namespace scree::render
