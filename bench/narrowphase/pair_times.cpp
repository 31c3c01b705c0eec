// Time per pair of each pair function, and what libccd costs for two boxes against the 15 axes: the numbers
// behind BoxBoxMethod::automatic. One thread.
//   scree_bench_narrowphase [repetitions, default 15]
#include "core/rng.hpp"
#include "narrowphase/box_box_ccd.hpp"
#include "narrowphase/box_plane.hpp"
#include "narrowphase/sphere_box.hpp"
#include "narrowphase/sphere_plane.hpp"
#include "narrowphase/sphere_sphere.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <vector>

namespace scree {
namespace {

struct Pairs {
  const char* name;
  std::vector<Solid> a, b;
  double margin;
};

Vec3 random_vector(Random& random) {
  const double x = random.uniform(-1, 1), y = random.uniform(-1, 1);
  return Vec3(x, y, random.uniform(-1, 1));
}

/// Boxes with half extents between 0.25 and 1 m that overlap by `depth` (negative: are apart).
Pairs boxes(const char* name, double depth, double tilt) {
  Pairs pairs{name, {}, {}, 0.02};
  for (std::uint64_t n = 0; n < 4000; ++n) {
    Random random(1, n);
    Solid a{Vec3::Zero(), rotation_of(2 * random_vector(random)),
            (random_vector(random) * 0.375).array() + 0.625};
    Solid b{Vec3::Zero(), Quat::Identity(), (random_vector(random) * 0.375).array() + 0.625};
    b.orientation = rotation_of(tilt * random_vector(random)) * a.orientation;
    const Vec3 direction =
        tilt < 1 ? Vec3(a.orientation * Vec3::UnitZ()) : random_vector(random).normalized();
    double near = 0, far = 4;
    for (int k = 0; k < 40; ++k) {
      b.position = 0.5 * (near + far) * direction;
      (separating_axes(BoxPair(a, b), HUGE_VAL).separation < -depth ? near : far) = 0.5 * (near + far);
    }
    pairs.a.push_back(a);
    pairs.b.push_back(b);
  }
  return pairs;
}

/// Bodies of which most touch.
Pairs close_pairs(const char* name) {
  Pairs pairs = boxes(name, 1e-3, 3);
  for (Solid& b : pairs.b) b.position *= 0.8;
  return pairs;
}

/// Median over repetitions of the time per pair (ns).
template <class Test>
double nanoseconds(const Pairs& pairs, int repetitions, Test test) {
  std::vector<double> times;
  for (int r = 0; r < repetitions; ++r) {
    std::int64_t points = 0;
    const auto start = std::chrono::steady_clock::now();
    for (std::size_t n = 0; n < pairs.a.size(); ++n) {
      Manifold m;
      if (test(pairs.a[n], pairs.b[n], pairs.margin, m)) points += m.count;
    }
    const std::chrono::duration<double, std::nano> elapsed = std::chrono::steady_clock::now() - start;
    if (points < 0) std::abort();  // the work is used
    times.push_back(elapsed.count() / static_cast<double>(pairs.a.size()));
  }
  std::nth_element(times.begin(), times.begin() + repetitions / 2, times.end());
  return times[static_cast<std::size_t>(repetitions / 2)];
}

void compare_methods(const Pairs& pairs, int repetitions) {
  std::printf("%-24s %8.0f", pairs.name, nanoseconds(pairs, repetitions, box_box));
  for (const ccd::Method method : {ccd::Method::gjk, ccd::Method::mpr}) {
    NarrowPhaseStats stats;
    const double time =
        nanoseconds(pairs, repetitions, [&](const auto& a, const auto& b, double margin, Manifold& m) {
          return box_box_ccd(a, b, margin, method, m, stats);
        });
    const double refused = 100.0 * static_cast<double>(stats.ccd_rejected) /
                           static_cast<double>(std::max<std::int64_t>(1, stats.ccd_calls));
    std::printf(" %8.0f %5.1f %%", time, refused);
  }
  std::printf("\n");
}

void run(int repetitions) {
  const Pairs close = close_pairs("any");
  std::printf("ns per pair\n");
  std::printf("sphere-sphere %.0f\n", nanoseconds(close, repetitions, sphere_sphere));
  std::printf("sphere-plane  %.0f\n", nanoseconds(close, repetitions, sphere_plane));
  std::printf("sphere-box    %.0f\n", nanoseconds(close, repetitions, sphere_box));
  std::printf("box-plane     %.0f\n", nanoseconds(close, repetitions, box_plane));
  std::printf("%-24s %8s %8s %7s %8s %7s\n", "box-box", "sat", "ccd_gjk", "refused", "ccd_mpr", "refused");
  compare_methods(boxes("apart, over 0.02 m", -0.03, 3), repetitions);
  compare_methods(boxes("apart, 0.01 m", -0.01, 3), repetitions);
  compare_methods(boxes("depth 1e-3 m", 1e-3, 3), repetitions);
  compare_methods(boxes("depth 0.1 m", 0.1, 3), repetitions);
  compare_methods(boxes("faces, tilt 1e-3", 1e-5, 1e-3), repetitions);
  compare_methods(boxes("faces, tilt 1e-9", 1e-5, 1e-9), repetitions);
}

}  // namespace
}  // namespace scree

int main(int argc, char** argv) {
  scree::run(argc > 1 ? std::max(1, std::atoi(argv[1])) : 15);
  return 0;
}
