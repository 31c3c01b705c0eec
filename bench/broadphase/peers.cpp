// The benchmark of the broad phase on Host beside Bullet's tree (btDbvtBroadphase) and CGAL's hybrid of
// segment trees and scans (box_self_intersection_d; Zomorodian and Edelsbrunner 2002). The boxes move: each
// by 1 % of its extent per step, along its own direction.
//
//   scree_bench_broadphase_peers [--set A,B,C] [--n 100000,1000000] [--programs scree,CGAL,Bullet]
//                                [--threads 1,2] [--rounds 9] [--steps 10] [--margin 0.05] [--cutoff 3000]
//
// All programs take turns with the same boxes, so that other load on the machine affects them equally. scree
// and CGAL start from nothing, once in a round. Bullet gets every one of a round's `steps`, and its time is
// the mean over them: its work varies from step to step, since boxes leave their fat boxes only after a few
// steps. Its margin is absolute (m, its own default is 0.05). One round warms up. In the end the pairs of all
// programs are compared one by one; from Bullet's pairs, only those are taken whose boxes overlap as given,
// without its margin. The exit status is 1 if the pairs differ. Times are medians over the rounds, of the
// wall clock and of the processor.
#include "bench/broadphase/data_sets.hpp"
#include "bench/clock.hpp"
#include "bench/options.hpp"
#include "broadphase/aabb.hpp"
#include "core/math.hpp"
#include "core/rng.hpp"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/global_control.h>

#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <CGAL/box_intersection_d.h>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace scree::bench {

namespace {

using Boxes = Array<Aabb, Host>;
using Pairs = std::vector<Pair>;

class Contestant {
 public:
  explicit Contestant(std::string name) : name_(std::move(name)) {}
  virtual ~Contestant() = default;
  const std::string& name() const { return name_; }
  /// Does the work that is timed: it makes a list of pairs from the boxes.
  virtual void find(const Boxes& boxes) = 0;
  /// Returns the pairs of the last call of find(), in any order.
  virtual Pairs pairs() = 0;
  virtual bool takes_every_step() const { return false; }

 private:
  std::string name_;
};

class Scree final : public Contestant {
 public:
  explicit Scree(std::int64_t n) : Contestant("scree"), broad_phase_(make_broad_phase<Host>({})) {
    copy(mobility_, std::vector<Mobility>(static_cast<std::size_t>(n), Mobility::free));
  }
  void find(const Boxes& boxes) override { found_ = broad_phase_->find(boxes.view(), mobility_.view()); }
  Pairs pairs() override { return {found_.begin(), found_.end()}; }

 private:
  std::unique_ptr<BroadPhase<Host>> broad_phase_;
  Array<Mobility, Host> mobility_;
  ConstView<Pair> found_;
};

/// A box with its number, which is needed because CGAL sorts the boxes.
struct NumberedBox {
  Aabb box;
  std::int32_t number;
};

struct NumberedBoxTraits {
  using Box_parameter = const NumberedBox&;
  using NT = float;
  using ID = std::int32_t;
  static float min_coord(Box_parameter b, int axis) { return b.box.lo[axis]; }
  static float max_coord(Box_parameter b, int axis) { return b.box.hi[axis]; }
  static std::int32_t id(Box_parameter b) { return b.number; }
  static int dimension() { return 3; }
};

/// CGAL's hybrid method. Each thread keeps its own list of pairs.
template <class Concurrency>
class Cgal final : public Contestant {
 public:
  explicit Cgal(std::ptrdiff_t cutoff) : Contestant("CGAL"), cutoff_(cutoff) {}
  void find(const Boxes& boxes) override {
    numbered_.resize(static_cast<std::size_t>(boxes.size()));
    for (std::int32_t i = 0; i < boxes.size(); ++i)
      numbered_[static_cast<std::size_t>(i)] = {boxes.view()[i], i};
    for (Pairs& list : lists_) list.clear();
    CGAL::box_self_intersection_d<Concurrency>(
        numbered_.begin(), numbered_.end(),
        [this](const NumberedBox& a, const NumberedBox& b) {
          lists_.local().push_back(pair_of(a.number, b.number));
        },
        NumberedBoxTraits(), cutoff_, CGAL::Box_intersection_d::CLOSED);
  }
  Pairs pairs() override {
    Pairs all;
    for (const Pairs& list : lists_) all.insert(all.end(), list.begin(), list.end());
    return all;
  }

