// Compiled once for each instruction set; SCREE_LANES names it. It calls nothing that other sources share, so
// that no function of theirs is compiled for more than the program may use.
#include "sim/dynamics/lanes/lanes.hpp"
#include "sim/dynamics/lanes/laws.hpp"

#include <cstddef>

namespace scree::lanes::SCREE_LANES {

namespace {

using V [[gnu::vector_size(sizeof(Lane)), gnu::may_alias]] = double;

struct Lanes {
  using V = scree::lanes::SCREE_LANES::V;
  static V root(const V& a) {
    V r = a;
    for (int l = 0; l < width; ++l) r[l] = __builtin_sqrt(a[l]);
    return r;
  }
};
using V3 = lanes::V3<Lanes>;
using Bodies = lanes::Moving<Lanes>;  // one of each contact
using Centres = lanes::Centre<Lanes>;
using Symmetric = lanes::Symmetric<Lanes>;
using Balls = lanes::Balls<Lanes>;
using Point = lanes::Point<Lanes>;
using PointLaw = lanes::PointLaw<Lanes>;

V all(double value) { return value - V{}; }

V get(const Lane& lane) { return *reinterpret_cast<const V*>(lane.at); }
void set(Lane& lane, const V& value) { *reinterpret_cast<V*>(lane.at) = value; }
V3 get(const LaneVec& lanes) { return {get(lanes.x), get(lanes.y), get(lanes.z)}; }
void set(LaneVec& lanes, const V3& value) {
  set(lanes.x, value.x);
  set(lanes.y, value.y);
  set(lanes.z, value.z);
}

Symmetric get(const Lane (&m)[6]) {
  return {get(m[0]), get(m[1]), get(m[2]), get(m[3]), get(m[4]), get(m[5])};
}
Balls get(const BallBatch& batch) {
  return {get(batch.normal), get(batch.arm_i),       get(batch.arm_j),       get(batch.friction),
          get(batch.target), get(batch.normal_mass), get(batch.tangent_mass)};
}
Point point_of(const PointRow& row) { return {get(row.arm_i), get(row.arm_j)}; }
PointLaw law_of(const PointRow& row) {
  return {get(row.stick), get(row.coupling), get(row.target), get(row.normal_mass), get(row.tangent_mass)};
}

/// Squares of `size` numbers, side by side, each turned about its diagonal: pairs, then fours, then halves
/// change places.
template <int size>
[[gnu::always_inline]] inline void transpose(V* rows) {
  const auto exchange = [rows](int distance, auto low, auto high) {
    for (int k = 0; k < size; ++k) {
      if ((k & distance) != 0) continue;
      const V a = rows[k];
      const V b = rows[k + distance];
      rows[k] = low(a, b);
      rows[k + distance] = high(a, b);
    }
  };
  exchange(
      1, [](V a, V b) { return __builtin_shufflevector(a, b, 0, 8, 2, 10, 4, 12, 6, 14); },
      [](V a, V b) { return __builtin_shufflevector(a, b, 1, 9, 3, 11, 5, 13, 7, 15); });
  exchange(
      2, [](V a, V b) { return __builtin_shufflevector(a, b, 0, 1, 8, 9, 4, 5, 12, 13); },
      [](V a, V b) { return __builtin_shufflevector(a, b, 2, 3, 10, 11, 6, 7, 14, 15); });
  if constexpr (size > 4) {
    exchange(
        4, [](V a, V b) { return __builtin_shufflevector(a, b, 0, 1, 2, 3, 8, 9, 10, 11); },
        [](V a, V b) { return __builtin_shufflevector(a, b, 4, 5, 6, 7, 12, 13, 14, 15); });
  }
}

static_assert(sizeof(Body) == sizeof(V) && offsetof(Body, inverse_mass) == 24 && offsetof(Body, spin) == 32);
static_assert(sizeof(Bodies) == width * sizeof(V));
V& whole(Body& body) { return reinterpret_cast<V&>(body); }
const V& whole(const Body& body) { return reinterpret_cast<const V&>(body); }

[[gnu::always_inline]] inline Bodies load(const Body* bodies, const std::int32_t* at) {
  V rows[width];
  for (int l = 0; l < width; ++l) rows[l] = whole(bodies[at[l]]);
  transpose<width>(rows);
  return {{rows[0], rows[1], rows[2]}, rows[3], {rows[4], rows[5], rows[6]}, rows[7]};
}

[[gnu::always_inline]] inline void store(const Bodies& from, Body* bodies, const std::int32_t* at) {
  V rows[width] = {from.velocity.x, from.velocity.y, from.velocity.z, from.inverse_mass,
                   from.spin.x,     from.spin.y,     from.spin.z,     from.inverse_inertia};
  transpose<width>(rows);
  for (int l = 0; l < width; ++l) {
    if (bodies[at[l]].inverse_mass > 0) whole(bodies[at[l]]) = rows[l];
  }
}

/// Of a body what does not turn is half.
constexpr int half = width / 2;
using Half [[gnu::vector_size(sizeof(Lane) / 2), gnu::may_alias]] = double;
Half& linear_half(Body& body) { return reinterpret_cast<Half&>(body); }
const Half& linear_half(const Body& body) { return reinterpret_cast<const Half&>(body); }

[[gnu::always_inline]] inline Centres load_centres(const Body* bodies, const std::int32_t* at) {
  V rows[half];
  for (int l = 0; l < half; ++l) {
    rows[l] = __builtin_shufflevector(linear_half(bodies[at[l]]), linear_half(bodies[at[l + half]]), 0, 1, 2,
                                      3, 4, 5, 6, 7);
  }
  transpose<half>(rows);
  return {{rows[0], rows[1], rows[2]}, rows[3]};
}

[[gnu::always_inline]] inline void store(const Centres& from, Body* bodies, const std::int32_t* at) {
  V rows[half] = {from.velocity.x, from.velocity.y, from.velocity.z, from.inverse_mass};
  transpose<half>(rows);
  for (int l = 0; l < half; ++l) {
    Body& low = bodies[at[l]];
    Body& high = bodies[at[l + half]];
    if (low.inverse_mass > 0) linear_half(low) = __builtin_shufflevector(rows[l], rows[l], 0, 1, 2, 3);
    if (high.inverse_mass > 0) linear_half(high) = __builtin_shufflevector(rows[l], rows[l], 4, 5, 6, 7);
  }
}

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

template <bool rough>
Change sweep_points(const PointBatch& batch, PointRow* rows, Body* bodies, double beta, int block_sweeps) {
  Bodies i = load(bodies, batch.ends.i);
  Bodies j = load(bodies, batch.ends.j);
  const V3 n = get(batch.normal);
  const V friction = get(batch.friction);
  V3 last[most_points];
  for (int k = 0; k < batch.count; ++k) {
    last[k] = accelerate(rows[k].impulse, all(beta));
    set(rows[k].impulse.impulse, last[k]);
  }
  const int sweeps = batch.count > 1 ? block_sweeps : 1;
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    for (int k = 0; k < batch.count; ++k) {
      PointRow& row = rows[k];
      const Point at = point_of(row);
      const V3 u = velocity_at(at, i, j);
      const V3 old = get(row.impulse.impulse);
      V3 p;
      if constexpr (rough) {
        p = impulse_of(law_of(row), n, friction, old, u);
      } else {
        p = smooth_impulse_of(n, get(row.target), get(row.normal_mass), old, dot(u, n));
      }
      set(row.impulse.impulse, p);
      push(get(batch.inertia_i), get(batch.inertia_j), at, p - old, i, j);
    }
  }
  store(i, bodies, batch.ends.i);
  store(j, bodies, batch.ends.j);
  V step = all(0);
  V size = all(0);
  for (int k = 0; k < batch.count; ++k) {
    const V3 p = get(rows[k].impulse.impulse);
    const V3 change = p - last[k];
    const V normal_mass = get(rows[k].normal_mass);
    step += dot(change, change) / normal_mass;
    size += dot(p, p) / normal_mass;
  }
  return total(step, size);
}

/// The inverse mass and inertia stay: they are those of the last.
void accelerate(Body& body, Body& last, double beta) {
  const V now = whole(body);
  whole(body) = now + all(beta) * (now - whole(last));
  whole(last) = now;
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

double part_points(const PointBatch& batch, const PointRow* rows, PointParting* points, const Lane& cap,
                   double share, Body* bodies) {
  Bodies i = load(bodies, batch.ends.i);
  Bodies j = load(bodies, batch.ends.j);
  const V3 n = get(batch.normal);
  V least = all(0);
  for (int k = 0; k < batch.count; ++k) {
    const Point at = point_of(rows[k]);
    const V gap = get(points[k].flown) + dot(n, velocity_at(at, i, j));
    push(get(batch.inertia_i), get(batch.inertia_j), at,
         part(gap, cap, share, rows[k].normal_mass, points[k].pushed) * n, i, j);
    least = gap < least ? gap : least;
  }
  store(i, bodies, batch.ends.i);
  store(j, bodies, batch.ends.j);
  return deepest(least, get(cap));
}

}  // namespace

extern const Kernels kernels = {.rough = {sweep_balls, sweep_points<true>},
                                .smooth = {sweep_smooth_balls, sweep_points<false>},
                                .accelerate = accelerate,
                                .push_balls = push_balls,
                                .push_points = push_points,
                                .part_balls = part_balls,
                                .part_points = part_points};

}  // namespace scree::lanes::SCREE_LANES
