#include "sim/scene/scalar.hpp"

#include <algorithm>
#include <array>
#include <charconv>

namespace scree {
namespace {

template <std::size_t N>
bool is_one_of(std::string_view text, const std::array<std::string_view, N>& words) {
  return std::find(words.begin(), words.end(), text) != words.end();
}

/// Removes the digits at the front of the text. Returns how many there were.
std::size_t take_digits(std::string_view& text) {
  const std::size_t count = std::min(text.find_first_not_of("0123456789"), text.size());
  text.remove_prefix(count);
  return count;
}

bool take_sign(std::string_view& text) {
  const bool signed_ = !text.empty() && (text[0] == '+' || text[0] == '-');
  if (signed_) text.remove_prefix(1);
  return signed_;
}

/// Returns whether the text is [0-9]+ (. [0-9]*)?, or . [0-9]+, with or without an exponent.
bool is_decimal(std::string_view text) {
  std::size_t digits = take_digits(text);
  if (text.starts_with('.')) {
    text.remove_prefix(1);
    digits += take_digits(text);
  }
  if (digits == 0) return false;
  if (text.empty()) return true;
  if (text[0] != 'e' && text[0] != 'E') return false;
  text.remove_prefix(1);
  take_sign(text);
  return take_digits(text) > 0 && text.empty();
}

}  // namespace

bool is_null_word(std::string_view text) { return is_one_of<5>(text, {"", "~", "null", "Null", "NULL"}); }

std::optional<bool> truth_of(std::string_view text) {
  if (is_one_of<3>(text, {"true", "True", "TRUE"})) return true;
  if (is_one_of<3>(text, {"false", "False", "FALSE"})) return false;
  return {};
}

std::optional<std::uint64_t> in_other_base(std::string_view text) {
  const int base = text.starts_with("0x") ? 16 : text.starts_with("0o") ? 8 : 0;
  if (base == 0) return {};
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data() + 2, text.data() + text.size(), value, base);
  if (error != std::errc{} || end != text.data() + text.size()) return {};
  return value;
}

bool is_whole_number(std::string_view text) {
  if (in_other_base(text)) return true;
  take_sign(text);
  return take_digits(text) > 0 && text.empty();
}

bool is_number(std::string_view text) {
  if (in_other_base(text) || is_one_of<3>(text, {".nan", ".NaN", ".NAN"})) return true;
  take_sign(text);
  return is_decimal(text) || is_one_of<3>(text, {".inf", ".Inf", ".INF"});
}

}  // namespace scree
