// The phases of a sweep in which the parts of each hub get equal velocities (mass splitting).
#pragma once

#include "core/array.hpp"
#include "core/space_prefetch.hpp"
#include "sim/contacts/layout.hpp"
#include "sim/contacts/slots.hpp"

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

/// Sets the parts of each hub, and the hub itself, to the weighted mean of the parts. Phases add up the parts
/// in groups, then these sums in groups if there are many of them, then the rest for each hub; the last phase
/// copies the result to all parts.
template <class Record>
struct JoinHubs {
  static constexpr std::int64_t together = 64;  // size of a group: a thread adds one up

  ConstView<Hub> hubs;
  ConstView<std::int32_t> hub_of;  ///< number of the hub of each part
  ConstView<double> share;         ///< share of each part in its hub's mass
  std::int64_t first_part;         ///< index of the first part among the records
  Record* bodies;                  ///< null if there is nothing to join
  PartsSum* sums;                  ///< memory for the partial sums, one for each part

  SCREE_HD int phases() const { return hubs.size() > 0 && bodies != nullptr ? sum_phases() + 1 : 0; }
  SCREE_HD std::int64_t items(int phase) const {
    return phase == sum_phases() - 1 ? hubs.size() : hub_of.size();
  }

  SCREE_HD void operator()(int phase, std::int64_t item) const {
    if (phase == sum_phases()) {
      share_mean(item);
    } else if (phase == sum_phases() - 1) {
      add_all(hubs[item]);
    } else {
      add_group(item, phase == 0 ? 1 : together);
    }
  }

 private:
  using Real = decltype(Record::inverse_mass);

  SCREE_HD int sum_phases() const { return hub_of.size() > together * together ? 3 : 2; }
  SCREE_HD std::int64_t first_of(const Hub& hub) const { return hub.first - first_part; }
  SCREE_HD static Vec3 spin_of(const Record& body) {
    if constexpr (requires { body.spin; }) return vec3(body.spin);
    return Vec3::Zero();
  }

  /// Starts to load the records that a thread adds up. It would wait for each of them otherwise.
  template <class T>
  SCREE_HD static void prefetch_all(const T* first, std::int64_t count, std::int64_t stride) {
    for (std::int64_t k = 0; k < count; ++k) prefetch(first + k * stride);
  }
  SCREE_HD PartsSum sum_of_records(std::int64_t part, std::int64_t count) const {
    const Record* const first = bodies + first_part + part;
    prefetch_all(first, count, 1);
    PartsSum sum;
    for (std::int64_t k = 0; k < count; ++k)
      sum = sum + PartsSum{share[part + k] * vec3(first[k].velocity), share[part + k] * spin_of(first[k])};
    return sum;
  }
  /// Returns the sum of `count` sums, of which each stands `stride` parts after the last.
  SCREE_HD PartsSum sum_of_sums(std::int64_t part, std::int64_t count, std::int64_t stride) const {
    prefetch_all(sums + part, count, stride);
    PartsSum sum;
    for (std::int64_t k = 0; k < count; ++k) sum = sum + sums[part + k * stride];
    return sum;
  }
  /// Adds up the group that begins at a part, if one does. `of`: number of parts in one term.
  SCREE_HD void add_group(std::int64_t part, std::int64_t of) const {
    const Hub& hub = hubs[hub_of[part]];
    const std::int64_t number = part - first_of(hub);
    if (number % (of * together) != 0) return;
    const std::int64_t left = (hub.parts - number + of - 1) / of;
    const std::int64_t count = left < together ? left : together;
    sums[part] = of == 1 ? sum_of_records(part, count) : sum_of_sums(part, count, of);
  }
  SCREE_HD void add_all(const Hub& hub) const {
    const std::int64_t of = sum_phases() == 3 ? together * together : together;
    sums[first_of(hub)] = sum_of_sums(first_of(hub), (hub.parts + of - 1) / of, of);
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
