// Which pairs touch, and their contacts.
#pragma once

#include "sim/dynamics/lanes/kernels/batch_vectors.hpp"

namespace scree::lanes::SCREE_LANES {

namespace {

static_assert(sizeof(Reach) == sizeof(Half) && offsetof(Reach, extent) == 24);
static_assert(sizeof(Ball) == sizeof(V) && offsetof(Ball, radius) == 24 && offsetof(Ball, velocity) == 32);

/// From i to j; the last number adds up.
[[gnu::always_inline]] inline void load_offsets(const Reach* reach, const Two* pairs, V* rows) {
  const Half sign = {-1, -1, -1, 1};
  const auto at = [reach](std::int32_t k) { return *reinterpret_cast<const Half*>(reach + k); };
  Half offset[width];
  for (int l = 0; l < width; ++l) offset[l] = at(pairs[l].j) + sign * at(pairs[l].i);
  interleave(offset, rows);
}

/// As Period::nearest(). What is added and taken away again leaves a whole number, as rint() does.
[[gnu::always_inline]] inline V nearest(const V& offset, double length, double per_length) {
  constexpr double whole = 0x1.8p52;
  return offset - length * ((offset * per_length + whole) - whole);
}
[[gnu::always_inline]] inline V3 nearest(const V3& offset, const Period* period) {
  if (period == nullptr) return offset;
  const Vec3 &length = period->length, &per_length = period->per_length;
  return {nearest(offset.x, length.x(), per_length.x()), nearest(offset.y, length.y(), per_length.y()),
          nearest(offset.z, length.z(), per_length.z())};
}

std::uint64_t touch_balls(const Reach* reach, const Two* pairs, const Period* period) {
  std::uint64_t touching = 0;
  for (int first = 0; first < look; first += width) {
    V at[half];
    load_offsets(reach, pairs + first, at);
    const V3 offset = nearest(V3{at[0], at[1], at[2]}, period);
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
  const V3 offset = nearest(x_j - x_i, from.period);
  const auto contact = contact_of<Lanes>(facing<Lanes>(offset, i.radius + j.radius, up), friction, i, j, kick,
                                         from.step, from.noise, spread(parting.flying) > 0);
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

}  // namespace

}  // namespace scree::lanes::SCREE_LANES
