// One pass over the pairs, chunk by chunk; what the chunks have found is then put side by side in their
// order.
#include "narrowphase/narrow_phase.hpp"

#include "core/parallel_loops.hpp"
#include "core/tolerances.hpp"
#include "narrowphase/any_contacts.hpp"
#include "narrowphase/box_box_ccd.hpp"
#include "narrowphase/box_box_crosscheck.hpp"
#include "narrowphase/convex_ccd.hpp"
#include "narrowphase/far_apart.hpp"

#include <algorithm>
#include <type_traits>
#include <utility>

namespace scree {

namespace {

/// Sets the manifolds of a pair, and returns their number.
using PairTest = int (*)(const Solid&, const Solid&, double margin, Manifold* out, NarrowPhaseStats&);

template <auto test>
int straight(const Solid& a, const Solid& b, double margin, Manifold* out, NarrowPhaseStats&) {
  if constexpr (std::is_invocable_v<decltype(test), const Solid&, const Solid&, double, Manifold*>) {
    return test(a, b, margin, out);
  } else {
    return detail::single(test(a, b, margin, *out), *out);
  }
}

/// The test with the shapes in the other order.
template <auto test>
int swapped(const Solid& a, const Solid& b, double margin, Manifold* out, NarrowPhaseStats& stats) {
  return detail::swapped(straight<test>(b, a, margin, out, stats), out);
}

template <ccd::Method method>
int by_ccd(const Solid& a, const Solid& b, double margin, Manifold* out, NarrowPhaseStats& stats) {
  return detail::single(box_box_ccd(a, b, margin, method, *out, stats), *out);
}

/// The test of each two shapes that are not general; rows and columns in the order of Shape. Planes and tubes
/// are never free, and never tested with each other.
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

/// As the table for boxes, `automatic` is the search along axes.
constexpr bool asks_ccd(ConvexMethod method) {
  return method == ConvexMethod::ccd_gjk || method == ConvexMethod::ccd_mpr;
}
constexpr ccd::Method method_of(ConvexMethod method) {
  return method == ConvexMethod::ccd_gjk ? ccd::Method::gjk : ccd::Method::mpr;
}

/// How near to its centre a body touches others (m); infinite for boundaries.
struct SetExtent {
  ConstBodyView bodies;
  ConstView<double> margin;
  View<double> extent;
  void operator()(std::int64_t k) const {
    extent[k] = is_boundary(bodies.shape[k]) ? HUGE_VAL
                                             : bounding_radius(bodies.shape[k], bodies.size[k]) + margin[k];
  }
};

/// Tests one chunk of the pairs, and keeps what it finds in their order.
struct FindContacts {
  ConstBodyView bodies;
  ConstView<Pair> pairs;
  ConstView<double> margin;
  ConstView<double> extent;
  ConstView<ShapeData> shapes;
  const PairTable* table;
  ConvexMethod convex;
  double crosscheck_share;
  std::uint64_t search;
  const LateBodies* late;
  std::int64_t chunk_size;
  detail::ManifoldChunk* chunks;

  void operator()(std::int64_t c) const {
    detail::ManifoldChunk& chunk = chunks[c];
    chunk.headers.clear();
    chunk.points.clear();
    chunk.stats = {};
    Manifold found[max_pair_manifolds];
    const std::int64_t last = std::min((c + 1) * chunk_size, pairs.size());
    for (std::int64_t k = c * chunk_size; k < last; ++k) {
      const int count = test(pairs[k].i, pairs[k].j, found, chunk.stats);
      for (int m = 0; m < count; ++m) chunk.append(found[m]);
    }
  }

 private:
  int test(std::int32_t i, std::int32_t j, Manifold* out, NarrowPhaseStats& stats) const {
    ++stats.tested;
    const bool later = is_late(i, j);
    const bool checked =
        crosscheck_share > 0.0 && ccd_knows(i, j) && is_crosschecked(crosscheck_share, search, i, j);
    if (!later && !checked && are_far(i, j)) return 0;
    const double time = later ? late->time_of(i, j) : 0.0;
    const Solid a = later ? late->solid_at(i, time) : solid(i);
    Solid b = later ? late->solid_at(j, time) : solid(j);
    bodies.period.bring_near(a.position, b.position);
    const int count = contacts_of(i, a, j, b, out, stats);
    if (checked) check(i, a, j, b, stats.crosscheck);
    for (int m = 0; m < count; ++m) {
      out[m].i = i;
      out[m].j = j;
    }
    return count;
  }

