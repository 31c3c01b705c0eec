// Couples of rolling friction: visits that find them, and what they have moved.
#pragma once

#include "sim/dynamics/lanes/kernels/sweeps.hpp"

namespace scree::lanes::SCREE_LANES {

namespace {

/// Of the contacts of a batch, how a couple turns their bodies.
struct Turning {
  V i, j;  ///< of balls
};
struct SymmetricTurning {
  Symmetric i, j;
};
[[gnu::always_inline]] inline Turning turning_of(const BallBatch&, const Bodies& i, const Bodies& j) {
  return {i.inverse_inertia, j.inverse_inertia};
}
[[gnu::always_inline]] inline SymmetricTurning turning_of(const PointBatch& batch, const Bodies&,
                                                          const Bodies&) {
  return {get(batch.inertia_i), get(batch.inertia_j)};
}
[[gnu::always_inline]] inline V rolling_mass(const Turning& by, const V3&) {
  return lanes::rolling_mass<Lanes>(by.i + by.j);
}
[[gnu::always_inline]] inline V rolling_mass(const SymmetricTurning& by, const V3& n) {
  return lanes::rolling_mass<Lanes>(by.i + by.j, n);
}

template <class By>
[[gnu::always_inline]] inline void turn_by(const By& by, const V3& couple, Bodies& i, Bodies& j) {
  i.spin = i.spin - by.i * couple;
  j.spin = j.spin + by.j * couple;
}

/// `pn`: normal impulses as the visit to the contacts has left them.
template <class Batch>
[[gnu::always_inline]] inline Change roll(const Batch& batch, const V& pn, Rolling& rolling, Body* bodies,
                                          double beta) {
  Bodies i = load(bodies, batch.ends.i);
  Bodies j = load(bodies, batch.ends.j);
  const V3 n = get(batch.normal);
  const auto by = turning_of(batch, i, j);
  const V mass = rolling_mass(by, n);
  const V3 last = accelerate(rolling.couple, all(beta));
  const V3 couple = couple_of(n, get(rolling.reach) * pn, mass, last, j.spin - i.spin);
  const V3 change = couple - last;
  turn_by(by, change, i, j);
  store(i, bodies, batch.ends.i);
  store(j, bodies, batch.ends.j);
  set(rolling.couple.impulse, couple);
  // Where nothing turns nothing changes.
  const V inverse = mass > 0 ? 1.0 / mass : V{};
  return total(dot(change, change) * inverse, dot(couple, couple) * inverse);
}

Change roll_balls(const BallBatch& batch, Rolling& rolling, Body* bodies, double beta) {
  return roll(batch, dot(get(batch.impulse.impulse), get(batch.normal)), rolling, bodies, beta);
}

Change roll_points(const PointBatch& batch, const PointRow* rows, Rolling& rolling, Body* bodies,
                   double beta) {
  V3 p = get(rows[0].impulse.impulse);
  for (int k = 1; k < batch.count; ++k) p = p + get(rows[k].impulse.impulse);
  return roll(batch, dot(p, get(batch.normal)), rolling, bodies, beta);
}

template <class Batch>
[[gnu::always_inline]] inline void push_rolling(const Batch& batch, const Rolling& rolling, Body* bodies) {
  Bodies i = load(bodies, batch.ends.i);
  Bodies j = load(bodies, batch.ends.j);
  turn_by(turning_of(batch, i, j), get(rolling.couple.impulse), i, j);
  store(i, bodies, batch.ends.i);
  store(j, bodies, batch.ends.j);
}

void push_rolling_balls(const BallBatch& batch, const Rolling& rolling, Body* bodies) {
  push_rolling(batch, rolling, bodies);
}

void push_rolling_points(const PointBatch& batch, const Rolling& rolling, Body* bodies) {
  push_rolling(batch, rolling, bodies);
}

/// Energy that the couples take at these spins.
[[gnu::always_inline]] inline V against(const V3& couple, const Bodies& i, const Bodies& j) {
  return dot(couple, i.spin - j.spin);
}

void book_rolling(const Ends& ends, const Rolling& rolling, const Body* mean, Losses& losses) {
  const Bodies i = load(mean, ends.i);
  const Bodies j = load(mean, ends.j);
  const V3 couple = get(rolling.couple.impulse);
  const V friction = against(couple, i, j);
  const V of_i = i.inverse_mass > 0 ? V{} : dot(couple, i.spin);
  const V of_j = j.inverse_mass > 0 ? V{} : dot(couple, j.spin);
  set(losses.of, get(losses.of) + friction);
  for (int l = 0; l < width; ++l) {
    losses.books.friction += friction[l];
    losses.books.work += of_i[l] - of_j[l];
  }
}

void square_of_rolling(const Ends& ends, const Rolling& rolling, const Body* kicked, const Body* after,
                       Lane& square) {
  const V3 couple = get(rolling.couple.impulse);
  set(square, get(square) + 0.5 * (against(couple, load(kicked, ends.i), load(kicked, ends.j)) -
                                   against(couple, load(after, ends.i), load(after, ends.j))));
}

}  // namespace

}  // namespace scree::lanes::SCREE_LANES
