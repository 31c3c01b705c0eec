// One pass over all candidates appends what it finds, in blocks whose order depends on the threads; a
// counting sort by (i, j) then makes the order unique.
#include "narrowphase/narrow_phase.hpp"

#include "core/parallel.hpp"
#include "narrowphase/box_box_ccd.hpp"
#include "narrowphase/box_box_crosscheck.hpp"
#include "narrowphase/box_plane.hpp"
#include "narrowphase/box_tube.hpp"
#include "narrowphase/sphere_box.hpp"
#include "narrowphase/sphere_plane.hpp"
#include "narrowphase/sphere_sphere.hpp"
#include "narrowphase/sphere_tube.hpp"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <type_traits>

namespace scree {

namespace {

// One candidate's cost is near that of an atomic addition, so they are taken by the block.
constexpr std::int64_t block = 32;

/// Sets the manifolds of a pair, and returns their number.
using PairTest = int (*)(const Solid&, const Solid&, double margin, Manifold* out, NarrowPhaseStats&);

/// The count of a test that has at most one manifold.
int single(bool found, Manifold& out) {
  out.part = 0;
  return found ? 1 : 0;
}

template <auto test>
int straight(const Solid& a, const Solid& b, double margin, Manifold* out, NarrowPhaseStats&) {
  if constexpr (std::is_invocable_v<decltype(test), const Solid&, const Solid&, double, Manifold*>) {
    return test(a, b, margin, out);
  } else {
    return single(test(a, b, margin, *out), *out);
  }
}

/// The test with the shapes in the other order.
template <auto test>
int swapped(const Solid& a, const Solid& b, double margin, Manifold* out, NarrowPhaseStats& stats) {
  const int count = straight<test>(b, a, margin, out, stats);
  for (int m = 0; m < count; ++m) out[m].normal = -out[m].normal;
  return count;
}

template <ccd::Method method>
int by_ccd(const Solid& a, const Solid& b, double margin, Manifold* out, NarrowPhaseStats& stats) {
  return single(box_box_ccd(a, b, margin, method, *out, stats), *out);
}

/// The test of each two shapes; rows and columns in the order of Shape. Planes and tubes are never free, and
/// never tested with each other.
struct PairTable {
  PairTest of[4][4];
};

constexpr PairTable table_with(PairTest box_box_test) {
  return {{{straight<sphere_sphere>, straight<sphere_box>, straight<sphere_plane>, straight<sphere_tube>},
           {swapped<sphere_box>, box_box_test, straight<box_plane>, straight<box_tube>},
           {swapped<sphere_plane>, swapped<box_plane>, nullptr, nullptr},
           {swapped<sphere_tube>, swapped<box_tube>, nullptr, nullptr}}};
}

/// Rows in the order of BoxBoxMethod. `automatic` is the 15 axes: scree_bench_narrowphase has them at 0.2 to
/// 0.6 us for a pair, against 0.5 to 1.2 us by MPR and 1.1 to 2.4 us by EPA (12 us where centres coincide).
/// They are exact to rounding, while the certificate refuses some 10 % of libccd's answers and more in every
/// family but that of shallow contacts: bench/results/xeon-2-cores/narrowphase.md.
constexpr PairTable tables[] = {
    table_with(straight<box_box>),  // automatic
    table_with(straight<box_box>),
    table_with(by_ccd<ccd::Method::gjk>),
    table_with(by_ccd<ccd::Method::mpr>),
};

/// What the blocks share while they append.
struct Tally {
  std::atomic<std::int64_t> found{0}, tested{0};
  std::mutex mutex;
  NarrowPhaseStats of_ccd;  // but for `tested`, which every block adds to: a lock would hold them up

  void add(const NarrowPhaseStats& stats) {
    tested += stats.tested;
    if (stats.ccd_calls + stats.crosscheck.asked == 0) return;
    const std::lock_guard lock(mutex);
    of_ccd += stats;
  }
  NarrowPhaseStats total() const {
    NarrowPhaseStats stats = of_ccd;
    stats.tested = tested;
    return stats;
  }
};

/// Tests one block of candidates, and appends the manifolds found as far as there is room. The candidates are
/// the pairs, then each plane with each body.
struct FindContacts {
  ConstBodyView bodies;
  ConstView<Pair> pairs;
  ConstView<double> margin;
  ConstView<std::int32_t> planes;
  const PairTable* table;
  double crosscheck_share;
  std::uint64_t search;
  const LateBodies* late;
  View<Manifold> room;
  Tally* tally;