  int contacts_of(std::int32_t i, const Solid& a, std::int32_t j, const Solid& b, Manifold* out,
                  NarrowPhaseStats& stats) const {
    const Shape shape_i = bodies.shape[i], shape_j = bodies.shape[j];
    const double reach = margin[i] + margin[j];
    if (is_general(shape_i) || is_general(shape_j)) {
      if (asks_ccd(convex) && is_convex_pair(shape_i, shape_j))
        return find_contacts_by_ccd({shape_i, a}, {shape_j, b}, {&shapes[i], &shapes[j]}, reach,
                                    method_of(convex), out, stats);
      return find_general_contacts({shape_i, a}, {shape_j, b}, {&shapes[i], &shapes[j]}, {.margin = reach},
                                   out);
    }
    return table->of[static_cast<int>(shape_i)][static_cast<int>(shape_j)](a, b, reach, out, stats);
  }

  /// Whether the pair is one that libccd can be asked about.
  bool ccd_knows(std::int32_t i, std::int32_t j) const {
    const Shape shape_i = bodies.shape[i], shape_j = bodies.shape[j];
    return (shape_i == Shape::box && shape_j == Shape::box) || is_convex_pair(shape_i, shape_j);
  }

  void check(std::int32_t i, const Solid& a, std::int32_t j, const Solid& b, CrosscheckStats& stats) const {
    if (is_general(bodies.shape[i]) || is_general(bodies.shape[j]))
      return crosscheck({bodies.shape[i], a}, {bodies.shape[j], b}, {&shapes[i], &shapes[j]}, stats);
    crosscheck(a, b, stats);
  }

  /// True if the spheres around two bodies are too far apart for a contact.
  bool are_far(std::int32_t i, std::int32_t j) const {
    return are_far_apart(bodies.period.nearest(bodies.position[j] - bodies.position[i]),
                         extent[i] + extent[j]);
  }

  bool is_late(std::int32_t i, std::int32_t j) const {
    return late != nullptr && late->time_of(i, j) > late->now();
  }

  Solid solid(std::int32_t i) const { return {bodies.position[i], bodies.orientation[i], bodies.size[i]}; }
};

/// Copies a chunk to its place among the others.
struct Gather {
  const detail::ManifoldChunk* chunks;
  View<ManifoldHeader> headers;
  View<ContactPoint> points;
  void operator()(std::int64_t c) const {
    const detail::ManifoldChunk& chunk = chunks[c];
    for (std::size_t k = 0; k < chunk.headers.size(); ++k) {
      ManifoldHeader& header = headers[chunk.first_header + static_cast<std::int64_t>(k)];
      header = chunk.headers[k];
      header.first_point += chunk.first_point;
    }
    std::copy(chunk.points.begin(), chunk.points.end(), points.data() + chunk.first_point);
  }
};

}  // namespace

Manifolds NarrowPhase::find(const ConstBodyView& bodies, ConstView<Pair> pairs, ConstView<double> margin,
                            const LateBodies* late) {
  // One pair's cost is next to nothing, so they are taken by the chunk; of the most that there are, each
  // holds as many as it must.
  constexpr std::int64_t smallest_chunk = 64, most_chunks = 4096, few_chunks = 2;
  const std::int64_t chunk_size = std::max(smallest_chunk, (pairs.size() + most_chunks - 1) / most_chunks);
  const std::int64_t count = (pairs.size() + chunk_size - 1) / chunk_size;
  if (count > static_cast<std::int64_t>(chunks_.size())) chunks_.resize(static_cast<std::size_t>(count));
  extent_.resize(bodies.count());
  parallel::for_each<Host>("find contacts", bodies.count(), SetExtent{bodies, margin, extent_.view()});
  parallel::for_each<Host>("find contacts", count,
                           FindContacts{bodies, pairs, margin, std::as_const(extent_).view(), shapes_,
                                        &tables[static_cast<int>(settings_.box_box)], settings_.convex,
                                        settings_.crosscheck, searches_++, late, chunk_size, chunks_.data()},
                           few_chunks);
  stats_ = {};
  std::int64_t headers = 0;
  std::int64_t points = 0;
  for (std::int64_t c = 0; c < count; ++c) {
    detail::ManifoldChunk& chunk = chunks_[static_cast<std::size_t>(c)];
    stats_ += chunk.stats;
    chunk.first_header = headers;
    chunk.first_point = points;
    headers += static_cast<std::int64_t>(chunk.headers.size());
    points += static_cast<std::int64_t>(chunk.points.size());
  }
  headers_.resize(headers);
  points_.resize(points);
  parallel::for_each<Host>("gather contacts", count, Gather{chunks_.data(), headers_.view(), points_.view()});
  return {std::as_const(headers_).view(), std::as_const(points_).view()};
}

}  // namespace scree
