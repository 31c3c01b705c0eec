// What impulses have moved.
#pragma once

#include "sim/dynamics/lanes/kernels/batch_vectors.hpp"

namespace scree::lanes::SCREE_LANES {

namespace {

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

}  // namespace

}  // namespace scree::lanes::SCREE_LANES
