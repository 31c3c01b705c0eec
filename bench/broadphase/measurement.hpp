// The measurement of broad-phase methods in one space, on objects in a given order.
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
  int profiles = 0;  ///< further calls, in which each parallel call is timed
};

/// The measurement of one method's find(), from bounds in the space to pairs in the space. Calls share no
/// data, only allocated capacity. Times are in s.
struct Measurement {
  std::string problem;        ///< message that find() threw, if there is no measurement; else empty
  std::vector<double> times;  ///< times of the repeats, sorted
  BroadPhaseStats
      stats;  ///< statistics of the call on the objects in the order given, which also gives the checksum
  std::uint64_t checksum = 0;  ///< checksum of the pairs, independent of their order
  double memory = 0;           ///< most memory in use at once beyond the objects and the pairs (B)
  std::vector<timing::Entry>
      calls;  ///< median times of the parallel calls over the profiles, in the order of the calls

  double median() const { return times[times.size() / 2]; }
};

/// Measures each method. After their warm-ups the methods take turns, in rounds on one order of the objects,
/// so that a slow phase of the machine affects all of them equally.
template <class Space>
std::vector<Measurement> measure(const Objects<Space>& objects,
                                 const std::vector<BroadPhaseSettings>& methods, const Protocol& protocol);

/// Returns whether two methods find the same pairs, judged by number and checksum.
template <class Space>
bool agree(const Objects<Space>& objects, const BroadPhaseSettings& a, const BroadPhaseSettings& b);

/// Returns the number of bytes read and written per second when an array of this many bytes is copied within
/// the space: the median of nine copies.
template <class Space>
double copy_bandwidth(std::int64_t bytes);

}  // namespace scree::bench
