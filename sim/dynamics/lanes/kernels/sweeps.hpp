// Visits to contacts that find their impulses.
#pragma once

#include "sim/dynamics/lanes/kernels/batch_vectors.hpp"

namespace scree::lanes::SCREE_LANES {

namespace {

/// Goes on by beta of what the last sweep has changed.
[[gnu::always_inline]] inline V3 accelerate(LaneImpulse& lanes, const V& beta) {
  const V3 p = get(lanes.impulse);
  const V3 ahead = p + beta * (p - get(lanes.last));
  set(lanes.last, p);
  return ahead;
}

/// Those of the contacts' rows, in the order of the lanes.
Change total(const V& step, const V& size) {
  Change change{0, 0};
  for (int l = 0; l < width; ++l) {
    change.step += step[l];
    change.size += size[l];
  }
  return change;
}

/// Sets the impulses p; what that changes.
[[gnu::always_inline]] inline Change keep(BallBatch& batch, const V3& p, const V3& last) {
  const V3 change = p - last;
  const V normal_mass = get(batch.normal_mass);
  set(batch.impulse.impulse, p);
  return total(dot(change, change) / normal_mass, dot(p, p) / normal_mass);
}

Change sweep_balls(BallBatch& batch, Body* bodies, double beta) {
  Bodies i = load(bodies, batch.ends.i);
  Bodies j = load(bodies, batch.ends.j);
  const Balls balls = get(batch);
  const V3 last = accelerate(batch.impulse, all(beta));
  const V3 p = impulse_of(balls, last, i, j);
  push(balls, p - last, i, j);
  store(i, bodies, batch.ends.i);
  store(j, bodies, batch.ends.j);
  return keep(batch, p, last);
}

Change sweep_smooth_balls(BallBatch& batch, Body* bodies, double beta) {
  Centres i = load_centres(bodies, batch.ends.i);
  Centres j = load_centres(bodies, batch.ends.j);
  const V3 n = get(batch.normal);
  const V3 last = accelerate(batch.impulse, all(beta));
  const V3 p =
      smooth_impulse_of(n, get(batch.target), get(batch.normal_mass), last, dot(j.velocity - i.velocity, n));
  push_centres(p - last, i, j);
  store(i, bodies, batch.ends.i);
  store(j, bodies, batch.ends.j);
  return keep(batch, p, last);
}

/// A visit to a batch of points, which it enters, goes through point by point, and leaves.
template <bool rough>
struct PointSweep {
  const PointBatch* batch;
  PointRow* rows;
  Bodies i, j;
  V3 last[most_points];

  [[gnu::always_inline]] void enter(const Body* bodies, const V& beta) {
    i = load(bodies, batch->ends.i);
    j = load(bodies, batch->ends.j);
    for (int k = 0; k < batch->count; ++k) {
      last[k] = accelerate(rows[k].impulse, beta);
      set(rows[k].impulse.impulse, last[k]);
    }
  }
  [[gnu::always_inline]] void visit(int k) {
    PointRow& row = rows[k];
    const V3 n = get(batch->normal);
    const Point at = point_of(row);
    const V3 u = velocity_at(at, i, j);
    const V3 old = get(row.impulse.impulse);
    V3 p;
    if constexpr (rough) {
      const auto stuck = sticking(law_of(row), n, get(batch->friction), old, u);
      const V pn = normal_impulse_of(law_of(row), n, old, u);
      p = where(stuck.holds, stuck.impulse, pn * n);
      // Where nothing slides, which costs as much as all before.
      if (Lanes::any(~stuck.holds & (pn > 0)))
        p = where(stuck.holds, p, sliding_impulse(law_of(row), n, get(batch->friction), old, u, pn));
    } else {
      p = smooth_impulse_of(n, get(row.target), get(row.normal_mass), old, dot(u, n));
    }
    set(row.impulse.impulse, p);
    push(get(batch->inertia_i), get(batch->inertia_j), at, p - old, i, j);
  }
  [[gnu::always_inline]] Change leave(Body* bodies) const {
    store(i, bodies, batch->ends.i);
    store(j, bodies, batch->ends.j);
    V step = all(0);
    V size = all(0);
    const V3 n = get(batch->normal);
    for (int k = 0; k < batch->count; ++k) {
      const V3 p = get(rows[k].impulse.impulse);
      const V3 change = p - last[k];
      const V inverse_mass = dot(get(rows[k].coupling), n);
      step += dot(change, change) * inverse_mass;
      size += dot(p, p) * inverse_mass;
    }
    return total(step, size);
  }
};

template <bool rough>
void sweep_points(const PointBatch* batches, int count, PointRow* rows, Body* bodies, double beta,
                  int block_sweeps, Change* change) {
  PointSweep<rough> visits[abreast];
  int points = 0;
  for (int b = 0; b < count; ++b) {
    visits[b].batch = &batches[b];
    visits[b].rows = rows + batches[b].first_row;
    visits[b].enter(bodies, all(beta));
    points = batches[b].count > points ? batches[b].count : points;
  }
  for (int sweep = 0; sweep < block_sweeps; ++sweep) {
    for (int k = 0; k < points; ++k) {
      for (int b = 0; b < count; ++b) {
        // A point alone is solved at once.
        if (k < batches[b].count && (sweep == 0 || batches[b].count > 1)) visits[b].visit(k);
      }
    }
  }
  for (int b = 0; b < count; ++b) change[b] = visits[b].leave(bodies);
}

/// The inverse mass and inertia stay: they are those of the last.
void accelerate(Body* bodies, Body* last, std::int64_t count, double beta) {
  for (std::int64_t k = 0; k < count; ++k) {
    const V now = whole(bodies[k]);
    whole(bodies[k]) = now + all(beta) * (now - whole(last[k]));
    whole(last[k]) = now;
  }
}

void push_balls(const BallBatch& batch, Body* bodies) {
  Bodies i = load(bodies, batch.ends.i);
  Bodies j = load(bodies, batch.ends.j);
  push(get(batch), get(batch.impulse.impulse), i, j);
  store(i, bodies, batch.ends.i);
  store(j, bodies, batch.ends.j);
}

void push_points(const PointBatch& batch, const PointRow* rows, Body* bodies) {
  Bodies i = load(bodies, batch.ends.i);
  Bodies j = load(bodies, batch.ends.j);
  for (int k = 0; k < batch.count; ++k) {
    push(get(batch.inertia_i), get(batch.inertia_j), point_of(rows[k]), get(rows[k].impulse.impulse), i, j);
  }
  store(i, bodies, batch.ends.i);
  store(j, bodies, batch.ends.j);
}

}  // namespace

}  // namespace scree::lanes::SCREE_LANES
