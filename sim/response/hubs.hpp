// The phases of a sweep in which the parts of each hub get equal velocities (mass splitting).
#pragma once

#include "core/array.hpp"
#include "sim/contacts/layout.hpp"
#include "sim/contacts/slots.hpp"

#include <algorithm>
#include <cstdint>

namespace scree::solver {

/// Sums of velocities and spins over parts of a hub, weighted by the parts' shares of its mass.
struct PartsSum {
  Vec3 velocity = Vec3::Zero();
  Vec3 spin = Vec3::Zero();
  SCREE_HD friend PartsSum operator+(const PartsSum& a, const PartsSum& b) {
    return {a.velocity + b.velocity, a.spin + b.spin};
  }
};

/// Sets the parts of each hub, and the hub itself, to the weighted mean of the parts. This takes three
/// phases: partial sums over up to `together` parts, the sum of these for each hub, and the copy of the
/// result to all parts.
template <class Record>
struct JoinHubs {
  static constexpr int together = 64;  // parts in a partial sum: about the square root of many parts

  ConstView<Hub> hubs;
  ConstView<std::int32_t> hub_of;  ///< number of the hub of each part
  ConstView<double> share;         ///< share of each part in its hub's mass
  std::int64_t first_part;         ///< index of the first part among the records
  Record* bodies;                  ///< null if there is nothing to join
  PartsSum* sums;                  ///< memory for the partial sums, one for each part

  SCREE_HD int phases() const { return hubs.size() > 0 && bodies != nullptr ? 3 : 0; }
  SCREE_HD std::int64_t items(int phase) const { return phase == 1 ? hubs.size() : hub_of.size(); }

  SCREE_HD void operator()(int phase, std::int64_t item) const {
    if (phase == 0) {
      add_some(item);
    } else if (phase == 1) {
      add_all(hubs[item]);
    } else {
      share_mean(item);
    }
  }

 private:
  using Real = decltype(Record::inverse_mass);

  SCREE_HD std::int64_t first_of(const Hub& hub) const { return hub.first - first_part; }
  SCREE_HD static Vec3 spin_of(const Record& body) {
    if constexpr (requires { body.spin; }) return vec3(body.spin);
    return Vec3::Zero();
  }

  SCREE_HD void add_some(std::int64_t part) const {
    const Hub& hub = hubs[hub_of[part]];
    const std::int64_t number = part - first_of(hub);
    if (number % together != 0) return;
    const std::int64_t more = hub.parts - number;
    PartsSum sum;
    for (int k = 0; k < together && k < more; ++k) {
      const Record& body = bodies[first_part + part + k];
      sum = sum + PartsSum{share[part + k] * vec3(body.velocity), share[part + k] * spin_of(body)};
    }
    sums[part] = sum;
  }
  SCREE_HD void add_all(const Hub& hub) const {
    PartsSum sum;
    for (std::int32_t part = 0; part < hub.parts; part += together) sum = sum + sums[first_of(hub) + part];
    sums[first_of(hub)] = sum;
  }
  SCREE_HD void share_mean(std::int64_t part) const {
    const Hub& hub = hubs[hub_of[part]];
    const PartsSum& sum = sums[first_of(hub)];
    const auto set = [&](Record& body) {
      body.velocity = v3<Real>(sum.velocity);
      if constexpr (requires { body.spin; }) body.spin = v3<Real>(sum.spin);
    };
    set(bodies[first_part + part]);
    if (part == first_of(hub)) set(bodies[hub.body]);
  }
};

}  // namespace scree::solver
