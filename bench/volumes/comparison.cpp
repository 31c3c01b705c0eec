#include "bench/volumes/comparison.hpp"

#include "bench/clock.hpp"
#include "bench/volumes/volume_set.hpp"
#include "broadphase/aabb.hpp"
#include "narrowphase/any_contacts.hpp"
#include "narrowphase/box_pair.hpp"
#include "narrowphase/far_apart.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

namespace scree::bench {

namespace {

using Pairs = std::vector<Pair>;

constexpr std::int64_t most_timed = 1000000;  // pairs in a list
constexpr std::int64_t least_timed = 200;
constexpr std::int64_t tightness_sample = 2000;

bool is_before(const Pair& a, const Pair& b) { return a.i != b.i ? a.i < b.i : a.j < b.j; }

/// Returns the pairs that scree's broad phase finds if every `stride`-th body is free, ordered by the bodies.
Pairs find_pairs(const std::vector<Aabb>& boxes, std::int64_t stride, BroadPhaseStats& stats) {
  Array<Aabb, Host> bounds;
  copy(bounds, boxes);
  Array<Mobility, Host> mobility(bounds.size());
  for (std::int64_t k = 0; k < bounds.size(); ++k)
    mobility.data()[k] = k % stride == 0 ? Mobility::free : Mobility::fixed;
  const auto broad_phase = make_broad_phase<Host>({});
  const ConstView<Pair> found = broad_phase->find(bounds.view(), mobility.view());
  stats = broad_phase->stats();
  Pairs pairs(found.begin(), found.end());
  std::ranges::sort(pairs, is_before);
  return pairs;
}

/// Returns pairs as near as those that are tested by a grid whose cells are as wide as the bodies' boxes. Two
/// bodies are a pair if along each axis their centres are within three quarters of the sum of their boxes'
/// widths. That gives as many pairs as half of the 27 cells about a body.
Pairs near_pairs(const std::vector<Aabb>& boxes, double tests_per_body) {
  std::vector<Aabb> cubes;
  for (const Aabb& box : boxes) {
    Aabb cube;
    for (int a = 0; a < 3; ++a) {
      cube.lo[a] = static_cast<float>(centre_of(box, a)) - 0.75f * extent_of(box);
      cube.hi[a] = static_cast<float>(centre_of(box, a)) + 0.75f * extent_of(box);
    }
    cubes.push_back(cube);
  }
  const double all = tests_per_body * static_cast<double>(boxes.size());
  BroadPhaseStats stats;
  return find_pairs(cubes, 1 + static_cast<std::int64_t>(2 * all / most_timed), stats);
}

Pairs random_pairs(std::int64_t bodies) {
  Pairs pairs;
  Random random(303, 0);
  const auto any = [&](std::int64_t count) {
    return static_cast<std::int32_t>(random.uniform(0, static_cast<double>(count)));
  };
  for (std::int64_t k = 0; k < most_timed; ++k) {
    const std::int32_t i = any(bodies), other = any(bodies - 1);
    pairs.push_back(pair_of(i, other + (other >= i ? 1 : 0)));
  }
  return pairs;
}

Solid solid(const BodyTable& bodies, std::int32_t body) {
  const auto k = static_cast<std::size_t>(body);
  return {bodies.position[k], bodies.orientation[k], bodies.size[k]};
}

Pairs truly_overlapping(const BodyTable& bodies, const Pairs& pairs) {
  Pairs found;
  std::ranges::copy_if(pairs, std::back_inserter(found), [&](const Pair& pair) {
    return separating_axes(BoxPair(solid(bodies, pair.i), solid(bodies, pair.j)), 0).separation <= 0;
  });
  return found;
}

Pairs without(const Pairs& pairs, const Pairs& taken) {
  Pairs left;
  std::ranges::set_difference(pairs, taken, std::back_inserter(left), is_before);
  return left;
}

/// Returns at most as many pairs as are timed, from the middle of the list, so that neighbours stay
/// neighbours.
Pairs part_of(const Pairs& pairs) {
  const std::int64_t size = std::min(std::ssize(pairs), most_timed);
  const auto first = pairs.begin() + (std::ssize(pairs) - size) / 2;
  return Pairs(first, first + size);
}

template <class Work>
double nanoseconds(Work work) {
  const double start = now(CLOCK_PROCESS_CPUTIME_ID);
  work();
  return 1e9 * (now(CLOCK_PROCESS_CPUTIME_ID) - start);
}

/// The narrow phase's tests of pairs as the simulation makes them, without margins.
class NarrowPhaseOf {
 public:
  explicit NarrowPhaseOf(const BodyTable& table) { copy_bodies(bodies_, table); }

  /// Returns the time per pair (ns), or 0 if there are too few pairs.
  double time_per_pair(const Pairs& pairs) {
    if (std::ssize(pairs) < least_timed) return 0;
    const ConstBodyView bodies = view_of(std::as_const(bodies_));
    return nanoseconds([&] {
             Manifold found[max_pair_manifolds];
             for (const auto& [i, j] : pairs) {
               const Vec3 offset = bodies.position[j] - bodies.position[i];
               const double reach = bounding_radius(bodies.shape[i], bodies.size[i]) +
                                    bounding_radius(bodies.shape[j], bodies.size[j]);
               if (are_far_apart(offset, reach)) continue;
               found_ += find_any_contacts({bodies.shape[i], solid_of(bodies, i)},
                                           {bodies.shape[j], solid_of(bodies, j)}, {}, {.margin = 0}, found);
             }
           }) /
           static_cast<double>(pairs.size());
  }

