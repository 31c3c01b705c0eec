// The memory for the contacts of a substep, colour by colour.
#pragma once

#include "core/array.hpp"
#include "sim/contacts/layout.hpp"

#include <cstdint>
#include <numeric>
#include <vector>

namespace scree::solver {

/// The largest number of colours. Contacts need no more, since those of hubs are distributed over several
/// parts (SolverBodies).
inline constexpr int most_colors = 64;

/// The places of the contacts of each colour; contacts of one colour share no free body. Each colour begins
/// with a new block of simd::width places, and the places left over in its last block hold no contact.
struct ColorRanges {
  std::vector<std::int64_t> begin{0};  ///< first place of each colour, then the end of the last
  std::vector<std::int64_t> count;     ///< number of contacts of each colour

  void add(std::int64_t contacts) {
    const std::int64_t blocks = (contacts + simd::width - 1) / simd::width;
    begin.push_back(begin.back() + blocks * simd::width);
    count.push_back(contacts);
  }
  int colors() const { return static_cast<int>(count.size()); }
  std::int64_t contacts() const { return std::accumulate(count.begin(), count.end(), std::int64_t{0}); }
  /// Returns the number of places: contacts, and places left over in blocks.
  std::int64_t places() const { return begin.back(); }
};

/// The memory for the contacts of both kinds.
template <class Space, class Real>
class ContactStore {
 public:
  void take_balls(const ColorRanges& colors) {
    ball_colors_ = colors;
    const std::int64_t n = colors.places();
    ball_ends_.resize(n);
    ball_slots_.resize(n);
    ball_flags_.resize(n);
    ball_fields_.resize(decltype(BallContacts<Real>::fields)::size(n));
    ball_gaps_.resize(decltype(BallContacts<Real>::gaps)::size(n));
  }
  void take_points(const ColorRanges& colors) {
    point_colors_ = colors;
    const std::int64_t n = colors.places();
    point_ends_.resize(n);
    point_slots_.resize(n);
    point_flags_.resize(n);
    points_.resize(n);
    contact_fields_.resize(decltype(PointContacts<Real>::fields)::size(n));
    point_fields_.resize(decltype(PointContacts<Real>::point_fields)::size(n));
    point_gaps_.resize(decltype(PointContacts<Real>::gaps)::size(n));
  }

  const ColorRanges& ball_colors() const { return ball_colors_; }
  const ColorRanges& point_colors() const { return point_colors_; }

  BallContacts<Real> balls() {
    return {.ends = ball_ends_.data(),
            .slot = ball_slots_.view(),
            .flags = ball_flags_.view(),
            .fields = decltype(BallContacts<Real>::fields)(ball_fields_.data()),
            .gaps = decltype(BallContacts<Real>::gaps)(ball_gaps_.data())};
  }
  PointContacts<Real> points() {
    return {.ends = point_ends_.data(),
            .slot = point_slots_.view(),
            .flags = point_flags_.view(),
            .points = points_.data(),
            .fields = decltype(PointContacts<Real>::fields)(contact_fields_.data()),
            .point_fields = decltype(PointContacts<Real>::point_fields)(point_fields_.data()),
            .gaps = decltype(PointContacts<Real>::gaps)(point_gaps_.data())};
  }

  template <class From>
  void copy_from(const ContactStore<From, Real>& from) {
    ball_colors_ = from.ball_colors_;
    point_colors_ = from.point_colors_;
    copy(ball_ends_, from.ball_ends_);
    copy(point_ends_, from.point_ends_);
    copy(ball_slots_, from.ball_slots_);
    copy(point_slots_, from.point_slots_);
    copy(ball_flags_, from.ball_flags_);
    copy(point_flags_, from.point_flags_);
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

  ColorRanges ball_colors_, point_colors_;
  Array<Ends, Space> ball_ends_, point_ends_;
  Array<std::int32_t, Space> ball_slots_, point_slots_;
  Array<std::uint8_t, Space> ball_flags_, point_flags_;
  Array<std::int32_t, Space> points_;
  Array<Real, Space> ball_fields_, contact_fields_, point_fields_, ball_gaps_, point_gaps_;
};

/// Calls f(c) for each contact c of a kind. For a place of a block that holds no contact, it returns a
/// default value (an empty sum) instead.
template <class F>
struct OnContacts {
  static constexpr int blocks_at_once = [] {
    if constexpr (requires { F::blocks_at_once; }) return F::blocks_at_once;
    return 1;
  }();

  ConstView<std::int32_t> slot;
  F f;
  SCREE_HD auto operator()(std::int64_t c) const {
    using Result = decltype(f(c));
    return slot[c] == Slot::empty ? Result() : f(c);
  }
};
template <class Contacts, class F>
OnContacts<F> on_contacts(const Contacts& contacts, const F& f) {
  return {contacts.slot, f};
}

}  // namespace scree::solver