 private:
  std::ptrdiff_t cutoff_;
  std::vector<NumberedBox> numbered_;
  tbb::enumerable_thread_specific<Pairs> lists_;
};

/// Bullet in single precision, which is its faster version, with a tree that Bullet has balanced at the
/// start.
class Bullet final : public Contestant {
 public:
  explicit Bullet(const Boxes& boxes) : Contestant("Bullet") {
    static_assert(sizeof(btScalar) == sizeof(float));
    for (std::int64_t i = 0; i < boxes.size(); ++i) {
      const Aabb& box = boxes.view()[i];
      proxies_.push_back(broad_phase_.createProxy(vector(box.lo), vector(box.hi), 0,
                                                  reinterpret_cast<void*>(i), 1, 1, nullptr));
    }
    broad_phase_.optimize();
  }
  void find(const Boxes& boxes) override {
    for (std::int64_t i = 0; i < boxes.size(); ++i) {
      const Aabb& box = boxes.view()[i];
      broad_phase_.setAabb(proxies_[static_cast<std::size_t>(i)], vector(box.lo), vector(box.hi), nullptr);
    }
    broad_phase_.calculateOverlappingPairs(nullptr);
  }
  bool takes_every_step() const override { return true; }
  Pairs pairs() override {
    Pairs all;
    const btBroadphasePairArray& cached = broad_phase_.getOverlappingPairCache()->getOverlappingPairArray();
    for (int k = 0; k < cached.size(); ++k) {
      const btBroadphaseProxy& a = *cached[k].m_pProxy0;
      const btBroadphaseProxy& b = *cached[k].m_pProxy1;
      if (overlap(box_of(a), box_of(b))) all.push_back(pair_of(number_of(a), number_of(b)));
    }
    return all;
  }

 private:
  static btVector3 vector(const float (&at)[3]) { return {at[0], at[1], at[2]}; }
  static Aabb box_of(const btBroadphaseProxy& proxy) {
    const btVector3& lo = proxy.m_aabbMin;
    const btVector3& hi = proxy.m_aabbMax;
    return {{lo.x(), lo.y(), lo.z()}, {hi.x(), hi.y(), hi.z()}};
  }
  static std::int32_t number_of(const btBroadphaseProxy& proxy) {
    return static_cast<std::int32_t>(reinterpret_cast<std::intptr_t>(proxy.m_clientObject));
  }

  btDbvtBroadphase broad_phase_;
  std::vector<btBroadphaseProxy*> proxies_;
};

/// A data set whose boxes move.
class MovingBoxes {
 public:
  MovingBoxes(const std::string& set, std::int64_t n) {
    copy(boxes_, make_data_set(set, n));
    for (std::int64_t i = 0; i < n; ++i) {
      Random random(3, static_cast<std::uint64_t>(i));
      const double z = random.uniform(-1, 1);
      const double angle = random.uniform(0, 2 * pi);
      const double flat = std::sqrt(1 - z * z);
      const double length = 0.01 * extent_of(boxes_.view()[i]);
      displacement_.emplace_back(length * flat * std::cos(angle), length * flat * std::sin(angle),
                                 length * z);
    }
  }
  const Boxes& boxes() const { return boxes_; }
  void move() {
    for (std::int64_t i = 0; i < boxes_.size(); ++i) {
      Aabb& box = boxes_.view()[i];
      for (int a = 0; a < 3; ++a) {
        const auto d = static_cast<float>(displacement_[static_cast<std::size_t>(i)][a]);
        box.lo[a] += d;
        box.hi[a] += d;
      }
    }
  }

 private:
  Boxes boxes_;
  std::vector<Vec3> displacement_;
};

/// Times of the wall clock and of the processor (s).
struct Seconds {
  double wall = 0;
  double processor = 0;
};

/// A contestant with a number of threads, and its times: for each round the mean of the round's calls.
struct Entry {
  std::unique_ptr<Contestant> contestant;
  int threads;
  std::vector<Seconds> rounds{};
  int calls_in_round = 0;