 private:
  static Solid solid_of(const ConstBodyView& bodies, std::int32_t k) {
    return {bodies.position[k], bodies.orientation[k], bodies.size[k]};
  }

  Bodies<Host> bodies_;
  std::int64_t found_ = 0;
};

/// The pairs on which all kinds of volumes are timed.
struct SharedPairs {
  Pairs random, near, second;
};

enum Cost { update, random_test, near_test, second_test, narrow, narrow_left, costs };

/// One kind of volume, the false pairs that it leaves to the narrow phase, and its times in each round.
struct Contestant {
  VolumeSet* volumes;
  Pairs false_pairs, false_left;
  std::array<std::vector<double>, costs> times{};

  void run_round(const SharedPairs& pairs, NarrowPhaseOf& narrow_phase) {
    times[update].push_back(nanoseconds([&] { volumes->update(); }) / static_cast<double>(volumes->size()));
    times[random_test].push_back(time_per_test(pairs.random));
    times[near_test].push_back(time_per_test(pairs.near));
    times[second_test].push_back(time_per_test(pairs.second));
    times[narrow].push_back(narrow_phase.time_per_pair(false_pairs));
    times[narrow_left].push_back(narrow_phase.time_per_pair(false_left));
  }

  double median(Cost cost) {
    std::vector<double>& all = times[cost];
    std::ranges::sort(all);
    return all[all.size() / 2];
  }

 private:
  double time_per_test(const Pairs& pairs) const {
    if (pairs.empty()) return 0;
    return nanoseconds([&] { volumes->count(pairs); }) / static_cast<double>(pairs.size());
  }
};

class Comparison {
 public:
  Comparison(BoxFamily family, const ComparisonSettings& settings)
      : settings_(settings),
        scene_(make_boxes(family, settings.bodies, settings.overlaps_per_body)),
        sets_(all_volume_sets(scene_.bodies, settings.margin)) {}

  FamilyReport run() {
    count_pairs();
    time();
    return report_;
  }

 private:
  double per_body(const Pairs& pairs) const {
    return static_cast<double>(std::ssize(pairs)) / static_cast<double>(settings_.bodies);
  }

  void count_pairs() {
    BroadPhaseStats stats;
    aabb_pairs_ = find_pairs(sets_.front()->boxes(), 1, stats);
    const Pairs truth = truly_overlapping(scene_.bodies, aabb_pairs_);
    report_ = {scene_.fraction, per_body(truth), settings_.overlaps_per_body / 2, {}};
    for (const auto& volumes : sets_) {
      const Pairs pairs = volumes->overlapping(find_pairs(volumes->boxes(), 1, stats));
      const Pairs false_pairs = without(pairs, truth);
      const Pairs false_left = without(volumes->overlapping(aabb_pairs_), truth);
      VolumeRow row{};
      row.name = volumes->name();
      row.bytes = volumes->bytes();
      row.tightness = volumes->tightness(std::min(tightness_sample, settings_.bodies));
      row.tests = static_cast<double>(stats.candidates) / static_cast<double>(settings_.bodies);
      row.pairs = per_body(pairs);
      row.false_pairs = per_body(false_pairs);
      row.left = per_body(false_left);
      row.missed = std::ssize(without(truth, pairs));
      report_.rows.push_back(row);
      contestants_.push_back({volumes.get(), part_of(false_pairs), part_of(false_left)});
    }
  }

  /// Times all contestants in rounds, of which the first warms up.
  void time() {
    const SharedPairs pairs = {random_pairs(settings_.bodies),
                               near_pairs(sets_.front()->boxes(), report_.rows.front().tests),
                               part_of(aabb_pairs_)};
    NarrowPhaseOf narrow_phase(scene_.bodies);
    for (int round = 0; round <= settings_.rounds; ++round) {
      for (Contestant& contestant : contestants_) {
        if (round == 1) contestant.times = {};
        contestant.run_round(pairs, narrow_phase);
      }
    }
    for (std::size_t k = 0; k < contestants_.size(); ++k) {
      VolumeRow& row = report_.rows[k];
      Contestant& contestant = contestants_[k];
      row.update = contestant.median(update);
      row.random_test = contestant.median(random_test);
      row.near_test = contestant.median(near_test);
      row.second_test = contestant.median(second_test);
      row.narrow = contestant.median(narrow);
      row.narrow_left = contestant.median(narrow_left);
    }
  }

  ComparisonSettings settings_;
  BoxScene scene_;
  std::vector<std::unique_ptr<VolumeSet>> sets_;
  Pairs aabb_pairs_;
  std::vector<Contestant> contestants_;
  FamilyReport report_;
};

}  // namespace

double FamilyReport::alone(const VolumeRow& row) {
  return row.update + row.tests * row.near_test + row.false_pairs * row.narrow;
}

double FamilyReport::after_aabb(const VolumeRow& row) const {
  const VolumeRow& aabb = rows.front();
  return aabb.update + aabb.tests * aabb.near_test + row.update + aabb.pairs * row.second_test +
         row.left * row.narrow_left;
}

FamilyReport compare_volumes(BoxFamily family, const ComparisonSettings& settings) {
  return Comparison(family, settings).run();
}

}  // namespace scree::bench
