// What fills up contacts that lie side by side where there are no more of them, so that a visit to several at
// once finds nothing to do there.
#pragma once

#include "sim/resident/layout.hpp"
#include "sim/resident/rolling_visits.hpp"

#include <cstdint>

namespace scree::resident {

/// A target that every velocity meets (m/s).
inline constexpr double no_target = -1e30;

/// Of a tile of contacts of balls, of which so many are `found`.
template <class Real>
struct PadBalls {
  BallContacts<Real> contacts;
  RollingFields<Real> rolling;
  bool rolls;
  const std::int32_t* found;
  std::int32_t nobody;  ///< a body of the solver that is not free

  SCREE_HD void operator()(std::int64_t t) const {
    using C = BallContacts<Real>;
    const std::int64_t end = t * tile_size + found[t];
    for (std::int64_t c = end; c % lanes::width != 0; ++c) {
      contacts.ends[c] = {nobody, nobody};
      for (int field = 0; field < C::count; ++field) contacts.fields.at(field, c) = 0;
      contacts.fields.at(C::normal_mass, c) = 1;
      contacts.gaps.at(C::flown, c) = contacts.gaps.at(C::cap, c) = 1;
      contacts.gaps.at(C::pushed, c) = 0;
      contacts.fields.at(C::target, c) = static_cast<Real>(no_target);
      for (int field = 0; rolls && field < RollingFields<Real>::count; ++field)
        rolling.fields.at(field, c) = 0;
    }
  }
};

/// The same of contacts of several points. Those side by side have as many as one of them has.
template <class Real>
struct PadPoints {
  PointContacts<Real> contacts;
  RollingFields<Real> rolling;
  bool rolls;
  const std::int32_t* found;
  std::int32_t nobody;

  SCREE_HD void operator()(std::int64_t t) const {
    using C = PointContacts<Real>;
    const std::int64_t begin = t * tile_size;
    const std::int64_t end = begin + found[t];
    for (std::int64_t c = end; c % lanes::width != 0; ++c) {
      contacts.ends[c] = {nobody, nobody};
      contacts.points[c] = 0;
      for (int field = 0; field < C::count; ++field) contacts.fields.at(field, c) = 0;
      contacts.fields.at(C::cap, c) = 1;
      for (int field = 0; rolls && field < RollingFields<Real>::count; ++field)
        rolling.fields.at(field, c) = 0;
    }
    for (std::int64_t block = begin; block < end; block += lanes::width) {
      std::int32_t points = 0;
      for (std::int64_t c = block; c < block + lanes::width; ++c)
        points = contacts.points[c] > points ? contacts.points[c] : points;
      for (std::int64_t c = block; c < block + lanes::width; ++c)
        for (std::int32_t k = contacts.points[c]; k < points; ++k) pad_point(c, k);
    }
  }

 private:
  SCREE_HD void pad_point(std::int64_t c, std::int32_t k) const {
    using C = PointContacts<Real>;
    const auto& f = contacts.point_fields;
    const int first = C::at_point(k, C::arm_i);
    for (int field = first; field < first + C::point_count; ++field) f.at(field, c) = 0;
    f.at(C::at_point(k, C::normal_mass), c) = 1;
    f.at(C::at_point(k, C::target), c) = static_cast<Real>(no_target);
    contacts.gaps.at(C::at_point(k, C::flown), c) = 1;
    contacts.gaps.at(C::at_point(k, C::pushed), c) = 0;
  }
};

}  // namespace scree::resident
