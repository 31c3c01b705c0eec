// Wall times by name: of the stages of the step always, of every labelled parallel call when asked for. Each
// thread that drives steps has accounts of its own.
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

/// Adds `seconds` to the account of a stage. Only a thread that drives steps calls it.
void add(const char* label, double seconds);
/// Accounts of the stages in the order in which their labels first appeared.
const std::vector<Entry>& entries();
/// Seconds so far under a stage's label; 0 if it never ran.
double seconds(const std::string& label);
void reset();

/// Whether parallel calls are timed one by one (off at first: on Device each call then waits for its end).
void time_calls(bool on);
bool calls_are_timed();
void add_call(const char* label, double seconds);
/// Accounts of the parallel calls, likewise.
const std::vector<Entry>& calls();

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

/// Times one parallel call under its label, if calls are timed.
template <class Space>
class Call {
 public:
  explicit Call(const char* label) : label_(calls_are_timed() ? label : nullptr) {
    if (label_) start_ = Clock::now();
  }
  ~Call() noexcept(false) {
    if (!label_) return;
    Space::synchronize();
    add_call(label_, std::chrono::duration<double>(Clock::now() - start_).count());
  }
  Call(const Call&) = delete;
  Call& operator=(const Call&) = delete;

 private:
  using Clock = std::chrono::steady_clock;
  const char* label_;
  Clock::time_point start_;
};

}  // namespace scree::timing
