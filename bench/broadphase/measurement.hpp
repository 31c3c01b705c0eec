// Measurements of the broad phase: methods, in a space, on objects in an order.
#pragma once

#include "bench/broadphase/order.hpp"
#include "broadphase/broad_phase.hpp"
#include "core/timing.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace scree::bench {

enum class Order {
  random,  ///< another permutation for each call
  rows,    ///< sort_into_rows(), the same for all calls
  given,
};

struct Protocol {
  Order order = Order::random;
  int warm_ups = 2;
  int repeats = 9;
  int profiles = 0;  ///< calls more, in which each parallel call is timed
};

/// Of find(), from bounds in the space to pairs in the space, nothing carried over but capacity. Times in s.
struct Measurement {
  std::string problem;               ///< why there is none: what find() threw; else empty
  std::vector<double> times;         ///< of the repeats, sorted
  BroadPhaseStats stats;             ///< in the order given, as is the checksum
  std::uint64_t checksum = 0;        ///< of the pairs, whatever their order
  double memory = 0;                 ///< most that was in use at once beyond the objects and the pairs (B)
  std::vector<timing::Entry> calls;  ///< medians of the profiles, in the order in which they came

  double median() const { return times[times.size() / 2]; }
};

/// Of each method. After their warm-ups they take turns, in rounds on one order of the objects, so that a
/// machine that slows down slows all alike.
template <class Space>
std::vector<Measurement> measure(const Objects<Space>& objects,
                                 const std::vector<BroadPhaseSettings>& methods, const Protocol& protocol);

/// Whether two methods find the same pairs, by their number and checksum.
template <class Space>
bool agree(const Objects<Space>& objects, const BroadPhaseSettings& a, const BroadPhaseSettings& b);

/// Bytes read and written per second when an array of this many bytes is copied within the space: median of
/// nine.
template <class Space>
double copy_bandwidth(std::int64_t bytes);

}  // namespace scree::bench
