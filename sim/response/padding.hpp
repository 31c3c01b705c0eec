// Padding of blocks of contacts: values for places without a contact, with which a visit to a whole block
// changes nothing there.
#pragma once

#include "sim/contacts/layout.hpp"
#include "sim/contacts/rolling_visits.hpp"

#include <cstdint>

namespace scree::solver {

/// A target normal velocity that every velocity exceeds (m/s).
inline constexpr double no_target = -1e30;

/// Pads a block of contacts of balls.
template <class Real>
struct PadBalls {
  BallContacts<Real> contacts;
  RollingFields<Real> rolling;
  bool rolls;
  std::int32_t padding_body;  ///< a body of the solver that is not free

  SCREE_HD void operator()(std::int64_t block) const {
    using C = BallContacts<Real>;
    const std::int64_t begin = block * simd::width;
    for (std::int64_t c = begin; c < begin + simd::width; ++c) {
      if (contacts.slot[c] != Slot::empty) continue;
      contacts.ends[c] = {padding_body, padding_body};
      contacts.flags[c] = 0;
      for (int field = 0; field < C::count; ++field) contacts.fields.at(field, c) = 0;
      contacts.fields.at(C::normal_mass, c) = 1;
      contacts.gaps.at(C::predicted_gap, c) = contacts.gaps.at(C::cap, c) = 1;
      contacts.gaps.at(C::pushed, c) = contacts.gaps.at(C::pushed_before, c) = 0;
      contacts.fields.at(C::target, c) = static_cast<Real>(no_target);
      for (int field = 0; rolls && field < RollingFields<Real>::count; ++field)
        rolling.fields.at(field, c) = 0;
    }
  }
};

/// Pads a block of contacts with several points. All contacts of a block are padded to the largest number of
/// points that one of them has.
template <class Real>
struct PadPoints {
  PointContacts<Real> contacts;
  RollingFields<Real> rolling;
  bool rolls;
  std::int32_t padding_body;

  SCREE_HD void operator()(std::int64_t block) const {
    using C = PointContacts<Real>;
    const std::int64_t begin = block * simd::width;
    std::int32_t points = 0;
    for (std::int64_t c = begin; c < begin + simd::width; ++c) {
      if (contacts.slot[c] != Slot::empty) {
        points = contacts.points[c] > points ? contacts.points[c] : points;
        continue;
      }
      contacts.ends[c] = {padding_body, padding_body};
      contacts.flags[c] = 0;
      contacts.points[c] = 0;
      for (int field = 0; field < C::count; ++field) contacts.fields.at(field, c) = 0;
      contacts.fields.at(C::cap, c) = 1;
      for (int field = 0; rolls && field < RollingFields<Real>::count; ++field)
        rolling.fields.at(field, c) = 0;
    }
    for (std::int64_t c = begin; c < begin + simd::width; ++c)
      for (std::int32_t k = contacts.points[c]; k < points; ++k) pad_point(c, k);
  }

 private:
  SCREE_HD void pad_point(std::int64_t c, std::int32_t k) const {
    using C = PointContacts<Real>;
    const auto& f = contacts.point_fields;
    const int first = C::at_point(k, C::arm_i);
    for (int field = first; field < first + C::point_count; ++field) f.at(field, c) = 0;
    f.at(C::at_point(k, C::normal_mass), c) = 1;
    f.at(C::at_point(k, C::target), c) = static_cast<Real>(no_target);
    contacts.gaps.at(C::at_point(k, C::predicted_gap), c) = 1;
    contacts.gaps.at(C::at_point(k, C::pushed), c) = 0;
    contacts.gaps.at(C::at_point(k, C::pushed_before), c) = 0;
  }
};

}  // namespace scree::solver
