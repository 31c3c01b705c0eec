// Wall times by label: those of the stages of the step always, those of every labelled parallel call on
// request. Each thread that drives steps has accounts of its own.
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
/// Returns the accounts of the stages in the order in which their labels first appeared.
const std::vector<Entry>& entries();
/// Returns the seconds so far under a stage's label; 0 if the stage never ran.
double seconds(const std::string& label);
void reset();

/// Sets whether parallel calls are timed one by one. It is off at first: on Device each timed call waits for
/// its end.
void time_calls(bool on);
bool calls_are_timed();
void add_call(const char* label, double seconds);
/// Returns the accounts of the parallel calls in the order in which their labels first appeared.
const std::vector<Entry>& calls();

/// Measures its own lifetime and adds it to the account of a stage.
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

/// Measures one parallel call and adds the time to the account of its label, if calls are timed.
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
