// The clocks of the benchmarks.
#pragma once

#include <ctime>

namespace scree::bench {

/// Returns the time of a clock, such as CLOCK_MONOTONIC or CLOCK_PROCESS_CPUTIME_ID (s).
inline double now(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace scree::bench
