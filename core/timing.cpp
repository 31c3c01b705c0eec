#include "core/timing.hpp"

#include <cstring>
#include <unordered_map>

namespace scree::timing {

namespace {

struct Accounts {
  std::vector<Entry> entries;
  std::unordered_map<std::string, std::size_t> by_text;
  // Labels are string literals: their address finds the account without hashing the text.
  std::unordered_map<const char*, std::size_t> by_address;
};

Accounts& accounts() {
  static Accounts all;
  return all;
}

}  // namespace

void add(const char* label, double seconds) {
  Accounts& all = accounts();
  auto [slot, is_new] = all.by_address.try_emplace(label, 0);
  if (is_new) {
    const auto [text, is_new_text] = all.by_text.try_emplace(label, all.entries.size());
    if (is_new_text) all.entries.push_back({label, 0, 0});
    slot->second = text->second;
  }
  Entry& entry = all.entries[slot->second];
  entry.seconds += seconds;
  ++entry.calls;
}

const std::vector<Entry>& entries() { return accounts().entries; }

double seconds(const std::string& label) {
  const auto found = accounts().by_text.find(label);
  return found == accounts().by_text.end() ? 0.0 : accounts().entries[found->second].seconds;
}

void reset() { accounts() = {}; }

}  // namespace scree::timing