  void begin_round() {
    rounds.emplace_back();
    calls_in_round = 0;
  }
  void find(const Boxes& boxes) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(threads));
    const Seconds start{now(CLOCK_MONOTONIC), now(CLOCK_PROCESS_CPUTIME_ID)};
    contestant->find(boxes);
    const Seconds took{now(CLOCK_MONOTONIC) - start.wall, now(CLOCK_PROCESS_CPUTIME_ID) - start.processor};
    Seconds& mean = rounds.back();
    ++calls_in_round;
    mean.wall += (took.wall - mean.wall) / calls_in_round;
    mean.processor += (took.processor - mean.processor) / calls_in_round;
  }
  /// Returns the median over all rounds but the first, which warms up.
  double median(double Seconds::*clock) const {
    std::vector<double> times;
    for (std::size_t k = 1; k < rounds.size(); ++k) times.push_back(rounds[k].*clock);
    std::sort(times.begin(), times.end());
    return times[times.size() / 2];
  }
};

Pairs sorted(Pairs pairs) {
  std::ranges::sort(pairs, {}, [](const Pair& p) { return std::pair(p.i, p.j); });
  return pairs;
}

bool same(const Pairs& a, const Pairs& b) {
  return std::ranges::equal(a, b, [](const Pair& p, const Pair& q) { return p.i == q.i && p.j == q.j; });
}

std::vector<Entry> make_entries(const Boxes& boxes, const Options& options) {
  const std::ptrdiff_t cutoff = std::stol(options.at("--cutoff"));
  gDbvtMargin = std::stof(options.at("--margin"));
  std::vector<Entry> entries;
  for (const std::string& program : split(options.at("--programs"))) {
    for (const std::string& count : split(options.at("--threads"))) {
      const int threads = std::stoi(count);
      std::unique_ptr<Contestant> contestant;
      if (program == "scree") {
        contestant = std::make_unique<Scree>(boxes.size());
      } else if (program == "CGAL" && threads == 1) {
        contestant = std::make_unique<Cgal<CGAL::Sequential_tag>>(cutoff);
      } else if (program == "CGAL") {
        contestant = std::make_unique<Cgal<CGAL::Parallel_tag>>(cutoff);
      } else if (program == "Bullet") {
        if (threads > 1) continue;  // Bullet's tree uses no threads
        contestant = std::make_unique<Bullet>(boxes);
      } else {
        throw InputError("program " + program + ": one of scree, CGAL, Bullet");
      }
      entries.push_back({.contestant = std::move(contestant), .threads = threads});
    }
  }
  return entries;
}

/// Prints the rows of a data set. Returns false if the pairs differ.
bool run(const std::string& set, std::int64_t n, const Options& options) {
  MovingBoxes moving(set, n);
  std::vector<Entry> entries = make_entries(moving.boxes(), options);
  const int steps = std::stoi(options.at("--steps"));
  for (int round = 0; round <= std::stoi(options.at("--rounds")); ++round) {
    for (Entry& entry : entries) entry.begin_round();
    for (int step = 1; step <= steps; ++step) {
      moving.move();
      for (Entry& entry : entries)
        if (step == steps || entry.contestant->takes_every_step()) entry.find(moving.boxes());
    }
  }
  bool agree = true;
  const Pairs expected = sorted(entries.front().contestant->pairs());
  for (const Entry& entry : entries) {
    const Pairs found = sorted(entry.contestant->pairs());
    const bool equal = same(found, expected);
    agree = agree && equal;
    std::printf("%-4s %9lld %-8s %7d %10.2f %10.2f %10zu%s\n", set.c_str(), static_cast<long long>(n),
                entry.contestant->name().c_str(), entry.threads, 1e3 * entry.median(&Seconds::wall),
                1e3 * entry.median(&Seconds::processor), found.size(), equal ? "" : "  DIFFERS");
    std::fflush(stdout);
  }
  return agree;
}

int run_all(int argc, char** argv) {
  const Options options = parse(argc, argv,
                                {{"--set", "A,B,C"},
                                 {"--n", "100000,1000000"},
                                 {"--programs", "scree,CGAL,Bullet"},
                                 {"--threads", "1,2"},
                                 {"--rounds", "9"},
                                 {"--steps", "10"},
                                 {"--margin", "0.05"},
                                 {"--cutoff", "3000"}});
  std::printf("set          n program  threads    wall ms     cpu ms      pairs\n");
  bool agree = true;
  for (const std::string& set : split(options.at("--set")))
    for (const std::string& n : split(options.at("--n"))) agree = run(set, std::stoll(n), options) && agree;
  return agree ? 0 : 1;
}

}  // namespace

}  // namespace scree::bench

int main(int argc, char** argv) {
  return scree::bench::status_of("scree_bench_broadphase_peers",
                                 [&] { return scree::bench::run_all(argc, argv); });
}
