// Tests of two boxes against the 15 axes and the closest points in long double (bench/narrowphase).
#include "narrowphase/box_box.hpp"

#include "bench/narrowphase/families.hpp"
#include "bench/narrowphase/oracle.hpp"
#include "core/rng.hpp"
#include "tests/narrowphase/families.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace scree {
namespace {

using oracle::Family;
using oracle::SolidPair;

class BoxBoxFamilies : public testing::TestWithParam<Family> {
 protected:
  static constexpr std::uint64_t draws = 12000;
};
INSTANTIATE_TEST_SUITE_P(Each, BoxBoxFamilies, testing::ValuesIn(all_families()), test_name);

TEST_P(BoxBoxFamilies, DepthIsThatOfLongDouble) {
  for (std::uint64_t n = 0; n < draws; ++n) {
    const SolidPair p = oracle::make_pair(GetParam(), n);
    const double found = separating_axes(BoxPair(p.a, p.b), HUGE_VAL).separation;
    const double expected = static_cast<double>(oracle::separation(p.a, p.b));
    const double slack = 1e-12 * p.length;
    ASSERT_LE(found, expected + slack) << "draw " << n;
    ASSERT_GE(found, std::min(expected, 0.0) - slack) << "draw " << n;
    // For boxes that are apart, the depth is only a bound: where edges are parallel to within 1e-6 rad, their
    // axis is left out, and the distance is found by the edges themselves.
  }
}

TEST_P(BoxBoxFamilies, NothingIsMissedOrMadeUp) {
  for (std::uint64_t n = 0; n < draws; ++n) {
    const SolidPair p = oracle::make_pair(GetParam(), n);
    const double smallest = p.smallest;
    const double margin = n % 4 ? 0.05 * smallest : 0.0;
    const double separation = static_cast<double>(oracle::separation(p.a, p.b));
    const double gap = separation > 0 ? static_cast<double>(oracle::distance(p.a, p.b)) : separation;

    Manifold m;
    const bool found = box_box(p.a, p.b, margin, m);
    const double slack = 1e-12 * p.length;
    const double given_away = oracle::most_given_away(gap, smallest) + tolerance::same_feature * smallest;
    if (gap < margin - given_away - slack) {
      ASSERT_TRUE(found) << "draw " << n << " gap " << gap / smallest;
    }
    if (gap > margin + given_away + slack) {
      ASSERT_FALSE(found) << "draw " << n << " gap " << gap / smallest;
    }
    if (!found) continue;

    ASSERT_GE(m.count, 1);
    ASSERT_LE(m.count, Manifold::max_points);
    ASSERT_NEAR(m.normal.norm(), 1.0, 1e-12);
    double smallest_gap = HUGE_VAL;
    std::set<std::uint32_t> features;
    for (int k = 0; k < m.count; ++k) {
      ASSERT_TRUE(m.points[k].position.allFinite());
      ASSERT_TRUE(std::isfinite(m.points[k].gap));
      ASSERT_LE(m.points[k].gap, margin + slack);
      smallest_gap = std::min(smallest_gap, m.points[k].gap);
      features.insert(m.points[k].feature);
    }
    EXPECT_EQ(features.size(), static_cast<std::size_t>(m.count)) << "draw " << n;
    ASSERT_NEAR(smallest_gap, gap, given_away + slack) << "draw " << n << " of " << smallest;
    // The normal is nearly that of the least overlap, and the points lie in both boxes, grown by the gap.
    const oracle::Box a(p.a), b(p.b);
    const double along = static_cast<double>(oracle::separation_along(a, b, m.normal.cast<oracle::Real>()));
    ASSERT_GE(along, separation - given_away - slack) << "draw " << n;
    for (int k = 0; k < m.count; ++k) {
      const oracle::Vec at = m.points[k].position.cast<oracle::Real>();
      const double off = 0.5 * std::fabs(m.points[k].gap) + given_away + 1e-6 * smallest + slack;
      ASSERT_LE(static_cast<double>((at - a.nearest(at)).norm()), off) << "draw " << n << " point " << k;
      ASSERT_LE(static_cast<double>((at - b.nearest(at)).norm()), off) << "draw " << n << " point " << k;
    }
  }
}

TEST_P(BoxBoxFamilies, SwapTurnsTheNormal) {
  int steady = 0, compared = 0;
  for (std::uint64_t n = 0; n < draws; ++n) {
    const SolidPair p = oracle::make_pair(GetParam(), n);
    const double smallest = p.smallest;
    Manifold ab, ba;
    const bool found = box_box(p.a, p.b, 0.05 * smallest, ab);
    ASSERT_EQ(found, box_box(p.b, p.a, 0.05 * smallest, ba)) << "draw " << n;
    if (!found) continue;
    ++compared;
    // Where the two faces are equally good, that of the first body is taken, so that the normals may differ
    // by as much as the faces; otherwise the result is the same.
    if ((ab.normal + ba.normal).norm() > 1e-13) continue;
    ++steady;
    ASSERT_EQ(ab.count, ba.count) << "draw " << n;
    std::vector<double> gaps[2];
    for (int k = 0; k < ab.count; ++k) {
      gaps[0].push_back(ab.points[k].gap);
      gaps[1].push_back(ba.points[k].gap);
    }
    std::sort(gaps[0].begin(), gaps[0].end());
    std::sort(gaps[1].begin(), gaps[1].end());
    for (int k = 0; k < ab.count; ++k) {
      ASSERT_NEAR(gaps[0][k], gaps[1][k], (1e-12 + 2 * tolerance::same_feature * (ab.count > 1)) * p.length);
    }
  }
  if (GetParam() == Family::any) {
    EXPECT_GT(steady, 0.9 * compared);
  }
}

// This tests only random pairs: degenerate ones choose among equals by rounding.
TEST(BoxBox, MovesWithTheFrame) {
  Random random(5, 0);
  for (std::uint64_t n = 0; n < 3000; ++n) {
    const SolidPair p = oracle::make_pair(Family::any, n);
    const double smallest = p.smallest;
    const Quat turn = oracle::random_turn(random);
    const Vec3 shift = 10 * oracle::random_unit(random);
    const auto moved = [&](const Solid& s) {
      return Solid{turn * s.position + shift, (turn * s.orientation).normalized(), s.size};
    };
    Manifold still, turned;
    const bool found = box_box(p.a, p.b, 0.05 * smallest, still);
    ASSERT_EQ(found, box_box(moved(p.a), moved(p.b), 0.05 * smallest, turned)) << "draw " << n;
    if (!found) continue;
    ASSERT_EQ(still.count, turned.count) << "draw " << n;
    ASSERT_LT((turn * still.normal - turned.normal).norm(), 1e-7) << "draw " << n;
    for (int k = 0; k < still.count; ++k) {
      ASSERT_EQ(still.points[k].feature, turned.points[k].feature) << "draw " << n;
      ASSERT_NEAR(still.points[k].gap, turned.points[k].gap, 2e-11);
      ASSERT_LT((turn * still.points[k].position + shift - turned.points[k].position).norm(), 1e-9);
    }
  }
}

/// Returns the 24 rotations of a cube onto itself.
std::vector<Mat3> cube_turns() {
  std::vector<Mat3> turns;
  for (int x = 0; x < 3; ++x) {
    for (int y = 0; y < 3; ++y) {
      if (x == y) continue;
      for (const double side : {-1, 1, -2, 2}) {
        Mat3 turn;
        turn.col(0) = (side < 0 ? -1 : 1) * Vec3::Unit(x);
        turn.col(1) = (std::fabs(side) > 1 ? -1 : 1) * Vec3::Unit(y);
        turn.col(2) = turn.col(0).cross(turn.col(1));
        turns.push_back(turn);
      }
    }
  }
  return turns;
}

/// Returns the same box with its axes named otherwise.
Solid relabelled(const Solid& box, const Mat3& turn) {
  return {box.position, (box.orientation * Quat(turn)).normalized(), turn.cwiseAbs().transpose() * box.size};
}

/// Returns the mirror image of a turned box at x = 0, which is a turned box again, since a box is its own
/// mirror image along its axes.
Solid mirrored(const Solid& s) {
  return {Vec3(-s.position.x(), s.position.y(), s.position.z()),
          Quat(s.orientation.w(), s.orientation.x(), -s.orientation.y(), -s.orientation.z()), s.size};
}
Vec3 mirrored(const Vec3& v) { return Vec3(-v.x(), v.y(), v.z()); }

std::vector<Vec3> sorted_positions(const Manifold& m) {
  std::vector<Vec3> all;
  for (int k = 0; k < m.count; ++k) all.push_back(m.points[k].position);
  std::sort(all.begin(), all.end(), [](const Vec3& p, const Vec3& q) { return p.x() < q.x(); });
  return all;
}

// This, too, tests only random pairs.
TEST(BoxBox, NamesOfAxesAndMirrorsDoNotMatter) {
  const std::vector<Mat3> turns = cube_turns();
  ASSERT_EQ(turns.size(), 24u);
  int compared = 0;
  for (std::uint64_t n = 0; n < 2000; ++n) {
    const SolidPair p = oracle::make_pair(Family::any, n);
    const double margin = 0.05 * p.smallest;
    Manifold plain;
    if (!box_box(p.a, p.b, margin, plain)) continue;
    const std::vector<Vec3> expected = sorted_positions(plain);
    for (std::size_t t = 0; t < turns.size(); ++t) {
      for (const bool mirror : {false, true}) {
        Solid a = relabelled(p.a, turns[t]), b = relabelled(p.b, turns[(t + n) % turns.size()]);
        if (mirror) a = mirrored(a), b = mirrored(b);
        Manifold m;
        ASSERT_TRUE(box_box(a, b, margin, m)) << "draw " << n << " turn " << t;
        if (mirror) {
          m.normal = mirrored(m.normal);
          for (int k = 0; k < m.count; ++k) m.points[k].position = mirrored(m.points[k].position);
        }
        ASSERT_EQ(m.count, plain.count) << "draw " << n << " turn " << t;
        ASSERT_LT((m.normal - plain.normal).norm(), 1e-7) << "draw " << n << " turn " << t;
        const std::vector<Vec3> positions = sorted_positions(m);
        for (std::size_t k = 0; k < expected.size(); ++k)
          ASSERT_LT((positions[k] - expected[k]).norm(), 1e-9) << "draw " << n << " turn " << t;
        ASSERT_NEAR(detail::smallest_gap(m), detail::smallest_gap(plain), 1e-12);
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 48 * 1000);
}

// The depth is that along the axis that separates the boxes best, though the edges of this axis are too
// nearly parallel for it to be chosen beside faces.
TEST(BoxBox, NearlyParallelEdgesThatTouchAreNoDeepContact) {
  const std::pair<Family, std::uint64_t> found[] = {{Family::tilted, 343326},
                                                    {Family::parallel_edges, 207920},
                                                    {Family::parallel_edges, 360564},
                                                    {Family::parallel_edges, 554676}};
  for (const auto& [family, n] : found) {
    const SolidPair p = oracle::make_pair(family, n);
    const double depth = -static_cast<double>(oracle::separation(p.a, p.b));
    Manifold m;
    ASSERT_TRUE(box_box(p.a, p.b, 0, m));
    EXPECT_NEAR(-detail::smallest_gap(m), depth, oracle::most_given_away(-depth, p.smallest));
  }
}

/// Boxes are brought together until their best axis separates them by no more than rounding.
TEST(BoxBox, BoxesThatJustTouchDoNotOverlapWithoutAMargin) {
  constexpr std::uint64_t trials = 40000;
  int touching = 0;
  for (std::uint64_t trial = 0; trial < trials; ++trial) {
    Random random(29, trial);
    const auto vector = [&random](double most) {
      const double x = random.uniform(-most, most);
      const double y = random.uniform(-most, most);
      return Vec3(x, y, random.uniform(-most, most));
    };
    const auto half = [&random] { return random.uniform(0.3, 1); };
    const auto size = [&half] {
      const double x = half(), y = half();
      return Vec3(x, y, half());
    };
    // Any two boxes, boxes that lie nearly flat on one another, boxes with parallel edges, aligned boxes.
    const Quat turns[] = {rotation_of(vector(3)), rotation_of(vector(0.02)),
                          rotation_of(Vec3(0, 0, random.uniform(-1, 1))), Quat::Identity()};
    const Solid a{Vec3::Zero(), rotation_of(vector(2)), size()};
    Solid b{Vec3::Zero(), a.orientation * turns[trial % 4], size()};
    const Vec3 direction = vector(1).normalized();
    double near = 0, far = 6;
    while (far - near > 1e-15 * far) {
      const double middle = 0.5 * (near + far);
      if (middle <= near || middle >= far) break;
      b.position = middle * direction;
      (separating_axes(BoxPair(a, b), far).separation < 0 ? near : far) = middle;
    }
    for (const double distance : {near, far}) {
      b.position = distance * direction;
      Manifold m;
      if (!box_box(a, b, 0, m)) continue;
      ++touching;
      const double rounding = tolerance::axis_preference_length * BoxPair(a, b).smallest;
      for (int k = 0; k < m.count; ++k) ASSERT_GT(m.points[k].gap, -1.01 * rounding) << trial;
    }
  }
  EXPECT_GT(touching, 30000);
}

/// A box that lies nearly flat on another one touches it at one point and turns about that point. The points
/// of the contact, and not only the one at which they touch, predict where the boxes meet next.
TEST(BoxBox, WhatLiesNearlyFlatHasPointsWhereItMayMeet) {
  double worst = 0;
  int at_edges = 0;
  for (std::uint64_t item = 0; item < 2000; ++item) {
    Random random(41, item);
    const Solid a{Vec3::Zero(), Quat::Identity(), Vec3(1, 0.8, 0.5)};
    Solid b{Vec3(random.uniform(-1, 1), random.uniform(-0.8, 0.8), 0), Quat::Identity(),
            Vec3(random.uniform(0.4, 1), random.uniform(0.4, 1), random.uniform(0.3, 0.6))};
    const auto turn = [](double angle, const Vec3& axis) { return Quat(Eigen::AngleAxisd(angle, axis)); };
    const double tilt_x = random.uniform(-0.05, 0.05), tilt_y = random.uniform(-0.05, 0.05);
    b.orientation =
        turn(tilt_x, Vec3::UnitX()) * turn(tilt_y, Vec3::UnitY()) * turn(random.uniform(0, 3), Vec3::UnitZ());
    double low = 0, high = 2;  // the boxes touch between these heights
    Manifold touching;
    for (int k = 0; k < 50; ++k) {
      b.position.z() = 0.5 * (low + high);
      const bool apart = !box_box(a, b, 1, touching) || detail::smallest_gap(touching) > 0;
      (apart ? high : low) = b.position.z();
    }
    b.position.z() = high;
    Manifold m;
    ASSERT_TRUE(box_box(a, b, 0.4, m)) << item;
    if (m.normal.z() < 0.95) continue;  // the boxes are beside one another
    at_edges += m.at_edge ? 0 : 1;
    int pivot = 0;
    for (int k = 1; k < m.count; ++k)
      if (m.points[k].gap < m.points[pivot].gap) pivot = k;
    const Vec3 centre = m.points[pivot].position;
    const double direction = random.uniform(0, 2 * pi);
    const double angle = random.uniform(0, 0.1);
    const Quat turned = turn(angle, Vec3(std::cos(direction), std::sin(direction), 0));
    const Solid later{Vec3(centre + turned * (b.position - centre)), turned * b.orientation, b.size};
    Manifold met;
    const double depth = box_box(a, later, 0, met) ? -detail::smallest_gap(met) : 0.0;
    double foretold = 0;
    for (int k = 0; k < m.count; ++k) {
      const Vec3 arm = m.points[k].position - centre;
      foretold = std::max(foretold, -(m.points[k].gap + m.normal.dot(Vec3(turned * arm) - arm)));
    }
    worst = std::max(worst, depth - foretold);
  }
  EXPECT_GT(at_edges, 100);
  EXPECT_LT(worst, 0.05);  // boxes of some 2 m turn by up to 0.1 rad; without these points it would be 0.15
}

TEST_P(BoxBoxFamilies, UnitsDoNotMatter) {
  for (std::uint64_t n = 0; n < draws / 4; ++n) {
    const SolidPair p = oracle::make_pair(GetParam(), n);
    const double margin = 0.05 * p.smallest;
    for (const double unit : {0x1p-20, 0x1p10}) {  // powers of 2 keep the bits
      const auto scaled = [unit](const Solid& s) {
        return Solid{unit * s.position, s.orientation, unit * s.size};
      };
      Manifold one, other;
      const bool found = box_box(p.a, p.b, margin, one);
      ASSERT_EQ(found, box_box(scaled(p.a), scaled(p.b), unit * margin, other));
      if (!found) continue;
      ASSERT_EQ(one.count, other.count);
      ASSERT_EQ(one.normal, other.normal);
      for (int k = 0; k < one.count; ++k) {
        ASSERT_EQ(one.points[k].feature, other.points[k].feature);
        ASSERT_EQ(unit * one.points[k].gap, other.points[k].gap);
        ASSERT_EQ(Vec3(unit * one.points[k].position), other.points[k].position);
      }
    }
  }
}

double polygon_area(const Manifold& m, Vec3& centroid) {
  // The 4 points of a manifold are in the order of their features; sorted around the centre they make the
  // polygon.
  centroid = Vec3::Zero();
  for (int k = 0; k < m.count; ++k) centroid += m.points[k].position / m.count;
  const Vec3 u = tangent_of(m.normal), w = m.normal.cross(u);
  std::vector<Vec3> around;
  for (int k = 0; k < m.count; ++k) around.push_back(m.points[k].position - centroid);
  std::sort(around.begin(), around.end(), [&](const Vec3& p, const Vec3& q) {
    return std::atan2(w.dot(p), u.dot(p)) < std::atan2(w.dot(q), u.dot(q));
  });
  double area = 0;
  for (int k = 0; k < m.count; ++k) {
    area += 0.5 * m.normal.dot(around[k].cross(around[(k + 1) % m.count]));
  }
  return area;
}

TEST(BoxBox, AlignedFacesShareTheirRectangle) {
  Random random(6, 0);
  for (int n = 0; n < 2000; ++n) {
    const Vec3 a = Vec3(0.5, 0.6, 0.7), b = Vec3(0.4, 0.8, 0.3);
    const double x = random.uniform(-0.85, 0.85), y = random.uniform(-1.3, 1.3),
                 depth = random.uniform(0, 1e-3);
    const Quat turn = oracle::random_turn(random);
    Manifold m;
    ASSERT_TRUE(box_box({Vec3::Zero(), turn, a}, {turn * Vec3(x, y, 1.0 - depth), turn, b}, 0.0, m));
    const double lo_x = std::max(-0.5, x - 0.4), hi_x = std::min(0.5, x + 0.4);
    const double lo_y = std::max(-0.6, y - 0.8), hi_y = std::min(0.6, y + 0.8);
    if (std::min(hi_x - lo_x, hi_y - lo_y) < 0.01) continue;  // a side face may be nearer
    ASSERT_EQ(m.count, 4);
    Vec3 centroid;
    EXPECT_NEAR(polygon_area(m, centroid), (hi_x - lo_x) * (hi_y - lo_y), 1e-12);
    EXPECT_LT((centroid - turn * Vec3(0.5 * (lo_x + hi_x), 0.5 * (lo_y + hi_y), 0.7 - 0.5 * depth)).norm(),
              1e-12);
    for (int k = 0; k < 4; ++k) EXPECT_NEAR(m.points[k].gap, -depth, 1e-12);
  }
}

TEST(BoxBox, AStackKeepsItsManifoldUnderNoise) {
  // The cubes have equal or offset footprints, or are turned by 45 degrees, so that 8 points are reduced to
  // 4.
  const Vec3 cube = Vec3::Constant(0.5);
  for (const double yaw : {0.0, pi / 4, 0.3}) {
    for (const Vec3& offset : {Vec3(0, 0, 1), Vec3(0.2, 0.1, 1), Vec3(0.25, 0, 1)}) {
      Random random(7, 0);
      std::set<std::vector<std::uint32_t>> seen;
      const Quat turn = rotation_of(yaw * Vec3::UnitZ());
      for (int n = 0; n < 2000; ++n) {
        const auto noise = [&random] { return Vec3(1e-9 * oracle::random_unit(random)); };
        Manifold m;
        ASSERT_TRUE(box_box({noise(), rotation_of(noise()), cube},
                            {offset + noise(), (rotation_of(noise()) * turn).normalized(), cube}, 1e-3, m));
        EXPECT_GT(m.normal.z(), 0.999999);
        std::vector<std::uint32_t> features;
        for (int k = 0; k < m.count; ++k) features.push_back(m.points[k].feature);
        EXPECT_EQ(m.count, 4);
        seen.insert(features);
      }
      EXPECT_EQ(seen.size(), 1u) << "yaw " << yaw << " offset " << offset.transpose();
    }
  }
}

TEST(BoxBox, DepthIsContinuousAlongASlide) {
  const Solid a{Vec3::Zero(), rotation_of(Vec3(0.1, 0.05, 0.2)), Vec3(1, 0.7, 0.5)};
  const double step = 5e-4;
  double before = NAN;
  int changes = 0, flips = 0;
  Vec3 normal_before = Vec3::Zero();
  std::vector<std::uint32_t> features_before;
  for (int n = 0; n < 10000; ++n) {
    const Solid b{Vec3(-2.5 + n * step, 0.1, 0.75), rotation_of(Vec3(0.3, -0.1, 0.7)), Vec3(0.4, 0.5, 0.3)};
    Manifold m;
    if (!box_box(a, b, 0.0, m)) {
      before = NAN;
      continue;
    }
    const double gap = detail::smallest_gap(m);
    if (!std::isnan(before)) {
      const double jump = 2 * step + oracle::most_given_away(gap, 0.3);
      EXPECT_NEAR(gap, before, jump) << "step " << n;
    }
    before = gap;
    flips += m.normal.dot(normal_before) < 0.999;
    normal_before = m.normal;
    std::vector<std::uint32_t> features;
    for (int k = 0; k < m.count; ++k) features.push_back(m.points[k].feature);
    changes += features != features_before;
    features_before = features;
  }
  EXPECT_GT(changes, 2);
  EXPECT_LT(changes, 40);
  EXPECT_LT(flips, 6);  // at the first contact, onto the face, off it, and at edges between
}

TEST(BoxBox, BoxesBesideEachOtherDoNotBlock) {
  // The second cube is diagonally above the first one: the nearest features are two parallel edges, and the
  // normal is the line between them.
  const Vec3 cube = Vec3::Constant(0.5);
  Manifold m;
  ASSERT_TRUE(
      box_box({Vec3::Zero(), Quat::Identity(), cube}, {Vec3(1.03, 0, 1.04), Quat::Identity(), cube}, 0.1, m));
  ASSERT_EQ(m.count, 1);
  EXPECT_NEAR(m.points[0].gap, 0.05, 1e-12);
  EXPECT_LT((m.normal - Vec3(0.6, 0, 0.8)).norm(), 1e-12);
  EXPECT_FALSE(box_box({Vec3::Zero(), Quat::Identity(), cube}, {Vec3(1.03, 0, 1.04), Quat::Identity(), cube},
                       0.049, m));
}

}  // namespace
}  // namespace scree
