// Tests of planes that separate bodies in motion: they must never hide a collision. The oracle is the overlap
// of boxes and balls in long double.
#include "narrowphase/separating_face.hpp"

#include "core/geometry.hpp"
#include "core/rng.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace scree {
namespace {

using Long = long double;
using LongVec = Eigen::Matrix<Long, 3, 1>;
using LongMat = Eigen::Matrix<Long, 3, 3>;

/// A body that moves along a straight line.
struct Moving {
  Shape shape;
  Solid solid;
  Vec3 way;

  Solid at(double share) const {
    Solid moved = solid;
    moved.position += share * way;
    return moved;
  }
  Instants<ShapedSolid> instants(double seen) const {
    return {{shape, solid}, {shape, at(seen)}, {shape, at(1)}};
  }
};

struct LongBox {
  LongVec centre;
  LongMat axes;
  LongVec half;
  explicit LongBox(const Solid& box)
      : centre(box.position.cast<Long>()),
        axes(box.orientation.cast<Long>().normalized().toRotationMatrix()),
        half(box.size.cast<Long>()) {}
};

/// Returns how deep two boxes overlap: the least overlap over the 15 axes, which is 0 or less if they do not.
Long overlap(const LongBox& a, const LongBox& b) {
  Long least = HUGE_VALL;
  const auto look = [&](LongVec axis) {
    if (axis.norm() < 1e-9L) return;
    axis.normalize();
    const Long reach = a.half.dot((a.axes.transpose() * axis).cwiseAbs()) +
                       b.half.dot((b.axes.transpose() * axis).cwiseAbs());
    least = std::min(least, reach - std::abs(axis.dot(b.centre - a.centre)));
  };
  for (int k = 0; k < 3; ++k) {
    look(a.axes.col(k));
    look(b.axes.col(k));
    for (int m = 0; m < 3; ++m) look(a.axes.col(k).cross(b.axes.col(m)));
  }
  return least;
}

/// Returns how deep a ball is below the surface of a box, from outside; 0 or less if it does not touch it.
Long overlap(const LongVec& centre, Long radius, const LongBox& box) {
  const LongVec local = box.axes.transpose() * (centre - box.centre);
  const LongVec beyond = (local.cwiseAbs() - box.half).cwiseMax(0);
  const Long inside = (box.half - local.cwiseAbs()).minCoeff();
  return beyond.norm() > 0 ? radius - beyond.norm() : radius + inside;
}

Long overlap(const Moving& a, const Moving& b, double share) {
  const Solid of_a = a.at(share), of_b = b.at(share);
  if (a.shape == Shape::box) return overlap(LongBox(of_a), LongBox(of_b));
  return overlap(of_a.position.cast<Long>(), of_a.size.x(), LongBox(of_b));
}

/// Draws bodies that come over a box, at its edges, level with its top or a little off, and bodies that fly
/// at it from anywhere.
class Encounters {
 public:
  explicit Encounters(std::uint64_t item) : random_(7, item) {}

  void make(double size, Moving& mover, Moving& box) {
    const auto between = [&](double low, double high) { return random_.uniform(low, high); };
    const auto turn = [&](double most) {
      const Vec3 axis(between(-1, 1), between(-1, 1), between(-1, 1));
      return Quat(Eigen::AngleAxisd(most * random_.uniform(), axis.normalized()));
    };
    const bool level = random_.uniform() < 0.7;
    box = {Shape::box,
           {Vec3::Zero(), Quat::Identity(), size * Vec3(between(0.3, 2), between(0.3, 2), between(0.02, 1))},
           Vec3::Zero()};
    mover.shape = random_.uniform() < 0.4 ? Shape::sphere : Shape::box;
    mover.solid.size = size * Vec3(between(0.1, 1), between(0.1, 1), between(0.1, 1));
    if (mover.shape == Shape::sphere) mover.solid.size = Vec3(mover.solid.size.x(), 0, 0);
    mover.solid.orientation = level ? Quat::Identity() : turn(3);
    const double half = mover.shape == Shape::sphere ? mover.solid.size.x() : mover.solid.size.z();
    const double off = std::pow(10.0, between(-12, -1)) * size * (random_.uniform() < 0.5 ? 1 : -1);
    const double beside = box.solid.size.x() + mover.solid.size.x() * between(-0.2, 1.5);
    mover.solid.position = Vec3(-beside, between(-0.5, 0.5) * size, box.solid.size.z() + half + off);
    mover.way = size * Vec3(between(0, 1), between(-0.3, 0.3), level ? 0 : between(-1, 1));
    if (!level) mover.solid.position += size * Vec3(between(-1, 1), between(-1, 1), between(-1, 1));
    const Quat all = turn(3);
    for (Moving* body : {&mover, &box}) {
      body->solid.position = all * body->solid.position;
      body->solid.orientation = (all * body->solid.orientation).normalized();
      body->way = all * body->way;
    }
  }

