// The kinds of scalars that YAML 1.2 distinguishes (core schema, section 10.3). A scalar without quotes may
// be null, true or false, or a number; all else is text, as is everything in quotes.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace scree {

/// Returns whether the text means null: null, Null, NULL, ~, or empty.
bool is_null_word(std::string_view text);

/// Returns the truth value of true, True, TRUE and of false, False, FALSE; nothing for other text.
std::optional<bool> truth_of(std::string_view text);

/// Returns the value of numbers such as 0x1F and 0o17; nothing for other text, or for more than 64 bits.
std::optional<std::uint64_t> in_other_base(std::string_view text);

bool is_whole_number(std::string_view text);

/// Returns whether the text is a number, whole or not, finite or not.
bool is_number(std::string_view text);

}  // namespace scree
