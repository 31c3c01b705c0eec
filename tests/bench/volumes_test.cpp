// Tests of bounding volumes: no volume misses bodies that touch, each holds its body, and their sizes and
// frequencies of overlap agree with closed forms, with integral geometry and with points drawn at random.
#include "bench/narrowphase/families.hpp"
#include "bench/narrowphase/oracle.hpp"
#include "bench/volumes/box.hpp"
#include "bench/volumes/comparison.hpp"
#include "bench/volumes/dop.hpp"
#include "bench/volumes/sphere.hpp"
#include "bench/volumes/swept_sphere.hpp"
#include "core/random_orientation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

namespace scree::bench {
namespace {

using oracle::Real;
using oracle::Vec;

constexpr double standard_deviations = 5;  // tolerance of counts and sums of random draws

template <class Fit>
auto volume_around(const Solid& box, double margin = 0) {
  return Fit(box.size, margin).place(box.position, box.orientation);
}

// ---- Which points a volume holds, by its definition ----

template <class Vector>
Vec exact(const Vector& v) {
  return v.template cast<Real>();
}

bool holds(const Sphere& sphere, const Vec& p) { return (p - exact(sphere.centre)).norm() <= sphere.radius; }

bool holds(const Aabb& box, const Vec& p) {
  for (int a = 0; a < 3; ++a) {
    if (p[a] < box.lo[a] || p[a] > box.hi[a]) return false;
  }
  return true;
}

bool holds(const Obb& box, const Vec& p) {
  const Vec at = box.axes.cast<Real>().transpose() * (p - exact(box.centre));
  return (at.cwiseAbs().array() <= box.half.cast<Real>().array()).all();
}

/// Returns the multiple of a half side, in [-1, 1], that is nearest to a point; 0 if the side has no length.
Real nearest(const Vec& half_side, const Vec& p) {
  const Real square = half_side.squaredNorm();
  return square > 0 ? std::clamp(half_side.dot(p) / square, Real(-1), Real(1)) : Real(0);
}

bool holds(const Capsule& capsule, const Vec& p) {
  const Vec along = exact(capsule.along), at = p - exact(capsule.centre);
  return (at - nearest(along, at) * along).norm() <= capsule.radius;
}

bool holds(const SweptRectangle& volume, const Vec& p) {
  const Vec along = exact(volume.along), across = exact(volume.across), at = p - exact(volume.centre);
  return (at - nearest(along, at) * along - nearest(across, at) * across).norm() <= volume.radius;
}

template <int faces>
bool holds(const Dop<faces>& dop, const Vec& p) {
  for (int k = 0; k < Dop<faces>::slabs; ++k) {
    const Real at = Dop<faces>::direction(k).template cast<Real>().dot(p);
    if (at < dop.lo[k] || at > dop.hi[k]) return false;
  }
  return true;
}

// ---- Mean excluded volume ----
// It is the volume of all positions at which one volume overlaps the other, averaged over random
// orientations.

/// Volume V, surface S and integral of mean curvature M of a convex body. Two such bodies have the mean
/// excluded volume V_a + V_b + (S_a M_b + S_b M_a) / 4 pi (Isihara 1950).
struct Measures {
  double volume, surface, curvature;
};

double excluded(const Measures& a, const Measures& b) {
  return a.volume + b.volume + (a.surface * b.curvature + b.surface * a.curvature) / (4 * pi);
}

/// Returns the measures of a rectangle with half sides l and m that is swept by a sphere of radius r. Surface
/// and curvature are derivatives of the volume with respect to r (Steiner).
Measures swept(double l, double m, double r) {
  return {swept_volume(l, m, r), 8 * l * m + 4 * pi * (l + m) * r + 4 * pi * r * r,
          2 * pi * (l + m) + 4 * pi * r};
}

double excluded(const Sphere& a, const Sphere& b) {
  return excluded(swept(0, 0, a.radius), swept(0, 0, b.radius));
}
double excluded(const Capsule& a, const Capsule& b) {
  return excluded(swept(a.along.norm(), 0, a.radius), swept(b.along.norm(), 0, b.radius));
}
double excluded(const SweptRectangle& a, const SweptRectangle& b) {
  return excluded(swept(a.along.norm(), a.across.norm(), a.radius),
                  swept(b.along.norm(), b.across.norm(), b.radius));
}
double excluded(const Obb& a, const Obb& b) {
  return excluded_volume(a.half.cast<double>(), b.half.cast<double>());
}
/// AABBs and DOPs do not turn with their bodies, so that this is no mean but the value for these two.
double excluded(const Aabb& a, const Aabb& b) {
  double volume = 1;
  for (int k = 0; k < 3; ++k) volume *= (a.hi[k] - a.lo[k]) + (b.hi[k] - b.lo[k]);
  return volume;
}
template <int faces>
double excluded(const Dop<faces>& a, const Dop<faces>& b) {
  std::vector<Slab> slabs;
  for (int k = 0; k < Dop<faces>::slabs; ++k)
    slabs.push_back({Dop<faces>::direction(k), a.lo[k] - b.hi[k], a.hi[k] - b.lo[k]});
  return volume_of(slabs);
}

Solid random_box(BoxFamily family, std::uint64_t n) {
  Random random(311, n);
  const Vec3 half = random_half_extents(family, random);
  const Vec3 at(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
  return {at, random_orientation(random), half};
}

template <class Action>
void for_each_family(Action action) {
  for (int f = 0; f < static_cast<int>(BoxFamily::count); ++f) action(static_cast<BoxFamily>(f));
}

/// Expects that `found` of `draws` random draws is a likely count if each succeeds with probability `share`.
void expect_share(std::int64_t found, std::int64_t draws, double share, const char* of) {
  const double deviation = std::sqrt(static_cast<double>(draws) * share * (1 - share));
  EXPECT_NEAR(static_cast<double>(found), static_cast<double>(draws) * share, standard_deviations * deviation)
      << of;
}

template <class Fit>
class Volumes : public testing::Test {};
using Fits = testing::Types<SphereFit, AabbFit, ObbFit, CapsuleFit, SweptRectangleFit, DopFit<8>, DopFit<14>>;
struct FitName {
  template <class Fit>
  static std::string GetName(int) {
    return Fit::name;
  }
};
TYPED_TEST_SUITE(Volumes, Fits, FitName);

TYPED_TEST(Volumes, MissNothing) {
  std::int64_t touching = 0;
  for (int f = 0; f < static_cast<int>(oracle::Family::count); ++f) {
    const auto family = static_cast<oracle::Family>(f);
    for (std::uint64_t n = 0; n < 5000; ++n) {
      const oracle::SolidPair pair = oracle::make_pair(family, n);
      if (oracle::separation(pair.a, pair.b) > 0) continue;
      ++touching;
      const auto a = volume_around<TypeParam>(pair.a), b = volume_around<TypeParam>(pair.b);
      ASSERT_TRUE(overlap(a, b)) << oracle::name_of(family) << " " << n;
      ASSERT_TRUE(overlap(b, a)) << oracle::name_of(family) << " " << n;
      ASSERT_TRUE(overlap(box_of(a), box_of(b))) << oracle::name_of(family) << " " << n;
    }
  }
  EXPECT_GT(touching, 30000);
}

TYPED_TEST(Volumes, HoldTheirBodies) {
  for (int f = 0; f < static_cast<int>(oracle::Family::count); ++f) {
    const auto family = static_cast<oracle::Family>(f);
    for (std::uint64_t n = 0; n < 3000; ++n) {
      const Solid body = oracle::make_pair(family, n).a;
      const double margin = n % 2 == 0 ? 0 : 0.3 * body.size.minCoeff();
      const auto volume = volume_around<TypeParam>(body, margin);
      const Aabb box = box_of(volume);
      Random random(315, n);
      for (const Vec& corner : oracle::Box(body).vertices) {
        const Vec at = corner + margin * exact(oracle::random_unit(random));
        ASSERT_TRUE(holds(volume, at)) << oracle::name_of(family) << " " << n;
        ASSERT_TRUE(holds(box, at)) << oracle::name_of(family) << " " << n;
      }
    }
  }
}

TYPED_TEST(Volumes, AreAsLargeAsTheirPointsSay) {
  constexpr std::int64_t draws = 100000;
  for_each_family([](BoxFamily family) {
    for (std::uint64_t n = 0; n < 3; ++n) {
      const auto volume = volume_around<TypeParam>(random_box(family, n));
      const Aabb box = box_of(volume);
      Random random(312, n);
      std::int64_t inside = 0;
      for (std::int64_t k = 0; k < draws; ++k) {
        Vec at;
        for (int a = 0; a < 3; ++a) at[a] = random.uniform(box.lo[a], box.hi[a]);
        inside += holds(volume, at);
      }
      expect_share(inside, draws, std::min(1.0, volume_of(volume) / volume_of(box)), name_of(family));
    }
  });
}

TYPED_TEST(Volumes, OverlapAsOftenAsIntegralGeometrySays) {
  constexpr int draws = 30000;
  for_each_family([](BoxFamily family) {
    double sum = 0, squares = 0, expected = 0;
    for (int k = 0; k < draws; ++k) {
      Random random(313, static_cast<std::uint64_t>(k));
      const auto turned = [&] {
        return Solid{Vec3::Zero(), random_orientation(random), random_half_extents(family, random)};
      };
      const Solid a = turned();
      Solid b = turned();
      const auto volume_a = volume_around<TypeParam>(a);
      // Place b at random in a box that holds all positions at which the volumes overlap.
      const Aabb box_a = box_of(volume_a), box_b = box_of(volume_around<TypeParam>(b));
      double places = 1;
      for (int c = 0; c < 3; ++c) {
        const double reach = 1.1 * (box_a.hi[c] + box_b.hi[c]);
        b.position[c] = random.uniform(-reach, reach);
        places *= 2 * reach;
      }
      const auto volume_b = volume_around<TypeParam>(b);
      const double mean = excluded(volume_a, volume_b);
      const double off = (overlap(volume_a, volume_b) ? places : 0.0) - mean;
      sum += off, squares += off * off, expected += mean;
    }
    EXPECT_LT(std::fabs(sum), standard_deviations * std::sqrt(squares)) << name_of(family);
    EXPECT_LT(std::sqrt(squares), 0.05 * expected) << name_of(family);
  });
}

// ---- Polytopes of slabs ----

std::vector<Slab> slabs_of_dop(int first, double axes, double diagonals, const Vec3& centre) {
  std::vector<Slab> slabs;
  for (int k = first; k < 7; ++k) {
    const Vec3 direction(dop_directions[k][0], dop_directions[k][1], dop_directions[k][2]);
    const double half = k < 3 ? axes : diagonals, middle = direction.dot(centre);
    slabs.push_back({direction, middle - half, middle + half});
  }
  return slabs;
}

TEST(Polytope, HasTheVolumeOfClosedForms) {
  const Vec3 centre(3, -4, 5);
  EXPECT_NEAR(volume_of(slabs_of_dop(3, 0, 1, centre)), 4.0 / 3, 1e-12);   // octahedron
  EXPECT_NEAR(volume_of(slabs_of_dop(0, 1, 2, centre)), 20.0 / 3, 1e-12);  // cuboctahedron
  EXPECT_NEAR(volume_of(slabs_of_dop(0, 1, 3, centre)), 8, 1e-12);         // a cube that touches the rest
  EXPECT_NEAR(volume_of(slabs_of_dop(0, 1, 9, centre)), 8, 1e-12);
  EXPECT_NEAR(volume_of(slabs_of_dop(0, 5, 2, centre)), 32.0 / 3, 1e-12);
  // A parallelepiped has the product of its widths over the determinant of its directions as volume.
  const std::vector<Slab> skew = {{Vec3(1, 0, 0), -1, 1}, {Vec3(1, 2, 0), 0, 3}, {Vec3(-1, 1, 0.5), 7, 8}};
  EXPECT_NEAR(volume_of(skew), 6, 1e-12);
  // A slab apart from the others leaves nothing, and a flat one leaves no volume.
  std::vector<Slab> none = slabs_of_dop(0, 1, 9, centre), flat = none;
  none.push_back({Vec3(1, 1, 0), 50, 60});
  flat[1].lo = flat[1].hi;
  EXPECT_NEAR(volume_of(none), 0, 1e-12);
  EXPECT_NEAR(volume_of(flat), 0, 1e-12);
}

// ---- Sphere-swept volumes ----

TEST(SweptSphere, IsTheSmallestThatHoldsTheCorners) {
  for_each_family([](BoxFamily family) {
    for (std::uint64_t n = 0; n < 20; ++n) {
      const Vec3 half = random_box(family, n).size;
      Vec3 sides = half;
      std::sort(sides.begin(), sides.end(), std::greater<double>());
      for (const bool over_rectangle : {false, true}) {
        const SweptFit fit = fit_swept_sphere(half, over_rectangle);
        const double volume = swept_volume(fit.along.norm(), fit.across.norm(), fit.radius);
        const Vec3 rest = half - (fit.along + fit.across).cwiseAbs();
        EXPECT_NEAR(rest.norm(), fit.radius, 1e-12);
        constexpr int steps = 200;
        for (int i = 0; i <= steps; ++i) {
          for (int j = over_rectangle ? 0 : steps; j <= steps; ++j) {
            const double x = sides[0] * i / steps, y = sides[1] * j / steps;
            const double radius = Vec3(x, y, sides[2]).norm();
            ASSERT_LE(volume, (1 + 1e-9) * swept_volume(sides[0] - x, sides[1] - y, radius))
                << name_of(family) << " " << n << " " << i << " " << j;
          }
        }
      }
    }
  });
}

TEST(SweptSphere, DistancesOfSegmentsAreThoseOfLongDouble) {
  for (std::uint64_t n = 0; n < 100000; ++n) {
    Random random(314, n);
    const auto draw = [&random] {
      return Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    };
    const Vec3 between = draw(), u = draw();
    // One third of the segments have any direction, one third are parallel except for a tilt of 1e-16 to 1,
    // and one third are exactly parallel.
    const double tilt = n % 3 == 0 ? 1 : n % 3 == 1 ? std::pow(10.0, random.uniform(-16, 0)) : 0;
    const Vec3 v = n % 3 == 0 ? draw() : Vec3(random.uniform(-2, 2) * u + tilt * draw());
    const Real distance = oracle::segment_distance(exact(Vec3(between - u)), exact(Vec3(between + u)),
                                                   exact(Vec3(-v)), exact(v));
    // For nearly parallel edges the oracle uses only the end points, whose distance is too large by 2e-7 at
    // most.
    const double found = std::sqrt(squared_distance(between, u, v));
    ASSERT_LE(found, static_cast<double>(distance) + 1e-12) << n;
    ASSERT_GE(found, static_cast<double>(distance) - 2e-7) << n;
  }
}

// ---- The whole comparison ----

TEST(Comparison, OfRodsIsWhatItsPartsSay) {
  const FamilyReport report =
      compare_volumes(BoxFamily::rods_10, {.bodies = 3000, .overlaps_per_body = 4, .margin = 0, .rounds = 1});
  // Bodies near the walls have fewer pairs.
  EXPECT_GT(report.true_pairs, 0.8 * report.random_pairs);
  EXPECT_LT(report.true_pairs, report.random_pairs);
  ASSERT_EQ(report.rows.size(), 7u);
  for (const VolumeRow& row : report.rows) {
    EXPECT_EQ(row.missed, 0) << row.name;
    EXPECT_GE(row.tightness, 1) << row.name;
    EXPECT_NEAR(row.pairs, row.false_pairs + report.true_pairs, 1e-12) << row.name;
    EXPECT_LE(row.left, std::min(row.false_pairs, report.rows.front().false_pairs)) << row.name;
    EXPECT_GE(row.tests, row.pairs) << row.name;
    EXPECT_GT(FamilyReport::alone(row), 0) << row.name;
    EXPECT_GT(report.after_aabb(row), 0) << row.name;
  }
  const VolumeRow &obb = report.rows[2], &dop_8 = report.rows[5], &dop_14 = report.rows[6];
  EXPECT_NEAR(obb.tightness, 1, 1e-4);
  EXPECT_LT(obb.false_pairs, 1e-3);
  // Three slabs of the 14-DOP are the AABB's, and the other four are the 8-DOP's.
  EXPECT_EQ(dop_8.left, dop_14.left);
  EXPECT_EQ(dop_14.left, dop_14.false_pairs);
}

}  // namespace
}  // namespace scree::bench
