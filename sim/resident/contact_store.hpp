// Memory for the contacts of a substep, a place for each slot.
#pragma once

#include "core/array.hpp"
#include "sim/resident/layout.hpp"

#include <cstdint>

namespace scree::resident {

template <class Space, class Real>
class ContactStore {
 public:
  /// Whole tiles of `tile` places: those of balls, and the others.
  void resize(std::int64_t balls, std::int64_t others, int tile) {
    balls_ = balls;
    ball_tiles_.resize(balls / tile);
    point_tiles_.resize(others / tile);
    ends_.resize(balls + others);
    slot_.resize(balls + others);
    flags_.resize(balls + others);
    points_.resize(others);
    ball_fields_.resize(decltype(BallContacts<Real>::fields)::size(balls));
    ball_gaps_.resize(decltype(BallContacts<Real>::gaps)::size(balls));
    contact_fields_.resize(decltype(PointContacts<Real>::fields)::size(others));
    point_fields_.resize(decltype(PointContacts<Real>::point_fields)::size(others));
    point_gaps_.resize(decltype(PointContacts<Real>::gaps)::size(others));
  }

  /// Places.
  std::int64_t ball_places() const { return balls_; }
  std::int64_t point_places() const { return points_.size(); }
  /// How many each tile has found, at its front.
  Array<std::int32_t, Space>& ball_tiles() { return ball_tiles_; }
  Array<std::int32_t, Space>& point_tiles() { return point_tiles_; }

  BallContacts<Real> balls() {
    return {.ends = ends_.data(),
            .slot = {slot_.data(), balls_},
            .flags = {flags_.data(), balls_},
            .fields = decltype(BallContacts<Real>::fields)(ball_fields_.data()),
            .gaps = decltype(BallContacts<Real>::gaps)(ball_gaps_.data())};
  }
  PointContacts<Real> points() {
    const std::int64_t places = points_.size();
    return {.ends = ends_.data() + balls_,
            .slot = {slot_.data() + balls_, places},
            .flags = {flags_.data() + balls_, places},
            .points = points_.data(),
            .fields = decltype(PointContacts<Real>::fields)(contact_fields_.data()),
            .point_fields = decltype(PointContacts<Real>::point_fields)(point_fields_.data()),
            .gaps = decltype(PointContacts<Real>::gaps)(point_gaps_.data())};
  }

  template <class From>
  void copy_from(const ContactStore<From, Real>& from) {
    balls_ = from.balls_;
    copy(ball_tiles_, from.ball_tiles_);
    copy(point_tiles_, from.point_tiles_);
    copy(ends_, from.ends_);
    copy(slot_, from.slot_);
    copy(flags_, from.flags_);
    copy(points_, from.points_);
    copy(ball_fields_, from.ball_fields_);
    copy(contact_fields_, from.contact_fields_);
    copy(point_fields_, from.point_fields_);
    copy(ball_gaps_, from.ball_gaps_);
    copy(point_gaps_, from.point_gaps_);
  }

 private:
  template <class, class>
  friend class ContactStore;

  std::int64_t balls_ = 0;
  Array<std::int32_t, Space> ball_tiles_, point_tiles_;
  Array<Ends, Space> ends_;
  Array<std::uint8_t, Space> slot_, flags_;
  Array<std::int32_t, Space> points_;
  Array<Real, Space> ball_fields_, contact_fields_, point_fields_, ball_gaps_, point_gaps_;
};

}  // namespace scree::resident
