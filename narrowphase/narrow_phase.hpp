// The narrow phase: pairs of the PCS in, manifolds out.
#pragma once

#include "broadphase/broad_phase.hpp"
#include "core/array.hpp"
#include "core/bodies.hpp"
#include "core/shape_data.hpp"
#include "narrowphase/contact.hpp"
#include "narrowphase/settings.hpp"
#include "narrowphase/solid.hpp"
#include "narrowphase/stats.hpp"

#include <cstdint>
#include <vector>

namespace scree {

namespace detail {
/// What a chunk of the pairs has found.
struct alignas(64) ManifoldChunk {
  std::vector<ManifoldHeader> headers;
  std::vector<ContactPoint> points;
  NarrowPhaseStats stats;
  std::int64_t first_header, first_point;  ///< its place among all

  void append(const Manifold& m) {
    headers.push_back({.i = m.i,
                       .j = m.j,
                       .part = m.part,
                       .count = m.count,
                       .first_point = static_cast<std::int64_t>(points.size()),
                       .normal = m.normal,
                       .at_edge = m.at_edge});
    points.insert(points.end(), m.points, m.points + m.count);
  }
};
}  // namespace detail

/// Bodies that are seen later than the others: where they are before, they have never been.
class LateBodies {
 public:
  virtual ~LateBodies() = default;
  /// When a pair is to be seen (s); at most `now()` for a pair that is to be seen as it is.
  virtual double time_of(std::int32_t i, std::int32_t j) const = 0;
  virtual double now() const = 0;
  virtual Solid solid_at(std::int32_t body, double time) const = 0;
};

/// Finds the contacts of bodies on the host.
class NarrowPhase {
 public:
  /// `shapes`: of each body; empty if no body's shape is general. They must outlive this.
  explicit NarrowPhase(const NarrowPhaseSettings& settings, ConstView<ShapeData> shapes = {})
      : settings_(settings), shapes_(shapes) {}

  /// All manifolds with a gap of at most margin[i] + margin[j] (m), in the order of the pairs given, which
  /// are Candidates (each has a free body, planes are among them). The views are valid until the next call.
  Manifolds find(const ConstBodyView& bodies, ConstView<Pair> pairs, ConstView<double> margin,
                 const LateBodies* late = nullptr);

  /// Of the last search.
  const NarrowPhaseStats& stats() const { return stats_; }
  /// What the last search has found, for those who know more of the bodies: theirs to change.
  View<ManifoldHeader> headers() { return headers_.view(); }
  View<ContactPoint> points() { return points_.view(); }

 private:
  NarrowPhaseSettings settings_;
  ConstView<ShapeData> shapes_;
  NarrowPhaseStats stats_;
  std::uint64_t searches_ = 0;
  // Buffers that keep their capacity from step to step.
  Array<double, Host> extent_;  ///< of each body
  std::vector<detail::ManifoldChunk> chunks_;
  Array<ManifoldHeader, Host> headers_;
  Array<ContactPoint, Host> points_;
};

}  // namespace scree