 private:
  Random random_;
};

TEST(SeparatingFace, HidesNoCollision) {
  int separated = 0, collided = 0;
  for (std::uint64_t item = 0; item < 20000; ++item) {
    const double size = std::array{1e-3, 1.0, 1e3}[item % 3];
    Moving mover, box;
    Encounters(item).make(size, mover, box);
    const double slack = 1e-6 * size;
    const SeparatingFace face =
        find_separating_face(mover.instants(0.5), box.instants(0.5), {}, slack, Vec3::Zero());
    Long deepest = -HUGE_VALL;
    for (int k = 0; k <= 40; ++k) deepest = std::max(deepest, overlap(mover, box, k / 40.0));
    collided += deepest > 2 * slack;
    if (!face.exists()) continue;
    ++separated;
    // Bodies with a separating face overlap by the slack at most at the beginning, and by as much again on
    // their way.
    ASSERT_LE(deepest, 2 * slack * 1.001L) << item;
  }
  EXPECT_GT(separated, 3000);
  EXPECT_GT(collided, 3000);
}

/// A step up counts as one if it is higher than the slack; a step down never does.
TEST(SeparatingFace, TellsAStepUpFromALevelSeam) {
  Random random(11, 0);
  for (int k = 0; k < 20000; ++k) {
    const double size = std::pow(10.0, -3 + 6 * random.uniform());
    const double slack = 1e-6 * size;
    const double up =
        slack * (k % 2 == 0 ? 1.001 * std::pow(10.0, 5 * random.uniform()) : 0.999 - 2 * random.uniform());
    const bool ball = random.uniform() < 0.5;
    const double half = 0.1 * size, gap = size * (0.01 * random.uniform());
    const Moving mover{ball ? Shape::sphere : Shape::box,
                       {Vec3(-half - gap, 0.1 * size * random.uniform(), half), Quat::Identity(),
                        ball ? Vec3(half, 0, 0) : Vec3(half, half, half)},
                       Vec3(size * (0.1 + random.uniform()), 0, 0)};
    const Moving tile{Shape::box,
                      {Vec3(0.5 * size, 0, up - 0.25 * size), Quat::Identity(), size * Vec3(0.5, 0.5, 0.25)},
                      Vec3::Zero()};
    const SeparatingFace face =
        find_separating_face(mover.instants(0), tile.instants(0), {}, slack, Vec3::Zero());
    ASSERT_EQ(face.exists(), up < slack) << up / slack;
    if (!face.exists()) continue;
    ASSERT_GT(-face.normal.z(), 1 - 1e-12);
    ASSERT_NEAR(face.separation, -up, 1e-12 * size);
  }
}

/// The faces of a polyhedron that is a box are those of the box.
TEST(SeparatingFace, IsTheSameForAHullOfABox) {
  std::array<Vec3, 8> corners;
  int separated = 0;
  for (std::uint64_t item = 0; item < 2000; ++item) {
    Moving mover, box;
    Encounters(item).make(1, mover, box);
    for (std::size_t c = 0; c < 8; ++c)
      corners[c] = Vec3(c & 1 ? 1 : -1, c & 2 ? 1 : -1, c & 4 ? 1 : -1).cwiseProduct(box.solid.size);
    const Hull hull = make_hull(corners);
    const ShapeData data{.hull = &hull};
    Moving same = box;
    same.shape = Shape::polyhedron;
    same.solid.orientation = box.solid.orientation * hull.axes;
    const auto by = [&](const Moving& other, const PairShapes& shapes) {
      return find_separating_face(mover.instants(0.3), other.instants(0.3), shapes, 1e-6, Vec3(0, 0, 0.01));
    };
    const SeparatingFace of_box = by(box, {}), of_hull = by(same, {nullptr, &data});
    ASSERT_EQ(of_box.exists(), of_hull.exists()) << item;
    if (!of_box.exists()) continue;
    ++separated;
    ASSERT_NEAR(of_box.approach, of_hull.approach, 1e-9) << item;
  }
  EXPECT_GT(separated, 300);
}

}  // namespace
}  // namespace scree
