// Compiled once for each instruction set; SCREE_LANES names it. It calls nothing that other sources share, so
// that no function of theirs is compiled for more than the program may use.
#include "sim/dynamics/lanes/free_turn.hpp"
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
  static bool any(const decltype(V{} > V{}) & condition) {
    const auto fours = condition | __builtin_shufflevector(condition, condition, 4, 5, 6, 7, 0, 1, 2, 3);
    const auto twos = fours | __builtin_shufflevector(fours, fours, 2, 3, 0, 1, 6, 7, 4, 5);
    return (twos[0] | twos[1]) != 0;
  }
  static HalfTurn<Lanes> half_turn(const V& square) { return half_turn_series<Lanes>(square); }
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
void set(Lane (&m)[6], const Symmetric& value) {
  set(m[0], value.xx);
  set(m[1], value.yy);
  set(m[2], value.zz);
  set(m[3], value.xy);
  set(m[4], value.xz);
  set(m[5], value.yz);
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

/// Halves of eight lines side by side: two rows of four numbers become four lanes of eight.
[[gnu::always_inline]] inline void interleave(const Half* low, V* rows) {
  for (int l = 0; l < half; ++l)
    rows[l] = __builtin_shufflevector(low[l], low[l + half], 0, 1, 2, 3, 4, 5, 6, 7);
  transpose<half>(rows);
}

static_assert(sizeof(Reach) == sizeof(Half) && offsetof(Reach, extent) == 24);
static_assert(sizeof(Ball) == sizeof(V) && offsetof(Ball, radius) == 24 && offsetof(Ball, velocity) == 32);

std::uint64_t bits_of(const decltype(V{} > V{}) & lanes) {
  std::uint64_t bits = 0;
  for (int l = 0; l < width; ++l) bits |= static_cast<std::uint64_t>(lanes[l] & 1) << l;
  return bits;
}

/// From i to j; the last number adds up.
[[gnu::always_inline]] inline void load_offsets(const Reach* reach, const Two* pairs, V* rows) {
  const Half sign = {-1, -1, -1, 1};
  const auto at = [reach](std::int32_t k) { return *reinterpret_cast<const Half*>(reach + k); };
  Half offset[width];
  for (int l = 0; l < width; ++l) offset[l] = at(pairs[l].j) + sign * at(pairs[l].i);
  interleave(offset, rows);
}

std::uint64_t touch_balls(const Reach* reach, const Two* pairs) {
  std::uint64_t touching = 0;
  for (int first = 0; first < look; first += width) {
    V at[half];
    load_offsets(reach, pairs + first, at);
    const V3 offset{at[0], at[1], at[2]};
    touching |= bits_of((at[3] > 0) & (dot(offset, offset) <= at[3] * at[3])) << first;
  }
  return touching;
}

/// Of i less that of j.
V3 gather(const Triple* of, const std::int32_t* at_i, const std::int32_t* at_j) {
  V3 lanes;
  for (int l = 0; l < width; ++l) {
    const Triple &i = of[at_i[l]], &j = of[at_j[l]];
    lanes.x[l] = i.x - j.x;
    lanes.y[l] = i.y - j.y;
    lanes.z[l] = i.z - j.z;
  }
  return lanes;
}

std::uint64_t touch_planes(const Reach* reach, const Triple* up, const Two* pairs) {
  std::uint64_t touching = 0;
  for (int first = 0; first < look; first += width) {
    V at[half];
    load_offsets(reach, pairs + first, at);
    const V3 offset{at[0], at[1], at[2]};
    std::int32_t i[width], j[width];
    for (int l = 0; l < width; ++l) {
      i[l] = pairs[first + l].i;
      j[l] = pairs[first + l].j;
    }
    touching |= bits_of(dot(gather(up, i, j), offset) <= at[3]) << first;
  }
  return touching;
}

/// A lane that is 1 where a byte is.
V spread(const std::uint8_t* bytes) {
  V lanes;
  for (int l = 0; l < width; ++l) lanes[l] = bytes[l];
  return lanes;
}

[[gnu::always_inline]] inline lanes::Round<Lanes> load(const Ball* balls, const double* inverse_inertia,
                                                       const std::int32_t* at, V3& position) {
  V rows[width];
  lanes::Round<Lanes> ball;
  for (int l = 0; l < width; ++l) {
    rows[l] = *reinterpret_cast<const V*>(balls + at[l]);
    ball.inverse_inertia[l] = inverse_inertia[at[l]];
  }
  transpose<width>(rows);
  position = {rows[0], rows[1], rows[2]};
  ball.radius = rows[3];
  ball.velocity = {rows[4], rows[5], rows[6]};
  ball.inverse_mass = rows[7];
  return ball;
}

void prepare_balls(const BallSource& from, BallBatch& batch, BallParting& parting) {
  V3 x_i, x_j;
  const auto i = load(from.balls, from.inverse_inertia, batch.ends.i, x_i);
  const auto j = load(from.balls, from.inverse_inertia, batch.ends.j, x_j);
  parting.driven = static_cast<std::int32_t>(bits_of((i.inverse_mass == 0) | (j.inverse_mass == 0)));
  // Two free bodies fall alike, unless forces are applied.
  V3 kick{};
  if (from.forces || parting.driven != 0) kick = V3{} - gather(from.kick, batch.ends.i, batch.ends.j);
  const bool planes = bits_of((i.radius == 0) | (j.radius == 0)) != 0;
  const V3 up = planes ? gather(from.up, batch.ends.i, batch.ends.j) : V3{};
  const V friction = get(batch.friction);
  const auto contact = contact_of<Lanes>(facing<Lanes>(x_j - x_i, i.radius + j.radius, up), friction, i, j,
                                         kick, from.step, from.noise, spread(parting.flying) > 0);
  const Balls& law = contact.law;
  const V3 start = in_cone<Lanes>(get(batch.impulse.impulse), law.normal, friction);
  set(batch.normal, law.normal);
  set(batch.arm_i, law.arm_i);
  set(batch.arm_j, law.arm_j);
  set(batch.target, law.target);
  set(batch.normal_mass, law.normal_mass);
  set(batch.tangent_mass, law.tangent_mass);
  set(batch.impulse.impulse, start);
  set(batch.impulse.last, start);
  parting.ends = batch.ends;
  set(parting.normal, law.normal);
  set(parting.normal_mass, law.normal_mass);
  set(parting.gap, contact.gap);
  set(parting.bend, contact.bend);
  set(parting.pushed, all(0));
  const V smaller = i.radius < j.radius ? i.radius : j.radius;
  set(parting.cap, tolerance::correction_cap * (smaller > 0 ? smaller : i.radius + j.radius));
  parting.apart = 0;
}

void prepare_points(const PointBatch& batch, PointRow* rows, PointParting* points, const Body* bodies) {
  const V mass_i = load_centres(bodies, batch.ends.i).inverse_mass;
  const V mass_j = load_centres(bodies, batch.ends.j).inverse_mass;
  for (int k = 0; k < batch.count; ++k) {
    PointRow& row = rows[k];
    const Point at = point_of(row);
    const auto law = lanes::law_of(delassus_share(mass_i, get(batch.inertia_i), at.arm_i) +
                                       delassus_share(mass_j, get(batch.inertia_j), at.arm_j),
                                   get(batch.normal), get(row.target));
    set(row.stick, law.stick);
    set(row.coupling, law.coupling);
    set(row.normal_mass, law.normal_mass);
    set(row.tangent_mass, law.tangent_mass);
    set(points[k].normal_mass, law.normal_mass);
    set(points[k].pushed, all(0));
  }
}

void set(Losses& losses, const Booked<Lanes>& books) {
  set(losses.of, books.restitution + books.friction);
  losses.books = {};
  for (int l = 0; l < width; ++l) {
    losses.books.restitution += books.restitution[l];
    losses.books.friction += books.friction[l];
    losses.books.work += books.work[l];
  }
}

void book_balls(const BallBatch& batch, const Body* mean, Losses& losses) {
  set(losses, booked<Lanes>(get(batch), get(batch.impulse.impulse), load(mean, batch.ends.i),
                            load(mean, batch.ends.j)));
}

void book_points(const PointBatch& batch, const PointRow* rows, const Body* mean, Losses& losses) {
  const Bodies i = load(mean, batch.ends.i);
  const Bodies j = load(mean, batch.ends.j);
  const V3 n = get(batch.normal);
  Booked<Lanes> books{};
  for (int k = 0; k < batch.count; ++k)
    books = books + booked<Lanes>(point_of(rows[k]), n, get(rows[k].impulse.impulse), i, j);
  set(losses, books);
}

void square_of_balls(const BallBatch& batch, const Body* kicked, const Body* after, Lane& square) {
  const Balls balls = get(batch);
  const V3 u_kicked = velocity_at(balls, load(kicked, batch.ends.i), load(kicked, batch.ends.j));
  const V3 u_after = velocity_at(balls, load(after, batch.ends.i), load(after, batch.ends.j));
  set(square, 0.5 * dot(get(batch.impulse.impulse), u_after - u_kicked));
}

void square_of_points(const PointBatch& batch, const PointRow* rows, const Body* kicked, const Body* after,
                      Lane& square) {
  const Bodies kicked_i = load(kicked, batch.ends.i), kicked_j = load(kicked, batch.ends.j);
  const Bodies after_i = load(after, batch.ends.i), after_j = load(after, batch.ends.j);
  V sum = all(0);
  for (int k = 0; k < batch.count; ++k) {
    const Point at = point_of(rows[k]);
    sum += 0.5 * dot(get(rows[k].impulse.impulse),
                     velocity_at(at, after_i, after_j) - velocity_at(at, kicked_i, kicked_j));
  }
  set(square, sum);
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

void turn(Tops& tops, double dt, bool fourth_order) {
  const V3 inverse_inertia = get(tops.inverse_inertia);
  const V3 inertia = {1.0 / inverse_inertia.x, 1.0 / inverse_inertia.y, 1.0 / inverse_inertia.z};
  Top<Lanes> top{{get(tops.w), get(tops.v)}, get(tops.spin), inertia, inverse_inertia};
  const auto start = start_of(top);
  const V turn = start.fastest * (dt < 0 ? -dt : dt);
  const auto hardly = turn < tolerance::hardly_a_turn;
  const auto splits = (turn >= tolerance::hardly_a_turn) & (turn <= tolerance::split_turn);
  tops.far = static_cast<std::int32_t>(bits_of(turn > tolerance::split_turn));
  V drift = all(0);
  const Top<Lanes> before = top;
  if (Lanes::any(hardly)) {
    Top<Lanes> turned = before;
    turn_little(turned, start, dt);
    choose(hardly, turned, top);
  }
  if (Lanes::any(splits)) {
    Top<Lanes> turned = before;
    const V drifted = turn_by_splitting(turned, start, dt, 1, fourth_order);
    choose(splits, turned, top);
    drift = splits ? drifted : drift;
  }
  set(tops.w, top.orientation.w);
  set(tops.v, top.orientation.v);
  set(tops.spin, top.spin);
  set(tops.drift, drift);
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
    gap = (spread(parting.flying) > 0) & (dot(p, p) == 0) ? all(__builtin_huge_val()) : gap;
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

static_assert(sizeof(InertiaRoot) == sizeof(V) && offsetof(InertiaRoot, zz) == 40);
[[gnu::always_inline]] inline lanes::Root<Lanes> load(const InertiaRoot* roots, const std::int32_t* at) {
  V rows[width];
  for (int l = 0; l < width; ++l) rows[l] = *reinterpret_cast<const V*>(roots + at[l]);
  transpose<width>(rows);
  return {rows[0], rows[1], rows[2], rows[3], rows[4], rows[5]};
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

extern const Kernels kernels = {.rough = {sweep_balls, sweep_points<true>},
                                .smooth = {sweep_smooth_balls, sweep_points<false>},
                                .touch_balls = touch_balls,
                                .touch_planes = touch_planes,
                                .prepare_balls = prepare_balls,
                                .prepare_points = prepare_points,
                                .book_balls = book_balls,
                                .book_points = book_points,
                                .square_of_balls = square_of_balls,
                                .square_of_points = square_of_points,
                                .fly_balls = fly_balls,
                                .fly_points = fly_points,
                                .turn = turn,
                                .accelerate = accelerate,
                                .push_balls = push_balls,
                                .push_points = push_points,
                                .part_balls = part_balls,
                                .part_points = part_points};

}  // namespace scree::lanes::SCREE_LANES