  std::int64_t candidates() const { return pairs.size() + planes.size() * bodies.count(); }

  void operator()(std::int64_t b) const {
    Manifold found[block + max_pair_manifolds];
    int count = 0;
    NarrowPhaseStats stats;
    const std::int64_t last = std::min((b + 1) * block, candidates());
    for (std::int64_t c = b * block; c < last; ++c) {
      count += c < pairs.size() ? test_pair(pairs[c], found + count, stats)
                                : test_plane(c - pairs.size(), found + count, stats);
      if (count <= block) continue;
      append(found, count);
      count = 0;
    }
    append(found, count);
    tally->add(stats);
  }

 private:
  void append(const Manifold* found, int count) const {
    if (count == 0) return;
    const std::int64_t first = tally->found.fetch_add(count);
    for (int k = 0; k < count && first + k < room.size(); ++k) room[first + k] = found[k];
  }

  /// Pairs with planes are left to test_plane, whoever lists them, so that none comes twice.
  int test_pair(const Pair& pair, Manifold* out, NarrowPhaseStats& stats) const {
    const bool has_plane = bodies.shape[pair.i] == Shape::plane || bodies.shape[pair.j] == Shape::plane;
    return has_plane ? 0 : test(pair.i, pair.j, out, stats);
  }

  int test_plane(std::int64_t candidate, Manifold* out, NarrowPhaseStats& stats) const {
    const std::int32_t plane = planes[candidate / bodies.count()];
    const auto body = static_cast<std::int32_t>(candidate % bodies.count());
    if (bodies.mobility[body] != Mobility::free || bodies.mobility[plane] == Mobility::absent) return 0;
    const Vec3 up = bodies.orientation[plane] * Vec3::UnitZ();
    const double reach =
        bounding_radius(bodies.shape[body], bodies.size[body]) + margin[plane] + margin[body];
    if (!is_late(plane, body) && up.dot(bodies.position[body] - bodies.position[plane]) > reach) return 0;
    return test(std::min(plane, body), std::max(plane, body), out, stats);
  }

  int test(std::int32_t i, std::int32_t j, Manifold* out, NarrowPhaseStats& stats) const {
    if (bodies.mobility[i] != Mobility::free && bodies.mobility[j] != Mobility::free) return 0;
    ++stats.tested;
    const bool later = is_late(i, j);
    const bool boxes = bodies.shape[i] == Shape::box && bodies.shape[j] == Shape::box;
    const bool checked = boxes && is_crosschecked(crosscheck_share, search, i, j);
    if (!later && !checked && are_far(i, j)) return 0;
    const PairTest pair_test =
        table->of[static_cast<int>(bodies.shape[i])][static_cast<int>(bodies.shape[j])];
    const double time = later ? late->time_of(i, j) : 0.0;
    const Solid a = later ? late->solid_at(i, time) : solid(i);
    const Solid b = later ? late->solid_at(j, time) : solid(j);
    const int count = pair_test(a, b, margin[i] + margin[j], out, stats);
    if (checked) crosscheck(a, b, stats.crosscheck);
    for (int m = 0; m < count; ++m) {
      out[m].i = i;
      out[m].j = j;
    }
    return count;
  }

  /// True if the spheres around two boxes, or a box and a ball, are too far apart for a contact: their tests
  /// cost far more.
  bool are_far(std::int32_t i, std::int32_t j) const {
    if (is_boundary(bodies.shape[i]) || is_boundary(bodies.shape[j])) return false;
    if (bodies.shape[i] == Shape::sphere && bodies.shape[j] == Shape::sphere) return false;
    const double reach = bounding_radius(bodies.shape[i], bodies.size[i]) +
                         bounding_radius(bodies.shape[j], bodies.size[j]) + margin[i] + margin[j];
    return (bodies.position[j] - bodies.position[i]).squaredNorm() > reach * reach;
  }

  bool is_late(std::int32_t i, std::int32_t j) const {
    return late != nullptr && late->time_of(i, j) > late->now();
  }

