// Visits to contacts that part what overlaps.
#pragma once

#include "sim/dynamics/lanes/kernels/batch_vectors.hpp"

namespace scree::lanes::SCREE_LANES {

namespace {

/// As lanes::parting().
[[gnu::always_inline]] inline V part(const V& gap, const Lane& cap, double share, const Lane& normal_mass,
                                     Lane& pushed) {
  V so_far = get(pushed);
  const V more = parting<Lanes>(gap, get(cap), all(share), get(normal_mass), so_far);
  set(pushed, so_far);
  return more;
}

/// The deepest overlap of the lanes, in units of the cap.
double deepest(const V& gap, const V& cap) {
  const V depth = above_zero<Lanes>(cap > 0 ? -gap / cap : all(0));
  double deepest = 0;
  for (int l = 0; l < width; ++l) deepest = depth[l] > deepest ? depth[l] : deepest;
  return deepest;
}

double fly_balls(const BallBatch& batch, BallParting& parting, const Body* velocities, double step) {
  const Centres i = load_centres(velocities, parting.ends.i);
  const Centres j = load_centres(velocities, parting.ends.j);
  V gap = get(parting.gap) +
          0.5 * step * (dot(get(parting.normal), j.velocity - i.velocity) + 0.25 * step * get(parting.bend));
  std::uint64_t any_flies = 0;
  static_assert(sizeof any_flies == sizeof parting.flying);
  __builtin_memcpy(&any_flies, parting.flying, sizeof any_flies);
  if (any_flies != 0) {
    // What flies past is nearer to the other's tangent plane than to the other.
    const V3 p = get(batch.impulse.impulse);
    gap = ((spread(parting.flying) > 0) & (dot(p, p) == 0)) ? all(__builtin_huge_val()) : gap;
  }
  set(parting.flown, gap);
  double least = 0;
  for (int l = 0; l < width; ++l) least = gap[l] < least ? gap[l] : least;
  return -least;
}

double part_balls(BallParting& batch, double share, Body* bodies) {
  Centres i = load_centres(bodies, batch.ends.i);
  Centres j = load_centres(bodies, batch.ends.j);
  const V3 n = get(batch.normal);
  const V gap = get(batch.flown) + dot(n, j.velocity - i.velocity);
  push_centres(part(gap, batch.cap, share, batch.normal_mass, batch.pushed) * n, i, j);
  store(i, bodies, batch.ends.i);
  store(j, bodies, batch.ends.j);
  return deepest(gap, get(batch.cap));
}

double fly_points(const PointBatch& batch, const PointRow* rows, PointParting* points, const Body* velocities,
                  const InertiaRoot* roots, double step) {
  const Bodies i = load(velocities, batch.ends.i);
  const Bodies j = load(velocities, batch.ends.j);
  const auto root_i = load(roots, batch.ends.i);
  const auto root_j = load(roots, batch.ends.j);
  const V3 n = get(batch.normal);
  V least = all(0);
  for (int k = 0; k < batch.count; ++k) {
    const Point at = point_of(rows[k]);
    PointParting& point = points[k];
    V gap = get(point.gap) + 0.5 * step * dot(n, velocity_at(at, i, j));
    for (int l = 0; batch.apart >> l != 0; ++l)
      gap[l] = (batch.apart >> l & 1) != 0 ? __builtin_huge_val() : gap[l];
    set(point.gap, gap);
    set(point.turn_i, root_i * cross(at.arm_i, n));
    set(point.turn_j, root_j * cross(at.arm_j, n));
    least = gap < least ? gap : least;
  }
  double deepest = 0;
  for (int l = 0; l < width; ++l) deepest = -least[l] > deepest ? -least[l] : deepest;
  return deepest;
}

/// As PointSweep. All points of a contact have its normal, so that along it their bodies part alike.
struct PointParts {
  const PointBatch* batch;
  PointParting* points;
  Bodies i, j;
  V masses;
  V parted, pushed;  // of the centres along the normal
  V least;

  [[gnu::always_inline]] void enter(const Body* bodies) {
    i = load(bodies, batch->ends.i);
    j = load(bodies, batch->ends.j);
    masses = i.inverse_mass + j.inverse_mass;
    parted = dot(get(batch->normal), j.velocity - i.velocity);
    pushed = least = all(0);
  }
  [[gnu::always_inline]] void visit(int k, double share) {
    PointParting& point = points[k];
    const V3 turn_i = get(point.turn_i);
    const V3 turn_j = get(point.turn_j);
    const V gap = get(point.gap) + parted + (dot(turn_j, j.spin) - dot(turn_i, i.spin));
    const V more = part(gap, batch->cap, share, point.normal_mass, point.pushed);
    parted += masses * more;
    pushed += more;
    i.spin = i.spin - more * turn_i;
    j.spin = j.spin + more * turn_j;
    least = gap < least ? gap : least;
  }
  [[gnu::always_inline]] double leave(Body* bodies) {
    push_centres(pushed * get(batch->normal), i, j);
    store(i, bodies, batch->ends.i);
    store(j, bodies, batch->ends.j);
    return deepest(least, get(batch->cap));
  }
};

void part_points(const PointBatch* batches, int count, PointParting* points, double share, Body* bodies,
                 double* deepest) {
  PointParts visits[abreast];
  int most = 0;
  for (int b = 0; b < count; ++b) {
    visits[b].batch = &batches[b];
    visits[b].points = points + batches[b].first_row;
    visits[b].enter(bodies);
    most = batches[b].count > most ? batches[b].count : most;
  }
  for (int k = 0; k < most; ++k) {
    for (int b = 0; b < count; ++b) {
      if (k < batches[b].count) visits[b].visit(k, share);
    }
  }
  for (int b = 0; b < count; ++b) deepest[b] = visits[b].leave(bodies);
}

}  // namespace

}  // namespace scree::lanes::SCREE_LANES
