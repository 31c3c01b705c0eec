// Compiled once for each instruction set; SCREE_LANES names it. It calls nothing that other sources share, so
// that no function of theirs is compiled for more than the program may use.
#include "sim/dynamics/lanes/lanes.hpp"

#include <cstddef>

namespace scree::lanes::SCREE_LANES {

namespace {

using V [[gnu::vector_size(sizeof(Lane)), gnu::may_alias]] = double;

struct V3 {
  V x, y, z;

  friend V3 operator+(const V3& a, const V3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend V3 operator-(const V3& a, const V3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend V3 operator*(const V& s, const V3& a) { return {s * a.x, s * a.y, s * a.z}; }
};

V dot(const V3& a, const V3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
V3 cross(const V3& a, const V3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
V all(double value) { return value - V{}; }
V above_zero(const V& a) { return a > 0 ? a : all(0); }
V root(const V& a) {
  V r = a;
  for (int l = 0; l < width; ++l) r[l] = __builtin_sqrt(a[l]);
  return r;
}
template <class Condition>
V3 where(const Condition& yes, const V3& a, const V3& b) {
  return {yes ? a.x : b.x, yes ? a.y : b.y, yes ? a.z : b.z};
}

V get(const Lane& lane) { return *reinterpret_cast<const V*>(lane.at); }
void set(Lane& lane, const V& value) { *reinterpret_cast<V*>(lane.at) = value; }
V3 get(const LaneVec& lanes) { return {get(lanes.x), get(lanes.y), get(lanes.z)}; }
void set(LaneVec& lanes, const V3& value) {
  set(lanes.x, value.x);
  set(lanes.y, value.y);
  set(lanes.z, value.z);
}

/// Symmetric matrices: xx, yy, zz, xy, xz, yz.
[[gnu::always_inline]] inline V3 times(const Lane* m, const V3& a) {
  const V xy = get(m[3]);
  const V xz = get(m[4]);
  const V yz = get(m[5]);
  return {get(m[0]) * a.x + xy * a.y + xz * a.z, xy * a.x + get(m[1]) * a.y + yz * a.z,
          xz * a.x + yz * a.y + get(m[2]) * a.z};
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

/// One body of each contact: its numbers in the order of Body.
struct Bodies {
  V3 velocity;
  V inverse_mass;
  V3 spin;
  V inverse_inertia;
};

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

/// Of each body the half that does not turn.
struct Centres {
  V3 velocity;
  V inverse_mass;
};
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

[[gnu::always_inline]] inline void push(const V3& p, Centres& i, Centres& j) {
  i.velocity = i.velocity - i.inverse_mass * p;
  j.velocity = j.velocity + j.inverse_mass * p;
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

[[gnu::always_inline]] inline V3 on_disc(const V& pn, const V3& pt, const V3& n, const V& friction) {
  const V radius = friction * pn;
  const V square = dot(pt, pt);
  return pn * n + where(square <= radius * radius, pt, (radius / root(square)) * pt);
}

[[gnu::always_inline]] inline void push_ball(const BallBatch& batch, const V3& n, const V3& p, Bodies& i,
                                             Bodies& j) {
  i.velocity = i.velocity - i.inverse_mass * p;
  j.velocity = j.velocity + j.inverse_mass * p;
  const V3 turn = where(get(batch.friction) > 0, cross(n, p), V3{});  // no rounding turns smooth balls
  i.spin = i.spin - (i.inverse_inertia * get(batch.arm_i)) * turn;
  j.spin = j.spin + (j.inverse_inertia * get(batch.arm_j)) * turn;
}

[[gnu::always_inline]] inline void push_point(const PointBatch& batch, const PointRow& row, const V3& p,
                                              Bodies& i, Bodies& j) {
  i.velocity = i.velocity - i.inverse_mass * p;
  j.velocity = j.velocity + j.inverse_mass * p;
  i.spin = i.spin - times(batch.inertia_i, cross(get(row.arm_i), p));
  j.spin = j.spin + times(batch.inertia_j, cross(get(row.arm_j), p));
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
  const V3 n = get(batch.normal);
  const V normal_mass = get(batch.normal_mass);
  const V3 last = accelerate(batch.impulse, all(beta));
  const V3 u = j.velocity - i.velocity + cross(get(batch.arm_j) * j.spin - get(batch.arm_i) * i.spin, n);
  const V pn_old = dot(last, n);
  const V un = dot(u, n);
  const V pn = above_zero(pn_old - (un - get(batch.target)) * normal_mass);
  const V3 pt = last - pn_old * n - get(batch.tangent_mass) * (u - un * n);
  const V3 p = on_disc(pn, pt, n, get(batch.friction));
  push_ball(batch, n, p - last, i, j);
  store(i, bodies, batch.ends.i);
  store(j, bodies, batch.ends.j);
  return keep(batch, p, last);
}

Change sweep_smooth_balls(BallBatch& batch, Body* bodies, double beta) {
  Centres i = load_centres(bodies, batch.ends.i);
  Centres j = load_centres(bodies, batch.ends.j);
  const V3 n = get(batch.normal);
  const V3 last = accelerate(batch.impulse, all(beta));
  const V un = dot(j.velocity - i.velocity, n);
  const V3 p = above_zero(dot(last, n) - (un - get(batch.target)) * get(batch.normal_mass)) * n;
  push(p - last, i, j);
  store(i, bodies, batch.ends.i);
  store(j, bodies, batch.ends.j);
  return keep(batch, p, last);
}

/// coulomb_update(), given the relative velocity u.
template <bool rough>
[[gnu::always_inline]] inline V3 update(const PointRow& row, const V3& n, const V& friction, const V3& p,
                                        const V3& u) {
  const V target = get(row.target);
  if constexpr (!rough) return above_zero(dot(p, n) - (dot(u, n) - target) * get(row.normal_mass)) * n;
  const V3 sticking = p - times(row.stick, u - target * n);
  const V pn_sticking = dot(sticking, n);
  const V3 pt_sticking = sticking - pn_sticking * n;
  const V radius = friction * pn_sticking;
  const auto sticks =
      (friction > 0) & (pn_sticking >= 0) & (dot(pt_sticking, pt_sticking) <= radius * radius);
  const V pn_old = dot(p, n);
  const V pn = above_zero(pn_old - (dot(u, n) - target) * get(row.normal_mass));
  const V3 v = u + (pn - pn_old) * get(row.coupling);
  const V3 pt = p - pn_old * n - get(row.tangent_mass) * (v - dot(v, n) * n);
  return where(sticks, sticking, on_disc(pn, pt, n, friction));
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
      const V3 u = j.velocity + cross(j.spin, get(row.arm_j)) - i.velocity - cross(i.spin, get(row.arm_i));
      const V3 old = get(row.impulse.impulse);
      const V3 p = update<rough>(row, n, friction, old, u);
      set(row.impulse.impulse, p);
      push_point(batch, row, p - old, i, j);
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
  push_ball(batch, get(batch.normal), get(batch.impulse.impulse), i, j);
  store(i, bodies, batch.ends.i);
  store(j, bodies, batch.ends.j);
}

void push_points(const PointBatch& batch, const PointRow* rows, Body* bodies) {
  Bodies i = load(bodies, batch.ends.i);
  Bodies j = load(bodies, batch.ends.j);
  for (int k = 0; k < batch.count; ++k) push_point(batch, rows[k], get(rows[k].impulse.impulse), i, j);
  store(i, bodies, batch.ends.i);
  store(j, bodies, batch.ends.j);
}

/// What more a point pushes that has pushed so much (kg m), to close in on a gap of 0 by a share. Where
/// others have opened the gap since, it takes back what it did: so bodies part as little as they must.
V parting(const V& gap, const V& cap, double share, const V& normal_mass, Lane& pushed) {
  const V part = -share * gap;
  const V before = get(pushed);
  const V after = above_zero(before + (part < cap ? part : cap) * normal_mass);
  set(pushed, after);
  return after - before;
}

/// The deepest overlap of the lanes, in units of the cap.
double deepest(const V& gap, const V& cap) {
  const V depth = above_zero(cap > 0 ? -gap / cap : all(0));
  double deepest = 0;
  for (int l = 0; l < width; ++l) deepest = depth[l] > deepest ? depth[l] : deepest;
  return deepest;
}

double part_balls(BallParting& batch, double share, Body* bodies) {
  Centres i = load_centres(bodies, batch.ends.i);
  Centres j = load_centres(bodies, batch.ends.j);
  const V3 n = get(batch.normal);
  const V gap = get(batch.flown) + dot(n, j.velocity - i.velocity);
  push(parting(gap, get(batch.cap), share, get(batch.normal_mass), batch.pushed) * n, i, j);
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
    const PointRow& row = rows[k];
    const V3 moved = j.velocity + cross(j.spin, get(row.arm_j)) - i.velocity - cross(i.spin, get(row.arm_i));
    const V gap = get(points[k].flown) + dot(n, moved);
    push_point(batch, row, parting(gap, get(cap), share, get(row.normal_mass), points[k].pushed) * n, i, j);
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