  Solid solid(std::int32_t i) const { return {bodies.position[i], bodies.orientation[i], bodies.size[i]}; }
};

std::atomic_ref<std::int32_t> shared(std::int32_t& count) { return std::atomic_ref<std::int32_t>(count); }

struct CountByFirst {
  ConstView<Manifold> found;
  View<std::int32_t> counts;
  void operator()(std::int64_t k) const { ++shared(counts[found[k].i]); }
};

/// Puts each manifold into the range of its first body, in any order.
struct PlaceByFirst {
  ConstView<Manifold> found;
  ConstView<std::int64_t> offsets;
  View<std::int32_t> counts;
  View<detail::ManifoldSlot> slots;
  void operator()(std::int64_t k) const {
    const std::int32_t i = found[k].i;
    slots[offsets[i] + --shared(counts[i])] = {found[k].j, k};
  }
};

/// Orders the range of one first body by the second. No pair comes twice, and one thread appends all of a
/// pair's manifolds, so there is one such order.
struct SortBySecond {
  ConstView<std::int64_t> offsets;
  View<detail::ManifoldSlot> slots;
  void operator()(std::int64_t i) const {
    const auto less = [](const auto& a, const auto& b) {
      return a.j != b.j ? a.j < b.j : a.source < b.source;
    };
    std::sort(slots.data() + offsets[i], slots.data() + offsets[i + 1], less);
  }
};

struct Gather {
  ConstView<Manifold> found;
  ConstView<detail::ManifoldSlot> slots;
  View<Manifold> manifolds;
  void operator()(std::int64_t k) const { manifolds[k] = found[slots[k].source]; }
};

}  // namespace

int find_pair_contacts(Shape shape_a, const Solid& a, Shape shape_b, const Solid& b, double margin,
                       Manifold* out) {
  const PairTest test =
      tables[static_cast<int>(BoxBoxMethod::sat)].of[static_cast<int>(shape_a)][static_cast<int>(shape_b)];
  NarrowPhaseStats stats;
  return test != nullptr ? test(a, b, margin, out, stats) : 0;
}

ConstView<Manifold> NarrowPhase::find(const ConstBodyView& bodies, ConstView<Pair> pairs,
                                      ConstView<double> margin, const LateBodies* late) {
  list_planes(bodies);
  FindContacts search{bodies,
                      pairs,
                      margin,
                      planes_.view(),
                      &tables[static_cast<int>(settings_.box_box)],
                      settings_.crosscheck,
                      searches_++,
                      late,
                      found_.view(),
                      nullptr};
  std::int64_t count = 0;
  for (bool complete = false; !complete;) {
    Tally tally;
    search.tally = &tally;
    search.room = found_.view();
    parallel::for_each<Host>("find contacts", (search.candidates() + block - 1) / block, search);
    count = tally.found;
    stats_ = tally.total();
    complete = count <= found_.size();
    if (!complete) found_.resize(count + count / 4);  // room for the steps that follow
  }
  sort_by_pair(bodies.count(), count);
  return manifolds_.view();
}

void NarrowPhase::list_planes(const ConstBodyView& bodies) {
  const auto is_plane = [](Shape shape) { return shape == Shape::plane; };
  planes_.resize(std::count_if(bodies.shape.begin(), bodies.shape.end(), is_plane));
  std::int64_t next = 0;
  for (std::int64_t i = 0; next < planes_.size(); ++i) {
    if (is_plane(bodies.shape[i])) planes_.view()[next++] = static_cast<std::int32_t>(i);
  }
}

void NarrowPhase::sort_by_pair(std::int64_t body_count, std::int64_t count) {
  const ConstView<Manifold> found(found_.data(), count);
  counts_.resize(body_count);
  parallel::fill("contacts of body", counts_, 0);
  parallel::for_each<Host>("contacts of body", count, CountByFirst{found, counts_.view()});
  parallel::exclusive_scan<Host>("contacts of body", counts_, offsets_);
  slots_.resize(count);
  parallel::for_each<Host>("sort contacts", count,
                           PlaceByFirst{found, offsets_.view(), counts_.view(), slots_.view()});
  parallel::for_each<Host>("sort contacts", body_count, SortBySecond{offsets_.view(), slots_.view()});
  manifolds_.resize(count);
  parallel::for_each<Host>("sort contacts", count, Gather{found, slots_.view(), manifolds_.view()});
}

}  // namespace scree
