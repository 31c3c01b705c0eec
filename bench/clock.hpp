// The clocks of benchmarks.
#pragma once

#include <ctime>

namespace scree::bench {

/// What a clock shows, such as CLOCK_MONOTONIC or CLOCK_PROCESS_CPUTIME_ID, in s.
inline double now(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace scree::bench
