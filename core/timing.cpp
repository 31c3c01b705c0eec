#include "core/timing.hpp"

#include <atomic>
#include <unordered_map>

namespace scree::timing {

namespace {

class Accounts {
 public:
  void add(const char* label, double seconds) {
    auto [slot, is_new] = by_address_.try_emplace(label, 0);
    if (is_new) {
      const auto [text, is_new_text] = by_text_.try_emplace(label, entries_.size());
      if (is_new_text) entries_.push_back({label, 0, 0});
      slot->second = text->second;
    }
    Entry& entry = entries_[slot->second];
    entry.seconds += seconds;
    ++entry.calls;
  }
  double seconds(const std::string& label) const {
    const auto found = by_text_.find(label);
    return found == by_text_.end() ? 0.0 : entries_[found->second].seconds;
  }
  const std::vector<Entry>& entries() const { return entries_; }

 private:
  std::vector<Entry> entries_;
  std::unordered_map<std::string, std::size_t> by_text_;
  // Labels are string literals: the account is found by their address, without hashing the text.
  std::unordered_map<const char*, std::size_t> by_address_;
};

// Each thread that drives steps has its own accounts.
thread_local Accounts stage_accounts;
thread_local Accounts call_accounts;
std::atomic<bool> timed_calls = false;

}  // namespace

void add(const char* label, double seconds) { stage_accounts.add(label, seconds); }
const std::vector<Entry>& entries() { return stage_accounts.entries(); }
double seconds(const std::string& label) { return stage_accounts.seconds(label); }

void reset() {
  stage_accounts = {};
  call_accounts = {};
}

void time_calls(bool on) { timed_calls = on; }
bool calls_are_timed() { return timed_calls; }
void add_call(const char* label, double seconds) { call_accounts.add(label, seconds); }
const std::vector<Entry>& calls() { return call_accounts.entries(); }

}  // namespace scree::timing
