// Wall times by name. A stage of the step opens a region; so does every labelled parallel call.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

namespace scree::timing {

struct Entry {
  std::string label;
  double seconds = 0;
  std::int64_t calls = 0;
};

/// Adds `seconds` to a label's account. Only the thread that drives the step calls it.
void add(const char* label, double seconds);
/// Accounts in the order in which their labels first appeared.
const std::vector<Entry>& entries();
/// Seconds so far under a label; 0 if it never ran.
double seconds(const std::string& label);
void reset();

/// Times its own lifetime under a label.
class Region {
 public:
  explicit Region(const char* label) : label_(label), start_(Clock::now()) {}
  ~Region() { add(label_, std::chrono::duration<double>(Clock::now() - start_).count()); }
  Region(const Region&) = delete;
  Region& operator=(const Region&) = delete;

 private:
  using Clock = std::chrono::steady_clock;
  const char* label_;
  Clock::time_point start_;
};

}  // namespace scree::timing
