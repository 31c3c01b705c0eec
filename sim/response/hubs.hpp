// The parts of hubs agree after each sweep.
#pragma once

#include "core/array.hpp"
#include "sim/contacts/layout.hpp"
#include "sim/contacts/slots.hpp"

#include <algorithm>
#include <cstdint>

namespace scree::solver {

/// Sum of two vectors over parts of a hub, by their shares.
struct PartsSum {
  Vec3 velocity = Vec3::Zero();
  Vec3 spin = Vec3::Zero();
  SCREE_HD friend PartsSum operator+(const PartsSum& a, const PartsSum& b) {
    return {a.velocity + b.velocity, a.spin + b.spin};
  }
};

/// The parts of each hub, and the hub itself, get their mean, in three phases: sums over some of the parts,
/// sums of these, and what everyone gets.
template <class Record>
struct JoinHubs {
  static constexpr int together = 64;  // parts to a first sum: the root of many

  ConstView<Hub> hubs;
  ConstView<std::int32_t> hub_of;  ///< of each part
  ConstView<double> share;         ///< of its hub's mass
  std::int64_t first_part;         ///< among the records
  Record* bodies;                  ///< padding_body's if there is nothing to join
  PartsSum* sums;                  ///< of each part, room

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
